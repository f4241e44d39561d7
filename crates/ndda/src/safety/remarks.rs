//! What is said beside the answer, read off its trials and its mechanism.

use super::{Bracket, Safety, State};

/// Remarks to read before using the answer.
pub fn of(answer: &Safety) -> Vec<String> {
    let mut remarks = Vec::new();
    let Bracket { lower, upper } = answer.factor_of_safety;
    let cut_off = answer.mechanism.as_ref().map(|how| &how.cut_off_by).filter(|sides| !sides.is_empty());
    if let Some(sides) = cut_off {
        let sides: Vec<String> = sides.iter().map(|side| format!("`{side}`")).collect();
        remarks.push(format!(
            "what moves is cut off by the model's {} {}: with cohesion, tension, water or several blocks a larger domain may give another factor",
            if sides.len() == 1 { "side" } else { "sides" },
            sides.join(", ")
        ));
    }
    if let (Some(lower), Some(upper)) = (lower, upper) {
        let width = upper / lower - 1.0;
        if width > answer.error * (1.0 + 1e-9) {
            remarks.push(format!(
                "the bracket is {:.1} % wide, {:.1} % was asked for: between its ends blocks neither rest nor accelerate",
                100.0 * width,
                100.0 * answer.error
            ));
        }
        if answer.trials.iter().any(|trial| trial.state == State::Stands && trial.factor > upper) {
            remarks.push(
                "blocks stand at some larger factors, too: the smallest factor at which they fail counts"
                    .into(),
            );
        }
    }
    if let (None, Some(upper)) = (lower, upper) {
        remarks.push(format!("blocks fail at every factor from {upper:.3} on that was tried"));
    }
    if let (Some(lower), None) = (lower, upper) {
        remarks.push(format!(
            "blocks stand at every factor up to {lower:.3}: what is changed does not make them fail"
        ));
    }
    remarks
}
