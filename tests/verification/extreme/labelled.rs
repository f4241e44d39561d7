//! Runs of the program as a user sees them: exit code, summary, and whether its label agrees with the truth.

use std::path::{Path, PathBuf};

use ndda::{Model, Run};
use ndda_io::OutputFolder;
use serde_json::Value;

/// Errors that accurate runs are held to here: speeds to 1 %, places to a tenth of a tetrahedron's height, half of what is promised.
pub const SPEED: f64 = 0.01;
pub const PLACE: f64 = 0.1;

/// A file of `scenes/`.
pub fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)
}

/// Runs a scene of `scenes/`; returns the summary that it writes, or why it writes none.
pub fn summary_of(name: &str, overrides: &[String]) -> Result<Value, String> {
    let out = tempfile::tempdir().unwrap();
    let overrides: Vec<String> = overrides.iter().cloned().chain(["output.frames=0".into()]).collect();
    let model = Model::open(&scene(name), &overrides).map_err(|errors| errors.render(false))?;
    let folder = OutputFolder::create(&out.path().join("run"), false).unwrap();
    let run = Run::new(model).record(folder, scene(name)).unwrap();
    run.finish(&mut []).map_err(|error| error.to_string())?;
    let text = std::fs::read_to_string(out.path().join("run/summary.json")).unwrap();
    Ok(serde_json::from_str(&text).unwrap())
}

/// The word of a run's label.
pub fn word(summary: &Value) -> &str {
    summary["label"]["word"].as_str().unwrap()
}

/// Whether a collision is within what `accurate` promises, by its closed form.
pub fn is_true(summary: &Value) -> bool {
    let error = |key: &str| summary["reference"][key].as_f64();
    error("error_end").unwrap() <= SPEED && error("place_end").is_some_and(|place| place <= PLACE)
}

/// Whether a run's label says what is true of it; a run that stopped says nothing.
pub fn agrees(summary: &Value) -> bool {
    word(summary) == "stopped" || is_true(summary) == (word(summary) == "accurate")
}
