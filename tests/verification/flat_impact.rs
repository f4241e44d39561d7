//! An elastic cube that falls flat on a plane rebounds straight up; one of few tetrahedra does not, since they are not symmetric.

use ndda_mesh::{BlockId, Vec3};

use crate::evidence::Answer::Near;
use crate::evidence::row;
use crate::{advance, simulation};

const SPEED_M_S: f64 = 2.0;

/// Displacement along the base over that towards it, both the mean of all nodes, of the same cube that stands on a base which holds it, under its weight.
fn lean(cells: u32) -> f64 {
    let mut cube = simulation(&format!(
        "(title: \"standing cube\", time: (step_s: 1, end_s: 20, integrator: Newmark(alpha: 0.5, delta: 1)), gravity_m_s2: (0, 0, -10),
          materials: [(name: \"rock\", young_pa: 5e9, poisson: 0.2, density_kg_m3: 2600)],
          blocks: [(name: \"cube\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: ({cells}, {cells}, {cells})))],
          supports: [(block: \"cube\", on: Set(\"z_min\"), hold: Fixed)], contact: Off)"
    ));
    advance(&mut cube, 20);
    let mean = crate::displacements(&cube).iter().sum::<Vec3>();
    mean.xy().norm() / mean.z.abs()
}

/// Speed along the plane after the rebound, over that of the impact.
fn sideways(cells: u32) -> f64 {
    let mut cube = simulation(&format!(
        "(title: \"flat impact\", time: (step_s: 5e-6, end_s: 8e-3), gravity_m_s2: (0, 0, -9.81),
          materials: [(name: \"rock\", young_pa: 5e9, poisson: 0.2, density_kg_m3: 2600)],
          blocks: [
            (name: \"floor\", material: \"rock\", shape: Box(size_m: (4, 2, 0.5), cells: (1, 1, 1)), body: Fixed, at_m: (-1, -0.5, -0.5)),
            (name: \"cube\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: ({cells}, {cells}, {cells})), at_m: (0, 0, 1e-4),
             velocity_m_s: (0, 0, -{SPEED_M_S})),
          ],
          contact: Potential(penalty_pa: 5e9, friction: (friction_deg: 30)))"
    ));
    advance(&mut cube, 1600);
    let nodes = cube.blocks().nodes_of(BlockId(1));
    let mean = cube.state().velocity[nodes.clone()].iter().sum::<Vec3>() / nodes.len() as f64;
    assert!(mean.z > 0.7 * SPEED_M_S, "{cells} cells: {mean:?}");
    mean.xy().norm() / SPEED_M_S
}

/// Two modes of vibration of which one goes up and down and one to the side, each tilted by s against its axis, swing to the side at 2 s of the speed. The tilt is
/// r/(1 − r) of the lean under weight, r the stiffness to the side over that up and down: a quarter, between 0.17 of a block that shears and bends and 0.35 of one
/// that is too stiff to bend.
#[test]
fn an_elastic_cube_that_falls_flat_leaves_straight_up_but_for_an_error_of_its_mesh() {
    for cells in [1, 2, 4] {
        row(
            "flat impact",
            &format!("sideways speed over that of the impact, {cells}³ cells [-]"),
            sideways(cells),
            Near(0.0, 2.0 / 3.0 * lean(cells)),
        );
    }
}
