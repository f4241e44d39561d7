//! Two free blocks, one of which spins, meet off centre: nothing outside acts, so momentum and angular momentum stay,
//! whatever the integrator.

use crate::evidence::Answer::AtMost;
use crate::evidence::{rounding_walk, row};
use crate::simulation;

const STEPS: usize = 1500;

#[test]
fn a_glancing_collision_keeps_momentum_and_angular_momentum_with_every_integrator() {
    let integrators = [
        "Midpoint(theta: 0.5)",
        "Midpoint(theta: 0.9)",
        "GeneralizedAlpha(radius: 0.8)",
        "GeneralizedAlpha(radius: 0)",
        "Newmark(alpha: 0.5, delta: 1)",
        "Newmark(alpha: 0.25, delta: 0.5)",
    ];
    for integrator in integrators {
        let mut simulation = simulation(&format!(
            "(title: \"glancing\", time: (step_s: 2e-4, end_s: 1, integrator: {integrator}),
              materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2500)],
              blocks: [
                (name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 1, 1)), velocity_m_s: (2, 0, 0.3),
                 spin_rad_s: (0.5, 2, -1)),
                (name: \"b\", material: \"rock\", shape: Box(size_m: (1, 0.5, 1), cells: (1, 1, 1)), at_m: (1.01, 0.6, 0.7)),
              ],
              contact: Potential(penalty_pa: 1e7, friction: (friction_deg: 30, shear_penalty_pa_m: 1e7)))"
        ));
        simulation.sample().unwrap();
        let mut pairs = 0;
        for step in 0..STEPS {
            pairs += simulation.step().unwrap().contact.contact_pairs;
            if step % 100 == 0 {
                simulation.sample().unwrap();
            }
        }
        simulation.sample().unwrap();
        let worst = simulation.invariants();
        assert!(pairs > 100, "they do not meet");
        let rounds = AtMost(rounding_walk(STEPS));
        row("glancing", &format!("momentum, {integrator}"), worst.linear_momentum, rounds);
        row("glancing", &format!("angular momentum, {integrator}"), worst.angular_momentum, rounds);
    }
}
