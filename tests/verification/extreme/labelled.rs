//! Runs of the program as a user sees them: exit code, summary, and whether its label agrees with the truth.

use std::path::{Path, PathBuf};

use ndda_cli::args::{HowArgs, RunArgs, SceneArgs};
use ndda_cli::run;
use serde_json::Value;

/// What an accurate run promises: speeds to 1 %, places to a tenth of a tetrahedron's height.
pub const SPEED: f64 = 0.01;
pub const PLACE: f64 = 0.1;

/// A file of `scenes/`.
pub fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)
}

/// Runs a scene of `scenes/`; returns the exit code and, if it came to that, its summary.
pub fn summary_of(name: &str, overrides: &[String]) -> (u8, Option<Value>) {
    let out = tempfile::tempdir().unwrap();
    let args = RunArgs {
        out: Some(out.path().join("run")),
        force: false,
        input: SceneArgs {
            scene: Some(scene(name)),
            overrides: overrides.iter().cloned().chain(["output.frames=0".into()]).collect(),
            ..SceneArgs::default()
        },
        how: HowArgs { quiet: true, ..HowArgs::default() },
    };
    let code = run::run(&args);
    let text = std::fs::read_to_string(out.path().join("run/summary.json")).ok();
    (code, text.map(|text| serde_json::from_str(&text).unwrap()))
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
