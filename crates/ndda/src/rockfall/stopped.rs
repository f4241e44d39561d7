//! Why a fall could not be computed to its end, with a cure that a scene of boulders can follow.

/// The solver's message with advice for rockfalls. Its time is that of a part of the fall, and its own advice names fields that a rockfall scene does not have.
pub(super) fn with_a_cure(said: &str) -> String {
    let after_time = said.strip_prefix("at t = ").and_then(|rest| rest.split_once(" s: "));
    let said = after_time.map_or(said, |(_, rest)| rest);
    let why = said.split(": reduce ").next().unwrap_or(said);
    format!(
        "{why}: take a smaller rockfall.detail.impact_m_s, with which contact is softer, or a shorter time.step_s"
    )
}

#[cfg(test)]
mod tests {
    use ndda_solver::StepError;

    use super::*;

    #[test]
    fn advice_names_fields_of_a_rockfall() {
        let error = StepError::NoStepIsShortEnough { time_s: 0.25, step_s: 1e-7 };
        let said = with_a_cure(&error.to_string());
        assert_eq!(
            said,
            "contact is too stiff or too fast even for steps of 1e-7 s: take a smaller rockfall.detail.impact_m_s, \
             with which contact is softer, or a shorter time.step_s"
        );
        assert!(with_a_cure("no time and no advice").starts_with("no time and no advice: take"));
    }
}
