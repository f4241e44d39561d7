//! A block moved by a table: every node follows it, linear between the rows and resting after the last.

use ndda_mesh::Vec3;

use crate::evidence::Answer::AtMost;
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
