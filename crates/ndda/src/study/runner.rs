//! Runners of a study's cases.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use ndda_io::OutputFolder;
use ndda_io::summary::Status;

use super::error::StudyError;
use super::record::Cause;
use crate::run::Sensitivity;
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
}

/// Runs cases: in this process, or in another, so that memory is measured per case and a crash ends one run, not all.
pub trait CaseRunner: Sync {
    /// Runs a case to its end with its results in a folder; a cause and a reason where it does not get there.
    ///
    /// # Errors
    /// [`StudyError`] where the study cannot go on, or somebody asks it to end.
    fn run(&self, run: &CaseRun) -> Result<Option<(Cause, String)>, StudyError>;
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
            .sensitivity(Sensitivity::Never)
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
