//! The results of a study as files: `study.json`, `study.csv`, `time_to_error.csv`.

use std::path::Path;

use ndda_io::WriteError;
use serde::Serialize;

use super::result::{CasePoint, Compared, Results};
use super::table::{self, Row};
use crate::documents::{write_csv, write_json};

/// Schema of `study.json`; it changes when a key does.
const SCHEMA: &str = "ndda.study/1";

/// Content of `study.json`.
#[derive(Serialize)]
struct Document<'a> {
    schema: &'static str,
    study: &'a str,
    title: &'a str,
    scene: &'a str,
    curves: &'a [String],
    clock: &'a str,
    reference: &'a Compared,
    cases: &'a [CasePoint],
    not_run: &'a [String],
    time_to_error_s: TimeToError,
}

/// The headline table, at the end and over time.
#[derive(Serialize)]
struct TimeToError {
    end: Vec<Row>,
    max: Vec<Row>,
}

/// Writes all files; returns the JSON.
///
/// # Errors
/// [`WriteError`] when one of them cannot be written.
pub fn all(out: &Path, results: &Results) -> Result<String, WriteError> {
    let time_to_error_s = TimeToError { end: table::rows(results, 0), max: table::rows(results, 1) };
    let times = times(&time_to_error_s);
    let document = Document {
        schema: SCHEMA,
        study: &results.name,
        title: &results.title,
        scene: &results.scene,
        curves: &results.curves,
        clock: results.clock,
        reference: &results.reference,
        cases: &results.points,
        not_run: &results.missing,
        time_to_error_s,
    };
    let json = write_json(&out.join("study.json"), &document)?;
    write_csv(&out.join("study.csv"), &cases(results))?;
    write_csv(&out.join("time_to_error.csv"), &times)?;
    Ok(json)
}

/// Header and one row per case.
fn cases(results: &Results) -> Vec<Vec<String>> {
    let axes = results.points.first().map_or(&[][..], |point| &point.labels.0);
    let stages = results.points.iter().find_map(|point| point.figures.as_ref()).map(|f| &f.run.stages_s);
    let stages: Vec<&String> = stages.into_iter().flatten().map(|(name, _)| name).collect();
    let fixed = "status reason label label_reasons error_end error_max place_end h front_end front_max wall_s \
                 walls_s processors_s steps step_s blocks tets dofs candidate_pairs_total clips_total \
                 peak_memory_b threads processor commit version features beyond_limits";
    let mut header: Vec<String> = vec!["case".into()];
    header.extend(axes.iter().map(|(axis, _)| axis.clone()));
    header.extend(fixed.split_whitespace().map(String::from));
    header.extend(stages.iter().map(|stage| format!("stage_{stage}_s")));
    let mut rows = vec![header];
    for point in &results.points {
        let mut row = vec![point.name.clone()];
        row.extend(point.labels.0.iter().map(|(_, label)| label.clone()));
        row.extend(figures(point, &stages));
        row.resize(rows[0].len(), String::new());
        rows.push(row);
    }
    let blank = |name: &String| {
        let mut row = vec![String::new(); rows[0].len()];
        (row[0], row[1 + axes.len()]) = (name.clone(), "not run".into());
        row
    };
    let missing: Vec<Vec<String>> = results.missing.iter().map(blank).collect();
    rows.into_iter().chain(missing).collect()
}

/// The cells of a case after its labels.
fn figures(point: &CasePoint, stages: &[&String]) -> Vec<String> {
    let Some(f) = &point.figures else {
        return vec!["failed".into(), point.reason.clone().unwrap_or_default()];
    };
    let (run, counts, machine) = (&f.run, &f.run.counts, &f.run.machine);
    let all = |times_s: &[f64]| times_s.iter().map(|s| s.to_string()).collect::<Vec<_>>().join(" ");
    let label = &run.label;
    let mut cells = vec!["done".into(), String::new(), label.word.as_str().into(), label.reasons.join("; ")];
    cells.extend([f.error_end, f.error_max].map(|e| format!("{e:e}")));
    let place = run.reference.as_ref().and_then(|reference| reference.place_end);
    cells.push(place.map_or(String::new(), |place| format!("{place:e}")));
    cells.push(format!("{:e}", run.invariants.max_h));
    cells.extend(f.on_front.map(|on| on.to_string()));
    cells.extend([f.wall_s.to_string(), all(&f.walls_s), all(&f.processors_s)]);
    cells.extend([run.steps.to_string(), format!("{:e}", run.step_s)]);
    let totals = [counts.blocks, counts.tets, counts.dofs, counts.candidate_pairs_total, counts.clips_total];
    cells.extend(totals.map(|count| count.to_string()));
    cells.push(machine.peak_memory_b.map_or(String::new(), |b| b.to_string()));
    cells.extend([run.threads.to_string(), machine.processor.clone(), machine.commit.clone()]);
    cells.extend([run.version.clone(), machine.features.join(" "), f.beyond_limits.join("; ")]);
    cells
        .extend(stages.iter().map(|stage| run.stages_s.get(*stage).map_or(String::new(), |s| s.to_string())));
    cells
}

/// Header and one row per curve and target.
fn times(both: &TimeToError) -> Vec<Vec<String>> {
    let mut lines = vec![["error", "of", "curve", "time_s", "relative"].map(String::from).to_vec()];
    for (of, rows) in [("end", &both.end), ("max", &both.max)] {
        for row in rows {
            for cell in &row.times {
                let or_not = |value: Option<f64>| value.map_or("not reached".into(), |v| v.to_string());
                let (time, relative) = (or_not(cell.time_s), or_not(cell.relative));
                lines.push(vec![format!("{:e}", cell.error), of.into(), row.curve.clone(), time, relative]);
            }
        }
    }
    lines
}
