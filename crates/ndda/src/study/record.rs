//! Record of a case that has run: `case.json` in its folder.

use std::path::{Path, PathBuf};

use ndda_io::{WriteError, atomic};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::error::StudyError;
use crate::machine;
use crate::run::Sensitivity;

/// File of a record.
const RECORD: &str = "case.json";
/// Folder of a case's results, those of the last of its runs.
pub const RESULTS: &str = "run";

/// A case that has run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Name of the case.
    pub name: String,
    /// Identity of the run: scene, program and settings.
    pub identity: Identity,
    /// How it went.
    pub outcome: RunOutcome,
}

/// Identity by which two records are comparable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Identity {
    /// Fingerprint of the scene and its files.
    pub scene: String,
    /// Version and commit of the program.
    pub program: String,
    /// Ranks that take a run together.
    #[serde(default = "alone")]
    pub ranks: u16,
    /// Threads of a run, or of each rank.
    pub threads: u16,
    /// Runs.
    pub repeats: u32,
    /// Whether an accurate run was run again.
    #[serde(default = "never")]
    pub sensitivity: Sensitivity,
}

impl Identity {
    /// The identity of what this program would run now, by so many ranks with so many threads each.
    pub fn new(
        scene: String,
        (ranks, threads): (u16, u16),
        (repeats, sensitivity): (u32, Sensitivity),
    ) -> Self {
        let program = format!("{} {} [{}]", env!("CARGO_PKG_VERSION"), machine::COMMIT, machine::FEATURES);
        Self { scene, program, ranks, threads, repeats, sensitivity }
    }
}

/// Ranks of a record that was written before there were any.
fn alone() -> u16 {
    1
}

/// Sensitivity of a record that was written before it was kept: no run was repeated.
fn never() -> Sensitivity {
    Sensitivity::Never
}

/// Why a run did not reach its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Cause {
    /// The scene or a file that it names cannot be used.
    Scene,
    /// The run stopped because going on would have given a wrong number.
    Stopped,
    /// The disk, memory, a signal, a limit that was passed in a strict run.
    Other,
}

/// How a case went.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum RunOutcome {
    /// All its runs reached the end.
    Done {
        /// Wall time of each run [s].
        walls_s: Vec<f64>,
        /// Processor time of each run [s]; none where the system does not report it.
        #[serde(default)]
        processors_s: Vec<f64>,
        /// `summary.json` of the fastest.
        summary: Value,
    },
    /// A run did not reach its end.
    Failed {
        /// Kind of failure.
        cause: Cause,
        /// Why, in its own words.
        reason: String,
    },
}

impl Record {
    /// Whether the case need not run again: a scene that is wrong and a numerical stop stay what they are, a
    /// full disk or a killed process does not.
    pub fn is_final(&self) -> bool {
        match &self.outcome {
            RunOutcome::Done { .. } => true,
            RunOutcome::Failed { cause, .. } => matches!(cause, Cause::Scene | Cause::Stopped),
        }
    }

    /// Reads the record in a case's folder; none if there is none.
    ///
    /// # Errors
    /// [`StudyError::Record`] when the file is something else.
    pub fn read(folder: &Path) -> Result<Option<Self>, StudyError> {
        let file = folder.join(RECORD);
        let Ok(text) = std::fs::read_to_string(&file) else { return Ok(None) };
        let record = serde_json::from_str(&text);
        record.map(Some).map_err(|e| StudyError::Record { file, reason: e.to_string() })
    }

    /// Writes the record into a case's folder.
    ///
    /// # Errors
    /// [`WriteError`] when it cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), WriteError> {
        let path = folder.join(RECORD);
        let text = serde_json::to_string_pretty(self)
            .map_err(|e| WriteError::Encode { path: path.clone(), reason: e.to_string() })?;
        atomic::write(&path, text.as_bytes())
    }
}

/// Folder of a case.
pub fn folder(study: &Path, name: &str) -> PathBuf {
    study.join("cases").join(name)
}
