//! Results of a sweep as files: `sweep.json`, `sweep.csv`, and with the feature `parquet` the numbers of it as `sweep.parquet`.

use std::path::Path;

use ndda_io::WriteError;

use super::result::Results;
use crate::documents::{write_csv, write_json};

/// Writes all files; returns the JSON.
///
/// # Errors
/// [`WriteError`] when one of them cannot be written.
pub(super) fn all(out: &Path, results: &Results) -> Result<String, WriteError> {
    let json = write_json(&out.join("sweep.json"), results)?;
    write_csv(&out.join("sweep.csv"), &table(results))?;
    #[cfg(feature = "parquet")]
    parquet(out, results)?;
    Ok(json)
}

/// Header and one row per case.
fn table(results: &Results) -> Vec<Vec<String>> {
    let fixed = ["case", "status", "reason", "label", "fails"].map(String::from);
    let mut rows = vec![[&fixed[..], &results.axes, &results.quantities].concat()];
    for row in &results.cases {
        let status = if row.reason.is_some() { "failed" } else { "done" };
        let mut cells = vec![row.name.clone(), status.into(), row.reason.clone().unwrap_or_default()];
        cells.push(row.label.clone().unwrap_or_default());
        cells.push(row.fails.map_or(String::new(), |fails| fails.to_string()));
        cells.extend(row.labels.iter().cloned());
        cells.extend(row.values.iter().map(|value| value.map_or(String::new(), |v| format!("{v:e}"))));
        rows.push(cells);
    }
    rows
}

/// The axes whose values are numbers and the quantities; NaN where a case has none.
#[cfg(feature = "parquet")]
fn parquet(out: &Path, results: &Results) -> Result<(), WriteError> {
    let number = |text: &String| text.parse::<f64>().ok().filter(|number| number.is_finite());
    let numeric = |i: &usize| results.cases.iter().all(|row| row.labels.get(*i).and_then(number).is_some());
    let axes: Vec<usize> = (0..results.axes.len()).filter(numeric).collect();
    let names = axes.iter().map(|&i| results.axes[i].clone()).chain(results.quantities.iter().cloned());
    let mut rows = vec![names.collect::<Vec<String>>()];
    for row in &results.cases {
        let values = row.values.iter().map(|value| value.map_or("NaN".into(), |v| format!("{v:e}")));
        rows.push(axes.iter().map(|&i| row.labels[i].clone()).chain(values).collect());
    }
    if rows[0].is_empty() {
        return Ok(());
    }
    let numbers = out.join("sweep_numbers.csv");
    write_csv(&numbers, &rows)?;
    ndda_io::results::Table::copy_as_parquet(&numbers, &out.join("sweep.parquet"))?;
    std::fs::remove_file(&numbers).map_err(|source| WriteError::Io {
        operation: "remove",
        path: numbers,
        source,
    })
}
