//! Twins that have no end.

use ndda_solver::StepError;

use super::Twin;
use crate::summary::LabelWord;

/// Why a twin has no end.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Failed {
    /// Its scene does not come to rest before it begins.
    Settling(String),
    /// It stops on its way.
    Steps(String),
}

impl Failed {
    /// The label that this gives to the run.
    pub(super) fn word(&self, twin: Twin) -> LabelWord {
        match (self, twin) {
            (Self::Steps(_), Twin::Push(_)) => LabelWord::Sensitive,
            _ => LabelWord::Inaccurate,
        }
    }

    /// Why it does.
    pub(super) fn reason(&self, twin: Twin) -> String {
        let how = match twin {
            Twin::Push(_) => "from a slightly different start",
            Twin::HalfStep => "with half the step",
        };
        match self {
            Self::Settling(error) => format!(
                "it is not known whether the result changes, since a second run {how} could not begin: {error}"
            ),
            Self::Steps(error) => format!("a second run {how} stopped, which the first one did not: {error}"),
        }
    }
}

impl From<StepError> for Failed {
    fn from(error: StepError) -> Self {
        match error {
            StepError::NotSettled { .. } => Self::Settling(error.to_string()),
            _ => Self::Steps(error.to_string()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_twin_that_does_not_come_to_rest_says_nothing_of_sensitivity() {
        let settling = Failed::Settling("the scene has not come to rest".into());
        let steps = Failed::Steps("at t = 1 s: a tetrahedron is inverted".into());
        for (twin, words) in [
            (Twin::Push(1.0), [LabelWord::Inaccurate, LabelWord::Sensitive]),
            (Twin::HalfStep, [LabelWord::Inaccurate; 2]),
        ] {
            assert_eq!([settling.word(twin), steps.word(twin)], words);
        }
        let reason = settling.reason(Twin::HalfStep);
        assert!(
            reason.contains("with half the step could not begin: the scene has not come to rest"),
            "{reason}"
        );
    }
}
