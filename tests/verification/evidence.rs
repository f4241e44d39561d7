//! Rows of the verification manual: what was measured beside its answer, asserted and printed in one line, so that
//! `docs/evidence/figures.py` finds every figure of docs/verification/verification.md in the output of the tests.

use std::fmt::{Display, Formatter, Result};
use std::fs::OpenOptions;
use std::io::Write;
use std::panic::Location;

/// Reference value or bound of a measured figure.
#[derive(Clone, Copy)]
pub enum Answer {
    /// A closed form or an independent result, and the error that passes, as a part of it.
    Within(f64, f64),
    /// The same, with an error in the unit of the figure: for answers of zero, angles and orders.
    Near(f64, f64),
    /// The largest value that passes.
    AtMost(f64),
    /// The least value that passes.
    AtLeast(f64),
}

impl Answer {
    /// How far `measured` is off, as the answer counts; nothing for a limit.
    fn error(self, measured: f64) -> Option<f64> {
        match self {
            Answer::Within(answer, _) => Some((measured / answer - 1.0).abs()),
            Answer::Near(answer, _) => Some((measured - answer).abs()),
            Answer::AtMost(_) | Answer::AtLeast(_) => None,
        }
    }

    fn holds(self, measured: f64) -> bool {
        match self {
            Answer::Within(_, tolerance) | Answer::Near(_, tolerance) => {
                self.error(measured).is_some_and(|error| error <= tolerance)
            }
            Answer::AtMost(limit) => measured <= limit,
            Answer::AtLeast(limit) => measured >= limit,
        }
    }
}

impl Display for Answer {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Answer::Within(answer, tolerance) => write!(f, "{answer:e} ± {tolerance:e} of it"),
            Answer::Near(answer, tolerance) => write!(f, "{answer:e} ± {tolerance:e}"),
            Answer::AtMost(limit) => write!(f, "at most {limit:e}"),
            Answer::AtLeast(limit) => write!(f, "at least {limit:e}"),
        }
    }
}

/// Relative error of a sum of so many terms, if each addition rounds the same way. Bounds of what is exact but for rounding are a
/// stated multiple of it.
pub fn rounding(terms: u32) -> f64 {
    f64::from(terms) * f64::EPSILON
}

/// Relative error of what so many steps keep but for their rounding, where each step rounds either way: a walk of n steps of ε is √n ε from where it
/// began, and seldom farther than eight times that.
pub fn rounding_walk(steps: usize) -> f64 {
    8.0 * (steps as f64).sqrt() * f64::EPSILON
}

/// Prints the row `id`, the case in a few words, `what` was measured with its unit; panics unless the answer holds.
#[track_caller]
pub fn row(id: &str, what: &str, measured: f64, answer: Answer) {
    let place = Location::caller();
    let (file, line) = (place.file(), place.line());
    let error = answer.error(measured).map_or_else(|| "-".into(), |e| format!("{e:.1e}"));
    let text = format!("evidence\t{id}\t{file}:{line}\t{what}\t{measured:.5e}\t{answer}\t{error}\n");
    print!("{text}");
    keep(&text);
    assert!(answer.holds(measured), "{id}: {what}: {measured:e}, expected {answer}");
}

/// Appends a line to the file that NDDA_EVIDENCE names, for runs whose output is captured.
fn keep(line: &str) {
    let Some(path) = std::env::var_os("NDDA_EVIDENCE") else { return };
    let file = OpenOptions::new().create(true).append(true).open(path);
    // Written at once: tests run side by side.
    file.and_then(|mut file| file.write_all(line.as_bytes())).expect("NDDA_EVIDENCE names a file");
}
