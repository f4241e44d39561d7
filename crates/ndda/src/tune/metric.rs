//! The error of a trial: that against the scene's closed form, or against a run that is certified.

use std::collections::HashMap;

use ndda_io::table::Table;

use super::TuneError;
use crate::certify::extrapolate::estimate;
use crate::certify::quantities::{Kind, Quantity, common_rows, named, quantities, values_of};
use crate::certify::runs::Ended;

/// Differences of runs that halve the step are extrapolated with at most this order.
const MOST_ORDER: f64 = 2.0;

/// Reference of trials.
pub enum Metric {
    /// The closed form of the scene.
    ClosedForm,
    /// A run, and how wrong it may be itself.
    Run {
        /// Its history.
        history: Table,
        /// Compared quantities.
        quantities: Vec<Quantity>,
        /// Its own relative error.
        error: f64,
    },
}

impl Metric {
    /// The relative error of a trial, what the reference may be wrong by included: the largest over time.
    ///
    /// # Errors
    /// [`TuneError::NoClosedForm`] when the run has not been compared with one.
    pub fn error(&self, run: &Ended) -> Result<f64, TuneError> {
        match self {
            Self::ClosedForm => {
                run.summary.reference.as_ref().map(|exact| exact.error_max).ok_or(TuneError::NoClosedForm)
            }
            Self::Run { history, quantities, error } => {
                Ok(largest_difference(&run.history, history, quantities) + error)
            }
        }
    }
}

/// Compared quantities: columns and blocks whose names begin with one of `of`; without them the displacements of the scene's
/// monitors, or of all blocks where it has none.
pub fn compared(history: &Table, of: &[String], monitors: &[String]) -> Vec<Quantity> {
    let all = quantities(history, of);
    if !of.is_empty() {
        return all.into_iter().filter(|q| of.iter().any(|wanted| named(&q.name, wanted))).collect();
    }
    let moved: Vec<Quantity> =
        all.into_iter().filter(|quantity| quantity.kind == Kind::Displacement).collect();
    let of_monitor =
        |q: &&Quantity| monitors.iter().any(|m| q.name.strip_prefix(m).is_some_and(|r| r.starts_with('.')));
    let of_monitors: Vec<Quantity> = moved.iter().filter(of_monitor).cloned().collect();
    if of_monitors.is_empty() { moved } else { of_monitors }
}

/// The largest difference of two runs at the instants that they share, each quantity relative to the largest value of its
/// kind in the second; infinite where they share none but the first.
pub fn largest_difference(run: &Table, reference: &Table, quantities: &[Quantity]) -> f64 {
    let rows = common_rows(&[run, reference]);
    if rows[0].len() < 2 {
        return f64::INFINITY;
    }
    let size = |quantity: &Quantity| {
        let column = reference.column_near(quantity.column, &quantity.name).unwrap_or_default();
        column.iter().map(|v| v.abs()).fold(0.0, f64::max)
    };
    let group = |quantity: &Quantity| (quantity.kind == Kind::Other).then_some(quantity.group);
    let mut scales: HashMap<(Kind, Option<usize>), f64> = HashMap::new();
    for quantity in quantities {
        let scale = scales.entry((quantity.kind, group(quantity))).or_default();
        *scale = scale.max(size(quantity));
    }
    let relative = quantities.iter().map(|quantity| {
        let of = |table: &Table, rows: &[usize]| values_of(table, quantity, rows);
        let (own, other) = (of(run, &rows[0]), of(reference, &rows[1]));
        let apart = own.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let scale = scales[&(quantity.kind, group(quantity))];
        if scale > 0.0 { apart / scale } else { apart }
    });
    relative.fold(0.0, f64::max)
}

/// The relative error of the last of three runs whose steps halve.
pub fn error_of_last(runs: [&Table; 3], quantities: &[Quantity]) -> f64 {
    let first = largest_difference(runs[0], runs[1], quantities);
    let last = largest_difference(runs[1], runs[2], quantities);
    if !first.is_finite() || !last.is_finite() {
        return f64::INFINITY;
    }
    estimate([first + last, last, 0.0], MOST_ORDER, f64::EPSILON).error
}
