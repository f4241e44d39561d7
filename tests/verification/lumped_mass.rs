//! Lumped mass: the same weight and momentum, frequencies from below where consistent mass has them from above.

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
    let end = simulation.blocks().nodes_of(ndda_mesh::BlockId(0)).end - 1;
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
    let start = simulation.sample().unwrap();
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
    row("mass", "energy of a lumped block after it [J]", end.total_j(), Within(start.total_j(), 1e-6));
    row("mass", "angular momentum of it", simulation.invariants().angular_momentum, AtMost(1e-12));
}
