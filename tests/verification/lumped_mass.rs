//! Lumped mass: the same weight and momentum, frequencies from below where consistent mass has them from above.

use ndda::judge::verdict;
use ndda_io::summary::LabelWord;
use ndda_mesh::{BlockId, TetId, Vec3};
use ndda_solver::Simulation;

use crate::evidence::Answer::{AtMost, Near, Within};
use crate::evidence::row;
use crate::simulation;

/// Period of the first stretching mode of a bar that is fixed at one end [s].
fn period_s(mass: &str) -> f64 {
    let mut simulation = simulation(&format!(
        "(title: \"bar\", time: (step_s: 1e-5, end_s: 1, mass: {mass}),
          materials: [(name: \"rock\", young_pa: 1e9, poisson: 0, density_kg_m3: 2500)],
          blocks: [(name: \"bar\", material: \"rock\", shape: Box(size_m: (4, 0.5, 0.5), cells: (4, 1, 1)))],
          supports: [(block: \"bar\", on: Set(\"x_min\"), hold: Fixed)],
          tractions: [(block: \"bar\", on: Set(\"x_max\"), traction_pa: (1e4, 0, 0))])"
    ));
    // The end goes out and back about its static stretch: two passes of its mean in a row are half a period apart.
    let end = simulation.blocks().nodes_of(BlockId(0)).end - 1;
    let stretch = 1e4 * 4.0 / 1e9;
    let mut passes = Vec::new();
    let mut last = 0.0;
    while passes.len() < 9 {
        let time_s = simulation.time_s();
        simulation.step().unwrap();
        let now = crate::displacements(&simulation)[end].x - stretch;
        if last * now < 0.0 {
            passes.push(time_s + simulation.step_s() * last.abs() / (last - now).abs());
        }
        last = now;
    }
    (passes[8] - passes[0]) / 4.0
}

#[test]
fn the_first_mode_of_a_bar_is_bracketed_by_consistent_and_lumped_mass() {
    // T = 4 L/c.
    let exact = 4.0 * 4.0 / (1e9f64 / 2500.0).sqrt();
    let (consistent, lumped) = (period_s("Consistent") / exact, period_s("Lumped") / exact);
    // From above and from below.
    row("mass", "period of a bar over 4L/c, consistent mass", consistent, Near(0.985, 0.015));
    row("mass", "period of a bar over 4L/c, lumped mass", lumped, Near(1.015, 0.015));
}

#[test]
fn a_lumped_block_falls_and_spins_with_its_books_in_order() {
    let mut simulation = simulation(
        "(title: \"fall\", time: (step_s: 1e-3, end_s: 1, mass: Lumped), gravity_m_s2: (0, 0, -10),
          materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2500)],
          blocks: [(name: \"b\", material: \"rock\", shape: Box(size_m: (1, 0.6, 0.5), cells: (2, 1, 1)), spin_rad_s: (1, 3, 0))])",
    );
    // A quarter of each tetrahedron turns with each of its corners.
    let blocks = simulation.blocks();
    let center = Vec3::new(0.5, 0.3, 0.25) - blocks.origin_m;
    let corners = |tet| blocks.tet_corners(tet, &blocks.rest_position);
    let of_tet = |tet: usize| {
        let x = corners(TetId(tet as u32));
        let volume = (x[1] - x[0]).cross(&(x[2] - x[0])).dot(&(x[3] - x[0])) / 6.0;
        let speed2 = |x: &Vec3| Vec3::new(1.0, 3.0, 0.0).cross(&(x - center)).norm_squared();
        0.5 * 2500.0 * volume / 4.0 * x.iter().map(speed2).sum::<f64>()
    };
    let energy_j: f64 = (0..blocks.tets.len()).map(of_tet).sum();
    simulation.sample().unwrap();
    for _ in 0..1000 {
        simulation.step().unwrap();
    }
    let end = simulation.sample().unwrap();
    row(
        "mass",
        "momentum of a lumped block after a second of fall [kg m/s]",
        end.momentum.z,
        Within(-7500.0, 1e-12),
    );
    row("mass", "energy of a lumped block after it [J]", end.total_j(), Within(energy_j, 1e-6));
    row("mass", "angular momentum of it", simulation.invariants().angular_momentum, AtMost(1e-12));
}

/// A cube of 1 m and 2500 kg of six tetrahedra under a couple of 1000 N m about z for 10 ms.
fn coupled(body: &str, mass: &str) -> Simulation {
    let mut simulation = simulation(&format!(
        "(title: \"couple\", time: (step_s: 1e-4, end_s: 1, mass: {mass}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.2, density_kg_m3: 2500)],
          blocks: [(name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), body: {body})],
          tractions: [
            (block: \"b\", on: Set(\"x_max\"), traction_pa: (0, 1000, 0)),
            (block: \"b\", on: Set(\"x_min\"), traction_pa: (0, -1000, 0)),
          ])"
    ));
    simulation.sample().unwrap();
    for _ in 0..100 {
        simulation.step().unwrap();
    }
    simulation.sample().unwrap();
    simulation
}

/// Rate of rotation, by the velocities of nodes [rad/s].
fn spin(simulation: &Simulation) -> Vec3 {
    let state = simulation.state();
    simulation.shape(BlockId(0)).operator.rigid_motion(&state.position, &state.velocity).spin_rad_s
}

#[test]
fn rigid_and_affine_blocks_have_their_own_inertia_whatever_the_mass() {
    // ω = T t/J with J = m a²/6; it has turned by 1.2e-4 rad. The rock of an affine block deforms by 1e-7.
    let expected = 1000.0 * 0.01 * 6.0 / 2500.0;
    for body in ["Rigid", "Affine"] {
        for mass in ["Consistent", "Lumped"] {
            let simulation = coupled(body, mass);
            let what = format!("spin of a cube under a couple, {body}, {mass} [rad/s]");
            row("mass", &what, spin(&simulation).z, Within(expected, 1e-4));
            assert!(simulation.lumped_inertia_errors().is_empty());
            assert_eq!(verdict::label(&simulation, None).word, LabelWord::Accurate, "{body}, {mass}");
        }
    }
}

#[test]
fn a_lumped_elastic_block_that_turns_is_not_called_accurate_and_says_by_how_much() {
    // Two opposite corners carry a quarter of the mass, the others a twelfth: J has m a²/2 on its diagonal and m a²/12 beside it, which is
    // 7/12 m a² across the diagonal of the cube, 3.5 times the true m a²/6.
    let lumped = coupled("Elastic", "Lumped");
    let [(_, error)] = lumped.lumped_inertia_errors()[..] else { panic!("one kind of block") };
    row("mass", "stated error of the inertia of a lumped cube of six tetrahedra", error, Within(2.5, 1e-12));
    let label = verdict::label(&lumped, None);
    assert_eq!(label.word, LabelWord::Inaccurate, "{:?}", label.reasons);
    assert!(label.reasons.iter().any(|reason| reason.contains("lumped masses")), "{:?}", label.reasons);
    let consistent = coupled("Elastic", "Consistent");
    let expected = 1000.0 * 0.01 * 6.0 / 2500.0;
    // It rings: its nodes are as fast as its spin is, a shear wave crosses it four hundred times a second.
    let what = "spin of a cube under a couple, Elastic, Consistent [rad/s]";
    row("mass", what, spin(&consistent).z, Within(expected, 0.05));
    assert!(consistent.lumped_inertia_errors().is_empty());
}

#[test]
fn a_lumped_elastic_block_that_does_not_turn_is_called_accurate() {
    let mut simulation = simulation(
        "(title: \"fall\", time: (step_s: 1e-3, end_s: 1, mass: Lumped), gravity_m_s2: (0, 0, -10),
          materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2500)],
          blocks: [(name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), velocity_m_s: (3, 0, 0))])",
    );
    simulation.sample().unwrap();
    for _ in 0..1000 {
        simulation.step().unwrap();
    }
    simulation.sample().unwrap();
    let label = verdict::label(&simulation, None);
    assert_eq!(label.word, LabelWord::Accurate, "{:?}", label.reasons);
}
