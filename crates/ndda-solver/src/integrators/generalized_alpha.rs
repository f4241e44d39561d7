//! An integrator that damps what it cannot resolve.

use ndda_mesh::Vec3;

use crate::integrators::newmark::Newmark;
use crate::integrators::time_integrator::{StepWeights, TimeIntegrator};

/// The generalised-α method (Chung & Hulbert 1993) with contact at predicted positions.
///
/// ```text
/// M [(1 − α_m) a₁ + α_m a₀] + K [(1 − α_f) d₁ + α_f d₀] = f(x*)
/// α_m = (2ρ − 1)/(ρ + 1)     α_f = ρ/(ρ + 1)     γ = ½ − α_m + α_f     β = ¼ (1 − α_m + α_f)²
/// x* = x + (1 − α_f) Δt v + α_m (½ − α_m)/3 · Δt² a
/// ```
///
/// Second order; elastic modes far above 1/Δt fall to ρ of their size in each step. With this x* contact neither adds
/// nor removes energy, whatever ρ, up to ω_c Δt = 2: the pair of eigenvalues of its map lies on the unit circle, and
/// the third inside (a test computes them). ρ = 1 moves as [`Midpoint`](crate::Midpoint) does with θ = ½.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneralizedAlpha {
    /// ρ, the spectral radius at infinite frequency, from 0 to 1.
    pub radius: f64,
}

impl GeneralizedAlpha {
    /// α_m and α_f.
    fn shares(&self) -> (f64, f64) {
        ((2.0 * self.radius - 1.0) / (self.radius + 1.0), self.radius / (self.radius + 1.0))
    }

    /// The formulas of motion are Newmark's, with β and γ.
    fn newmark(&self) -> Newmark {
        let (on_mass, on_stiffness) = self.shares();
        let shift = on_stiffness - on_mass;
        Newmark { alpha: 0.25 * (1.0 + shift) * (1.0 + shift), delta: 0.5 + shift }
    }
}

impl TimeIntegrator for GeneralizedAlpha {
    fn name(&self) -> &'static str {
        "GeneralizedAlpha"
    }

    fn weights(&self, dt_s: f64) -> StepWeights {
        let (on_mass, on_stiffness) = self.shares();
        let newmark = self.newmark().weights(dt_s);
        StepWeights {
            stiffness: 1.0 - on_stiffness,
            mass_per_s2: (1.0 - on_mass) * newmark.mass_per_s2,
            mean_velocity: false,
            contact_lead: 1.0 - on_stiffness,
            contact_lead_acceleration: on_mass * (0.5 - on_mass) / 3.0,
            load_lead: 1.0 - on_stiffness,
            old_inertia: on_mass,
            needs_acceleration: true,
            ..newmark
        }
    }

    fn predict(&self, dt_s: f64, velocity: &Vec3, acceleration: &Vec3) -> Vec3 {
        self.newmark().predict(dt_s, velocity, acceleration)
    }

    fn correct(
        &self,
        dt_s: f64,
        increment: &Vec3,
        predicted: &Vec3,
        velocity: &mut Vec3,
        acceleration: &mut Vec3,
    ) {
        self.newmark().correct(dt_s, increment, predicted, velocity, acceleration);
    }

    fn contact_bound(&self) -> Option<f64> {
        Some(2.0)
    }

    fn damps_vibrations(&self) -> bool {
        self.radius < 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{check_integrator, contact_radius};

    #[test]
    fn it_keeps_the_contract_of_an_integrator() {
        for radius in [0.0, 0.3, 0.5, 0.8, 1.0] {
            check_integrator(&GeneralizedAlpha { radius });
        }
    }

    #[test]
    fn contact_is_neutral_up_to_its_bound_and_no_further() {
        for radius in [0.0, 0.1, 0.3, 0.5, 0.8, 0.95] {
            let integrator = GeneralizedAlpha { radius };
            for h in [0.01, 0.1, 0.5, 1.0, 1.5, 1.9] {
                let largest = contact_radius(&integrator, h);
                assert!((largest - 1.0).abs() < 1e-12, "ρ = {radius}, h = {h}: {largest}");
            }
            assert!(contact_radius(&integrator, 2.05) > 1.05, "ρ = {radius}");
        }
    }
}
