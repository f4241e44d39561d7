//! Results as whole files: JSON documents, and tables of text as CSV.

use std::path::Path;

use ndda_io::{WriteError, atomic};
use serde::Serialize;

/// Writes a document as JSON with a newline at its end; returns the text without it.
///
/// # Errors
/// [`WriteError`] when it cannot be encoded or written.
pub(crate) fn write_json(path: &Path, document: &impl Serialize) -> Result<String, WriteError> {
    let encode =
        |e: serde_json::Error| WriteError::Encode { path: path.to_path_buf(), reason: e.to_string() };
    let json = serde_json::to_string_pretty(document).map_err(encode)?;
    atomic::write(path, format!("{json}\n").as_bytes())?;
    Ok(json)
}

/// Whether a file is a document of a kind, such as `ndda.sweep`.
pub(crate) fn is_of(path: &Path, kind: &str) -> bool {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let schema = serde_json::from_str(&text)
        .ok()
        .and_then(|json: serde_json::Value| Some(json.get("schema")?.as_str()?.to_string()));
    schema.is_some_and(|schema| schema.split('/').next() == Some(kind))
}

/// Writes rows of cells as CSV.
///
/// # Errors
/// [`WriteError`] when they cannot be encoded or written.
pub(crate) fn write_csv(path: &Path, rows: &[Vec<String>]) -> Result<(), WriteError> {
    let encode = |e: csv::Error| WriteError::Encode { path: path.to_path_buf(), reason: e.to_string() };
    let mut bytes = Vec::new();
    let mut writer = csv::Writer::from_writer(&mut bytes);
    rows.iter().try_for_each(|row| writer.write_record(row)).map_err(encode)?;
    drop(writer);
    atomic::write(path, &bytes)
}
