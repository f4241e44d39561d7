//! Tests of one joint as in a laboratory: direct shear and normal closure of a law, without blocks and without time.
//!
//! A joint of one square metre is pressed to a normal stress and sheared by prescribed displacements. It bears shear by the law of both of its sides, as contact
//! in a run does, and closes by a normal stiffness. In direct shear the normal stress is constant, or a spring of stiffness K holds the joint, or nothing
//! lets it open:
//!
//! ```text
//! (σ − σ₀)/K + V(σ) − V(σ₀) = v          K = 0: σ = σ₀        K → ∞: constant volume
//! ```
//!
//! V being the closure under a normal stress, v the opening by slip (dilation). Energy that is lost is ∫ τ du_p − ∫ σ dv, u_p being the slip beyond the
//! stretch of the shear spring.

mod closed_form;
mod closure;
mod compare;
mod files;
mod normal;
mod outcome;
mod path;
#[cfg(feature = "plots")]
mod picture;
mod report;
mod select;
mod shear;
mod side;

pub use closed_form::shear as shear_comparisons;
pub use closure::{ClosureRow, ClosureTest, comparisons as closure_comparisons};
pub use compare::Comparison;
pub use files::write;
pub use normal::NormalStiffness;
pub use outcome::{SCENE_OF_A_LAW, TestOutcome};
pub use path::path;
pub use report::{Rows, text};
pub use select::{SelectError, Which, friction, normal_stiffness};
pub use shear::{Hold, ShearRow, ShearTest};

/// Why a joint cannot be tested.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum JointError {
    /// A number that a test cannot begin with.
    #[error("{what} is {value}: {advice}")]
    OutOfRange {
        /// Name of the quantity.
        what: &'static str,
        /// The number.
        value: f64,
        /// The range that is allowed.
        advice: &'static str,
    },
    /// An option of shear tests, given to another test.
    #[error(
        "{0} is for shear tests, and has no effect on the closure of a joint: leave it out, or give --test shear"
    )]
    OfShear(&'static str),
    /// A joint that may not open, or that a spring holds, needs a normal stiffness.
    #[error(
        "at constant volume the normal stress follows from a normal stiffness: give --joint-stiffness, or a scene with \
         `potential: Smooth()` or `Closure(…)`"
    )]
    NoStiffness,
    /// No normal stress holds the balance.
    #[error("no normal stress balances the opening of the joint at a slip of {slip_m} m: use more --steps")]
    NoBalance {
        /// Slip then [m].
        slip_m: f64,
    },
}

/// Refuses options of shear tests in another test: whether an amplitude, cycles, constant volume and a spring are given.
///
/// # Errors
/// [`JointError::OfShear`] with the first that is.
pub fn refuse_of_shear(given: [bool; 4]) -> Result<(), JointError> {
    let options = ["--amplitude", "--cycles", "--constant-volume", "--spring"];
    let given = options.into_iter().zip(given).find(|(_, is_given)| *is_given);
    given.map_or(Ok(()), |(option, _)| Err(JointError::OfShear(option)))
}

/// A number that must be above zero, and finite.
pub(crate) fn positive(what: &'static str, value: f64) -> Result<(), JointError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(JointError::OutOfRange { what, value, advice: "give a number above 0" })
}
