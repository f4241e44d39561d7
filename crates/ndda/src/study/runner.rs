//! Runners of a study's cases.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use ndda_io::scene::override_files;
use ndda_io::{OutputFolder, WriteError};

use super::error::StudyError;
use super::record::Cause;
use crate::run::Sensitivity;
use crate::summary::Status;
use crate::{Model, Run};

/// A run of a case.
pub struct CaseRun<'a> {
    /// The file of the scene.
    pub scene: &'a Path,
    /// Values that are set in it, as `path=value`.
    pub overrides: &'a [String],
    /// The folder that results go to; an older one is replaced.
    pub out: &'a Path,
    /// Threads.
    pub threads: u16,
    /// Whether it is run again, if it is accurate.
    pub sensitivity: Sensitivity,
}

/// Bytes of values that a command line holds: Windows allows 32 kB for all of it, Linux 128 kB for one word.
const MOST_BYTES: usize = 16 << 10;

impl CaseRun<'_> {
    /// The words that stand behind `--set` on the command line of a process that runs the case: its values, or, where they are too long for
    /// that, the names of files beside its results that hold them.
    ///
    /// # Errors
    /// [`WriteError`] when such a file cannot be written.
    pub fn set_words(&self) -> Result<Vec<String>, WriteError> {
        if self.overrides.iter().map(String::len).sum::<usize>() <= MOST_BYTES {
            return Ok(self.overrides.to_vec());
        }
        override_files::write(self.overrides, |number| {
            self.out.with_file_name(format!("values_{number}.txt"))
        })
    }
}

/// Runs cases: in this process, or in another, so that memory is measured per case and a crash ends one run, not all.
pub trait CaseRunner: Sync {
    /// Runs a case to its end with its results in a folder; a cause and a reason where it does not get there.
    ///
    /// # Errors
    /// [`StudyError`] where the study cannot go on, or somebody asks it to end.
    fn run(&self, run: &CaseRun) -> Result<Option<(Cause, String)>, StudyError>;

    /// Ranks that take a run together.
    fn ranks(&self) -> u16 {
        1
    }
}

/// Runs cases in this process.
#[derive(Default)]
pub struct InProcess {
    /// Raised when somebody asks the study to end.
    pub stop: Arc<AtomicBool>,
}

impl InProcess {
    fn run_here(&self, run: &CaseRun) -> Result<Option<(Cause, String)>, StudyError> {
        let model = match Model::open(run.scene, run.overrides) {
            Ok(model) => model,
            Err(errors) => return Ok(Some((Cause::Scene, errors.render(false)))),
        };
        let folder = OutputFolder::create(run.out, true)?;
        let recorded = Run::new(model)
            .sensitivity(run.sensitivity)
            .stop_when(self.stop.clone())
            .record(folder, run.scene.to_path_buf())?;
        let summary = match recorded.finish(&mut []) {
            Ok(outcome) => outcome.summary,
            Err(crate::RunError::Write(error)) => return Err(error.into()),
            Err(error) => return Ok(Some((Cause::Stopped, error.to_string()))),
        };
        match summary.status {
            Status::Stopped => Ok(Some((Cause::Stopped, summary.stopped_by.unwrap_or_default()))),
            Status::Interrupted => Err(StudyError::Interrupted),
            Status::Done | Status::Failed => Ok(None),
        }
    }
}

impl CaseRunner for InProcess {
    fn run(&self, run: &CaseRun) -> Result<Option<(Cause, String)>, StudyError> {
        if self.stop.load(Ordering::Relaxed) {
            return Err(StudyError::Interrupted);
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(run.threads.into()).build();
        let pool = pool.map_err(|error| StudyError::Start(std::io::Error::other(error)))?;
        pool.install(|| self.run_here(run))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_are_too_long_for_a_command_line_are_in_files_in_their_order() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("run");
        let monitor = |i: usize| format!("(name: \"block {i:05}\", block: \"{i:05}\", at: Centre), ");
        let monitors = format!("monitors=[{}]", (0..20_000).map(monitor).collect::<String>());
        let overrides = ["time.step_s=1", "a=(1,\n2)", "time.step_s=2", &monitors].map(String::from);
        let run = |overrides| CaseRun {
            scene: Path::new("s.ron"),
            overrides,
            out: &out,
            threads: 1,
            sensitivity: Sensitivity::Never,
        };
        assert_eq!(run(&overrides[..3]).set_words().unwrap(), overrides[..3]);
        assert!(std::fs::read_dir(folder.path()).unwrap().next().is_none());
        let words = run(&overrides).set_words().unwrap();
        assert!(words.iter().all(|word| word.len() < 1000), "{words:?}");
        let lines = |word: &str| match word.strip_prefix('@') {
            Some(file) => {
                std::fs::read_to_string(file).unwrap().lines().map(String::from).collect::<Vec<_>>()
            }
            None => vec![word.to_string()],
        };
        assert_eq!(words.iter().flat_map(|word| lines(word)).collect::<Vec<_>>(), overrides);
    }
}
