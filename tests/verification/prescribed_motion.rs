//! A block moved by a table: every node follows it, linear between the rows and resting after the last.

use ndda_mesh::Vec3;

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::{rounding, row};
use crate::simulation;

const SCENE: &str = "(title: \"moved\", time: (step_s: 1e-3, end_s: 1),
    gravity_m_s2: (0, 0, -9.8),
    materials: [(name: \"rock\", young_pa: 1e10, poisson: 0.25, density_kg_m3: 2500)],
    blocks: [(name: \"block\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)))],
    supports: [(block: \"block\", on: All, hold: Motion([
        (time_s: 0, displacement_m: (0, 0, 0)),
        (time_s: 0.1, displacement_m: (0.02, 0, 0)),
        (time_s: 0.2, displacement_m: (0.02, 0.01, 0)),
    ]))])";

#[test]
fn every_node_follows_the_table_and_rests_after_it() {
    let mut simulation = simulation(SCENE);
    for (steps, exact) in [
        (50, Vec3::new(0.01, 0.0, 0.0)),
        (50, Vec3::new(0.02, 0.0, 0.0)),
        (50, Vec3::new(0.02, 0.005, 0.0)),
        (250, Vec3::new(0.02, 0.01, 0.0)),
    ] {
        for _ in 0..steps {
            simulation.step().unwrap();
        }
        let off = crate::displacements(&simulation).iter().map(|u| (u - exact).norm()).fold(0.0, f64::max);
        row(
            "motion",
            &format!("distance from the table at t = {:.2} s [m]", simulation.time_s()),
            off,
            AtMost(1e-15),
        );
    }
}

#[test]
fn a_block_that_is_taken_along_has_the_energy_of_the_work_done_on_it() {
    let mut simulation = simulation(
        "(title: \"taken along\", time: (step_s: 1e-3, end_s: 1),
          materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.25, density_kg_m3: 2500)],
          blocks: [(name: \"cube\", material: \"rock\", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
          supports: [(block: \"cube\", on: All, hold: Motion([
              (time_s: 0, displacement_m: (0, 0, 0)), (time_s: 0.01, displacement_m: (0.01, 0, 0)),
              (time_s: 0.02, displacement_m: (0.01, 0.03, 0)),
          ]))])",
    );
    simulation.sample().unwrap();
    for _ in 0..15 {
        simulation.step().unwrap();
    }
    let sample = simulation.sample().unwrap();
    let kinetic_j = 0.5 * 2500.0 * 9.0;
    row(
        "motion",
        "kinetic energy of a block that is moved at 3 m/s [J]",
        sample.kinetic_j,
        Within(kinetic_j, 1e-12),
    );
    // What moves it delivers what it has: rounding of 15 steps, twentyfold.
    let rounds = 20.0 * rounding(15);
    row("motion", "energy from nowhere over it", sample.balance_j.abs() / kinetic_j, AtMost(rounds));
}

#[test]
fn a_table_that_starts_late_holds_the_block_until_then_and_may_not_begin_with_a_jump() {
    let late = |first: &str| {
        SCENE.replace(
            "(time_s: 0, displacement_m: (0, 0, 0))",
            &format!("(time_s: 0.05, displacement_m: {first})"),
        )
    };
    let mut simulation = simulation(&late("(0, 0, 0)"));
    for (steps, exact) in [(50, 0.0), (25, 0.01), (25, 0.02)] {
        for _ in 0..steps {
            simulation.step().unwrap();
        }
        let off = crate::displacements(&simulation).iter().map(|u| (u.x - exact).abs()).fold(0.0, f64::max);
        let what =
            format!("distance from a table that starts at 0.05 s, at t = {:.3} s [m]", simulation.time_s());
        // Places of up to a metre are multiples of ε/2 of it: nine of them.
        row("motion", &what, off, AtMost(1e-15));
    }
    // From (0.001, 0, 0) on at 0.05 s: the block would leap there in the first step, at 1 m/s.
    let refused = ndda_io::read::load_text("case.ron", &late("(0.001, 0, 0)"), &[], None);
    let message = refused.err().unwrap_or_else(|| panic!("a jump is refused")).to_string();
    assert!(message.contains("the motion does not begin where the block is"), "{message}");
}
