//! Why a fall could not be computed to its end, with a cure that a scene of boulders can follow.

use ndda_solver::{BlockError, SetupError, StepError};

/// Why the solver stopped, with advice for rockfalls: its own names fields that a rockfall scene does not have, and its time is that of a part of the fall.
pub(super) fn why(error: &StepError) -> String {
    let cause = match error {
        StepError::NoStepIsShortEnough { step_s, .. } => {
            format!("contact is too stiff or too fast even for steps of {step_s:e} s")
        }
        StepError::PastCentroid { .. } => {
            "the boulder is so deep in the ground that contact no longer pushes it out".into()
        }
        StepError::Block { source: BlockError::TurnsTooFar { angle_rad, .. }, .. } => {
            format!("the boulder turns by {angle_rad:.1} rad in one step, too far to be computed")
        }
        StepError::Block { source: BlockError::ForceNotFinite, .. } => {
            "the forces on the boulder are not finite".into()
        }
        other => return other.to_string(),
    };
    format!(
        "{cause}: take a smaller rockfall.detail.impact_m_s, with which contact is softer, or a shorter time.step_s"
    )
}

/// Why a part of a fall could not begin.
pub(super) fn why_not_begun(error: &SetupError) -> String {
    match error {
        SetupError::Contact(error) => why(error),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_names_fields_of_a_rockfall() {
        let source = BlockError::ForceNotFinite;
        let errors = [
            StepError::NoStepIsShortEnough { time_s: 0.25, step_s: 1e-7 },
            StepError::Block { time_s: 0.25, block: "boulder".into(), source },
        ];
        for error in errors {
            let said = why(&error);
            assert!(said.ends_with("or a shorter time.step_s"), "{said}");
            assert!(!said.contains("step_s or") && !said.contains("penalty_pa"), "{said}");
            assert_eq!(why_not_begun(&SetupError::Contact(Box::new(error))), said);
        }
    }
}
