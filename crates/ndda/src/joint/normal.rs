//! How a joint closes under a normal stress.

use ndda_contact::HyperbolicClosure;
use serde::Serialize;

use super::{JointError, positive};

/// Closure V of a joint under a normal stress σ.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum NormalStiffness {
    /// It does not close.
    Rigid,
    /// σ = k_n V.
    Linear {
        /// k_n [Pa/m].
        stiffness_pa_m: f64,
    },
    /// σ = k_ni V/(1 − V/V_m) (Bandis, Lumsden & Barton 1983).
    Hyperbolic {
        /// Initial stiffness k_ni [Pa/m].
        initial_pa_m: f64,
        /// Largest closure V_m [m].
        most_m: f64,
    },
}

impl NormalStiffness {
    /// Whether its numbers are above zero.
    ///
    /// # Errors
    /// [`JointError::OutOfRange`].
    pub fn check(&self) -> Result<(), JointError> {
        match *self {
            Self::Rigid => Ok(()),
            Self::Linear { stiffness_pa_m } => positive("the joint's stiffness", stiffness_pa_m),
            Self::Hyperbolic { initial_pa_m, most_m } => {
                positive("the joint's stiffness", initial_pa_m)?;
                positive("the largest closure", most_m)
            }
        }
    }

    /// Closure V under a normal stress [m].
    pub fn closure_m(&self, stress_pa: f64) -> f64 {
        match *self {
            Self::Rigid => 0.0,
            Self::Linear { stiffness_pa_m } => stress_pa / stiffness_pa_m,
            Self::Hyperbolic { initial_pa_m, most_m } => {
                HyperbolicClosure { initial_pa_m, most_m }.closure_m(stress_pa)
            }
        }
    }

    /// Normal stress at a closure [Pa]; none for a rigid joint.
    pub fn stress_pa(&self, closure_m: f64) -> f64 {
        match *self {
            Self::Rigid => 0.0,
            Self::Linear { stiffness_pa_m } => stiffness_pa_m * closure_m,
            Self::Hyperbolic { initial_pa_m, most_m } => {
                HyperbolicClosure { initial_pa_m, most_m }.stress_pa(closure_m)
            }
        }
    }

    /// Tangent stiffness dσ/dV under a normal stress [Pa/m].
    pub fn tangent_pa_m(&self, stress_pa: f64) -> f64 {
        match *self {
            Self::Rigid => f64::INFINITY,
            Self::Linear { stiffness_pa_m } => stiffness_pa_m,
            Self::Hyperbolic { initial_pa_m, most_m } => {
                let law = HyperbolicClosure { initial_pa_m, most_m };
                law.tangent_pa_m(law.closure_m(stress_pa))
            }
        }
    }

    /// Energy ∫ σ dV at a closure [J/m²].
    pub fn energy_j_m2(&self, closure_m: f64) -> f64 {
        match *self {
            Self::Rigid => 0.0,
            Self::Linear { stiffness_pa_m } => 0.5 * stiffness_pa_m * closure_m * closure_m,
            Self::Hyperbolic { initial_pa_m, most_m } => {
                HyperbolicClosure { initial_pa_m, most_m }.energy_j_m2(closure_m)
            }
        }
    }
}
