//! The bracket that trials give, and the factors to try next.

use crate::safety::trial::{State, Trial};
use crate::safety::{Bracket, Plan, Safety};

/// Factor between the trials that look for a bracket.
const STRIDE: f64 = 1.5;
/// Trials inside a bracket that run side by side.
const INSIDE: usize = 3;

/// The smallest factor at which blocks fail, and the largest below it at which they stand.
pub(super) fn bracket(trials: &[Trial]) -> Bracket {
    let of = |state: State| trials.iter().filter(move |trial| trial.state == state).map(|trial| trial.factor);
    let upper = of(State::Fails).reduce(f64::min);
    let lower = of(State::Stands).filter(|factor| upper.is_none_or(|upper| *factor < upper)).reduce(f64::max);
    Bracket { lower, upper }
}

/// Factors to try next: outwards until there is a bracket, inwards until it is narrow; around what is undecided.
pub(super) fn factors(answer: &Safety, plan: &Plan) -> Vec<f64> {
    if answer.trials.is_empty() {
        return vec![1.0, STRIDE];
    }
    let first = answer.trials[0].factor;
    let last = answer.trials[answer.trials.len() - 1].factor;
    match bracket(&answer.trials) {
        Bracket { lower: Some(lower), upper: Some(upper) } => inside(answer, (lower, upper), plan.error),
        Bracket { upper: None, .. } if last < plan.most => {
            vec![(last * STRIDE).min(plan.most), (last * STRIDE * STRIDE).min(plan.most)]
        }
        Bracket { lower: None, upper: Some(_) } if first > 1.0 / plan.most => {
            vec![(first / STRIDE).max(1.0 / plan.most), (first / (STRIDE * STRIDE)).max(1.0 / plan.most)]
        }
        _ => Vec::new(),
    }
}

fn inside(answer: &Safety, (lower, upper): (f64, f64), error: f64) -> Vec<f64> {
    let is_wide = |a: f64, b: f64, error: f64| b / a > 1.0 + error;
    let between = |a: f64, b: f64, part: f64| a * (b / a).powf(part);
    let undecided = answer.trials.iter().filter(|t| t.factor > lower && t.factor < upper).map(|t| t.factor);
    let undecided: Vec<f64> = undecided.collect();
    match undecided.as_slice() {
        [] if is_wide(lower, upper, error) => {
            (1..=INSIDE).map(|k| between(lower, upper, k as f64 / (INSIDE + 1) as f64)).collect()
        }
        [] => Vec::new(),
        [first, .., last] | [first @ last] => [(lower, *first), (*last, upper)]
            .into_iter()
            .filter(|(a, b)| is_wide(*a, *b, 0.5 * error))
            .map(|(a, b)| between(a, b, 0.5))
            .collect(),
    }
}
