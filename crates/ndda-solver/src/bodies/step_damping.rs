//! Rayleigh damping in a step.

use ndda_fem::Damping;

use crate::bodies::mass_damping::MassDamping;
use crate::integrators::time_integrator::StepWeights;

/// Part of the step, times b/2, by which the implicit filter of velocities weights K: see
/// [`StiffnessDamping`](crate::bodies::stiffness_damping::StiffnessDamping).
const FILTER: f64 = 2.0;

/// Rayleigh damping in steps of one length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepDamping {
    /// b/Δt: damping of stiffness exerts −b/Δt K (w₁ − w₀).
    pub stiffness: f64,
    /// k = b Δt [s²]: the filter of velocities divides by M + k K.
    pub filter_s2: f64,
    /// Damping in proportion to mass.
    pub mass: Option<MassDamping>,
}

impl StepDamping {
    /// Of a material in a step Δt [s] of an integrator with these weights.
    pub(crate) fn new(damping: &Damping, dt_s: f64, weights: &StepWeights) -> Self {
        Self {
            stiffness: damping.stiffness_s / dt_s,
            filter_s2: FILTER * 0.5 * damping.stiffness_s * dt_s,
            mass: MassDamping::new(damping.mass_per_s, dt_s, weights),
        }
    }

    /// Whether there is none.
    pub(crate) fn is_none(&self) -> bool {
        self.stiffness == 0.0 && self.mass.is_none()
    }

    /// The integrator's weights with damping in proportion to mass.
    pub(crate) fn weights(&self, weights: &StepWeights) -> StepWeights {
        self.mass.map_or(*weights, |mass| mass.weights(weights))
    }
}
