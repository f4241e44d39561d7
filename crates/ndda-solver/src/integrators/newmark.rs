//! The paper's integrator.

use ndda_mesh::Vec3;

use crate::integrators::time_integrator::{StepWeights, TimeIntegrator};

/// Newmark's method (eqs 7–13) with contact at the positions of the previous step.
///
/// ```text
/// u  = Δt v₀ + Δt² [(½ − α) a₀ + α a₁]        v₁ = v₀ + Δt [(1 − δ) a₀ + δ a₁]
/// ```
///
/// α = ½, δ = 1 is the paper's choice and Shi's. Elasticity is unconditionally stable; contact, taken at the old
/// positions, gains energy at every Δt: restitution ≈ exp(π ω_c Δt / 4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Newmark {
    /// α (β elsewhere).
    pub alpha: f64,
    /// δ (γ elsewhere).
    pub delta: f64,
}

impl TimeIntegrator for Newmark {
    fn name(&self) -> &'static str {
        "Newmark"
    }

    fn weights(&self, dt_s: f64) -> StepWeights {
        let mass_per_s2 = 1.0 / (self.alpha * dt_s * dt_s);
        StepWeights {
            stiffness: 1.0,
            mass_per_s2,
            velocity_per_m: self.delta / (self.alpha * dt_s),
            mean_velocity: self.delta == 2.0 * self.alpha,
            contact_lead: 0.0,
            contact_lead_acceleration: 0.0,
            // With δ = 1 the forces of a step are all that changes its momentum.
            load_lead: if self.delta == 1.0 { 0.5 } else { 1.0 },
            new_force: self.delta,
            old_inertia: 0.0,
            needs_acceleration: self.alpha != 0.5 || self.delta != 1.0,
        }
    }

    fn predict(&self, dt_s: f64, velocity: &Vec3, acceleration: &Vec3) -> Vec3 {
        dt_s * velocity + dt_s * dt_s * (0.5 - self.alpha) * acceleration
    }

    fn correct(
        &self,
        dt_s: f64,
        increment: &Vec3,
        predicted: &Vec3,
        velocity: &mut Vec3,
        acceleration: &mut Vec3,
    ) {
        let new = (increment - predicted) / (self.alpha * dt_s * dt_s);
        *velocity += dt_s * ((1.0 - self.delta) * *acceleration + self.delta * new);
        *acceleration = new;
    }

    fn contact_bound(&self) -> Option<f64> {
        None
    }

    fn damps_elasticity(&self) -> bool {
        self.delta > 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::check_integrator;

    #[test]
    fn it_keeps_the_contract_of_an_integrator() {
        check_integrator(&Newmark { alpha: 0.5, delta: 1.0 });
        check_integrator(&Newmark { alpha: 0.25, delta: 0.5 });
    }
}
