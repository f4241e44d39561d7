//! A block on a conveyor belt: a belt that begins to move at once takes momentum from what moves it, none from nowhere, whatever the integrator.

use crate::evidence::Answer::AtMost;
use crate::evidence::{rounding, row};
use crate::simulation;

#[test]
fn a_block_on_a_conveyor_has_the_momentum_that_friction_gives_it_with_every_integrator() {
    for integrator in [
        "Midpoint(theta: 0.5)",
        "GeneralizedAlpha(radius: 0)",
        "GeneralizedAlpha(radius: 0.8)",
        "Newmark(alpha: 0.5, delta: 1)",
        "Newmark(alpha: 0.25, delta: 0.5)",
    ] {
        let mut largest = 0.0f64;
        for body in ["Rigid", "Affine", "Elastic"] {
            let mut simulation = simulation(&format!(
                "(title: \"conveyor\", time: (step_s: 1e-4, end_s: 1, integrator: {integrator}), gravity_m_s2: (0, 0, -9.81),
                  materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2500)],
                  blocks: [
                    (name: \"belt\", material: \"rock\", shape: Box(size_m: (4, 1, 0.5), cells: (4, 1, 1)), body: Fixed),
                    (name: \"block\", material: \"rock\", shape: Box(size_m: (0.5, 0.5, 0.5), cells: (1, 1, 1)), at_m: (0.2, 0.2, 0.5),
                     body: {body}),
                  ],
                  supports: [(block: \"belt\", on: All, hold: Motion([(time_s: 0, displacement_m: (0, 0, 0)),
                    (time_s: 0.05, displacement_m: (0.1, 0, 0)), (time_s: 0.1, displacement_m: (0.1, 0.1, 0))]))],
                  contact: Potential(penalty_pa: 1e9, friction: (friction_deg: 30)))"
            ));
            simulation.sample().unwrap();
            for step in 0..1000 {
                simulation.step().unwrap();
                if step % 100 == 0 {
                    simulation.sample().unwrap();
                }
            }
            simulation.sample().unwrap();
            largest = largest.max(simulation.invariants().linear_momentum);
        }
        // All momentum is booked: rounding of 1000 steps.
        row("conveyor", &format!("momentum from nowhere, {integrator}"), largest, AtMost(rounding(1000)));
    }
}
