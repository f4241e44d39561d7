//! Where contact forces are shown on blocks whose forces contact gathers on a few nodes.

use ndda_mesh::Vec3;

use crate::simulation;

#[test]
fn forces_on_a_whole_block_are_shown_where_it_is_pressed() {
    let mut simulation = simulation(
        "(title: \"a cube on a floor\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: (0, 0, -9.8),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
          blocks: [
            (name: \"floor\", material: \"rock\", body: Fixed, at_m: (-4, -4, -1), shape: Box(size_m: (8, 8, 1), cells: (8, 8, 1))),
            (name: \"cube\", material: \"rock\", body: Rigid, at_m: (2.2, 1.3, -1e-3), shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
          ],
          contact: Potential(penalty_pa: 1e8, potential: Smooth(reference_m: 1), friction: (friction_deg: 30)))",
    );
    simulation.watch_contacts(true);
    simulation.step().unwrap();
    let [floor, cube] = ["floor", "cube"].map(|name| simulation.blocks().find(name).unwrap());
    let forces = simulation.contact_forces_n();
    let sum = |block| forces[simulation.blocks().nodes_of(block)].iter().sum::<Vec3>();
    let (on_cube, on_floor) = (sum(cube), sum(floor));
    // 2 k_n d/L₀ on a square metre.
    assert!((on_cube.z / 2e5 - 1.0).abs() < 0.02, "{on_cube:?}");
    assert!((on_cube + on_floor).norm() < 1e-9 * on_cube.norm(), "{on_floor:?}");
    let places = simulation.blocks().nodes_of(floor).map(|n| (simulation.state().position[n], forces[n]));
    for (x, force) in places.filter(|(_, force)| *force != Vec3::zeros()) {
        assert!(x.z == 0.0 && (x - Vec3::new(2.7, 1.8, 0.0)).amax() < 1.6, "{force:?} at {x:?}");
        assert!(force.z <= 0.0 && force.norm() < on_cube.norm(), "{force:?} at {x:?}");
    }
}
