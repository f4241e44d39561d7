//! The default integrator.

use ndda_mesh::Vec3;

use crate::integrators::time_integrator::{StepWeights, TimeIntegrator};

/// Elasticity weighted by θ, contact at the predicted middle of the step.
///
/// ```text
/// M (v₁ − v₀)/Δt + K [(1 − θ) d₀ + θ d₁] = f(x₀ + ½ Δt v₀)        d₁ = d₀ + Δt (v₀ + v₁)/2
/// ```
///
/// Contact of free blocks is offset by ⅛ Δt² a (`first_step.rs`).
/// θ = ½ neither adds nor removes energy and is second order; its contact map has determinant 1 and is stable for
/// ω_c Δt < 2. θ up to 1 damps high elastic modes. θ = 1 with contact at x₀ would be the paper's scheme.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Midpoint {
    /// θ, from ½ to 1.
    pub theta: f64,
}

impl TimeIntegrator for Midpoint {
    fn name(&self) -> &'static str {
        "Midpoint"
    }

    fn weights(&self, dt_s: f64) -> StepWeights {
        let mass_per_s2 = 2.0 / (dt_s * dt_s);
        StepWeights {
            stiffness: self.theta,
            mass_per_s2,
            velocity_per_m: 2.0 / dt_s,
            mean_velocity: true,
            contact_lead: 0.5,
            contact_lead_acceleration: 0.0,
            load_lead: 0.5,
            new_force: 1.0,
            old_inertia: 0.0,
            needs_acceleration: false,
        }
    }

    fn predict(&self, dt_s: f64, velocity: &Vec3, _acceleration: &Vec3) -> Vec3 {
        dt_s * velocity
    }

    fn correct(
        &self,
        dt_s: f64,
        increment: &Vec3,
        predicted: &Vec3,
        velocity: &mut Vec3,
        acceleration: &mut Vec3,
    ) {
        *acceleration = (increment - predicted) * (2.0 / (dt_s * dt_s));
        *velocity += dt_s * *acceleration;
    }

    fn contact_bound(&self) -> Option<f64> {
        Some(2.0)
    }

    fn damps_elasticity(&self) -> bool {
        self.theta > 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::check_integrator;

    #[test]
    fn it_keeps_the_contract_of_an_integrator() {
        check_integrator(&Midpoint { theta: 0.5 });
        check_integrator(&Midpoint { theta: 0.8 });
    }
}
