//! The headline of a study: the time that each curve takes to reach an error.

use std::fmt::Write as _;

use serde::Serialize;

use super::front::{targets, time_to_error};
use super::result::{Compared, Results};
use crate::columns::columns;

/// Names of the two errors.
pub const WHICH: [&str; 2] = ["error at the end", "largest error over time"];

/// One curve.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Its choices.
    pub curve: String,
    /// The time to each error.
    pub times: Vec<Time>,
}

/// The time to one error.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Time {
    /// The error.
    pub error: f64,
    /// Time by the study's clock [s]; none if no point of the curve is as exact.
    pub time_s: Option<f64>,
    /// That over the time of the fastest curve.
    pub relative: Option<f64>,
}

/// One row per curve, for the error at the end (0) or the largest over time (1).
pub fn rows(results: &Results, which: usize) -> Vec<Row> {
    let errors = targets(results.time_and_error(None, which).iter().map(|point| point.error));
    let curves = results.curve_names().into_iter().map(|curve| {
        let points = results.time_and_error(Some(&curve), which);
        let times: Vec<Option<f64>> = errors.iter().map(|error| time_to_error(&points, *error)).collect();
        (curve, times)
    });
    let curves: Vec<(String, Vec<Option<f64>>)> = curves.collect();
    let fastest = |k: usize| curves.iter().filter_map(|(_, times)| times[k]).fold(f64::INFINITY, f64::min);
    let row = |(curve, times): &(String, Vec<Option<f64>>)| {
        let time = |(k, time_s): (usize, &Option<f64>)| Time {
            error: errors[k],
            time_s: *time_s,
            relative: time_s.map(|t| t / fastest(k)),
        };
        Row { curve: curve.clone(), times: times.iter().enumerate().map(time).collect() }
    };
    curves.iter().map(row).collect()
}

/// The results as text: both tables, what failed and why, and what errors are relative to.
pub fn text(results: &Results) -> String {
    let mut text = format!("{}: {}\n", results.name, results.title);
    for (which, name) in WHICH.iter().enumerate() {
        let rows = rows(results, which);
        if rows.iter().any(|row| !row.times.is_empty()) {
            let _ = writeln!(
                text,
                "{} time to {name} [s], and over that of the fastest\n{}",
                results.clock,
                framed(&rows)
            );
        }
    }
    text.push_str(&against(&results.reference));
    for point in results.points.iter().filter(|point| point.reason.is_some()) {
        let _ = writeln!(text, "failed: {}: {}", point.name, point.reason.as_deref().unwrap_or_default());
    }
    for point in &results.points {
        let beyond = point.figures.as_ref().map_or(&[][..], |figures| &figures.beyond_limits);
        if !beyond.is_empty() {
            let _ = writeln!(text, "beyond its limits: {}: {}", point.name, beyond.join(", "));
        }
    }
    for name in &results.missing {
        let _ = writeln!(text, "not run: {name}");
    }
    text
}

/// Reference of relative errors, in words.
fn against(reference: &Compared) -> String {
    match reference {
        Compared::ClosedForm { name } if name.is_empty() => String::new(),
        Compared::ClosedForm { name } => format!("errors are relative to the closed form {name}\n"),
        Compared::Runs { step_s, disagreement_end, disagreement_max, floor_end, floor_max } => format!(
            "errors are relative to a run with steps of {step_s:e} s, from which a run of another integrator differs by \
             {disagreement_end:.1e} at the end and by {disagreement_max:.1e} at most; errors below five times that, {floor_end:.1e} and \
             {floor_max:.1e}, cannot be resolved and are set to these values\n"
        ),
    }
}

fn framed(rows: &[Row]) -> String {
    let mut header = vec!["curve".to_string()];
    header.extend(rows[0].times.iter().map(|time| format!("{:.0e}", time.error)));
    let line = |row: &Row| {
        let cell = |time: &Time| match (time.time_s, time.relative) {
            (Some(time_s), Some(relative)) => format!("{time_s:.3} ({relative:.2})"),
            _ => "not reached".into(),
        };
        let name = if row.curve.is_empty() { "all" } else { &row.curve };
        std::iter::once(name.to_string()).chain(row.times.iter().map(cell)).collect()
    };
    columns(header, rows.iter().map(line).collect())
}
