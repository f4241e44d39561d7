//! A tall stack at rest stays at rest and weighs what it weighs. `NDDA_LARGE=1` makes it 100 slabs and 60 s.

use std::fmt::Write;

use ndda_mesh::BlockId;

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;
use crate::simulation;

const DENSITY: f64 = 2600.0;
const GRAVITY: f64 = 9.8;
const PENALTY_PA: f64 = 1e9;

#[test]
fn a_tall_stack_at_rest_neither_gains_energy_nor_loses_weight() {
    let large = std::env::var_os("NDDA_LARGE").is_some();
    let (slabs, end_s) = if large { (100, 60.0) } else { (20, 1.0) };
    // Slabs of 10 × 10 × 1 m, each as deep in the next as the weight above requires: p = 8 k d for elements a metre high.
    let mut blocks = String::new();
    let mut sunk = 0.0;
    for i in 0..slabs {
        sunk += DENSITY * GRAVITY * f64::from(slabs - i) / (8.0 * PENALTY_PA);
        let z = f64::from(i) - sunk;
        writeln!(
            blocks,
            "(name: \"slab_{i}\", material: \"rock\", body: Rigid, shape: Box(size_m: (10, 10, 1), cells: (1, 1, 1)), at_m: (0, 0, {z})),"
        )
        .unwrap();
    }
    let mut simulation = simulation(&format!(
        "(title: \"stack\", time: (step_s: 2.5e-4, end_s: 1), gravity_m_s2: (0, 0, -{GRAVITY}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: {DENSITY})],
          blocks: [
            (name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (12, 12, 1), cells: (1, 1, 1)), at_m: (-1, -1, -1)),
            {blocks}
          ],
          contact: Potential(penalty_pa: {PENALTY_PA:e}, friction: (friction_deg: 30)))"
    ));
    let start = simulation.sample().unwrap();
    let weight = DENSITY * 100.0 * GRAVITY * f64::from(slabs);
    let steps = (end_s / simulation.step_s()) as usize;
    let (mut force, mut kinetic) = (0.0, [0.0f64; 2]);
    for step in 0..steps {
        simulation.step().unwrap();
        // Force of the slabs on the base; its own weight is not theirs.
        force += simulation.reaction_n(BlockId(0)).z - DENSITY * 144.0 * GRAVITY;
        if step % 50 == 0 {
            let half = usize::from(step > steps / 2);
            kinetic[half] = kinetic[half].max(simulation.sample().unwrap().kinetic_j);
        }
    }
    let worst = simulation.invariants();
    let named = |what: &str| format!("{what}, {slabs} slabs for {end_s} s");
    // Pressure is 8 k d to the first order in the deepest d over the metre of an element; places that are off by some d² leave (10 d)² of the energy
    // to vibrations, and their root of the force. Of the long run only that it is at rest is known.
    let deepest = DENSITY * GRAVITY * f64::from(slabs) / (8.0 * PENALTY_PA);
    let vibrates = if large { 1e-4 } else { (10.0 * deepest).powi(2) };
    row(
        "extreme: tall stack",
        &named("mean force on the base [N]"),
        force / steps as f64,
        Within(weight, vibrates.sqrt().min(1e-3)),
    );
    // The statement: vibrations do not grow. Two that beat have up to twice their mean energy.
    row(
        "extreme: tall stack",
        &named("kinetic energy of the later half over the first"),
        kinetic[1] / kinetic[0],
        AtMost(2.0),
    );
    row(
        "extreme: tall stack",
        &named("kinetic energy over that in contact"),
        kinetic[0] / start.contact_j,
        AtMost(vibrates),
    );
    row("extreme: tall stack", &named("energy gained"), worst.energy_gain, AtMost(vibrates));
}
