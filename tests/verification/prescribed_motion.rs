//! A block moved by a table: every node follows it, linear between the rows and resting after the last.

use ndda_mesh::Vec3;

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;
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
    row("motion", "energy from nowhere over it", sample.balance_j.abs() / kinetic_j, AtMost(1e-12));
}
