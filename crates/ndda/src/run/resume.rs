//! A run from its last checkpoint.

use std::path::{Path, PathBuf};
use std::time::Duration;

use ndda_io::diagnostic::SceneErrors;
use ndda_io::outside_files::OutsideFile;
use ndda_io::{OutputFolder, WriteError, read};
use ndda_ranks::RanksError;
use ndda_solver::Snapshot;

use super::Run;
use super::identity::Identity;
use super::outputs::SavedRun;
use super::run_log;
use super::settling::OnTheWay;
use super::twin::Sensitivity;
use crate::build::Choices;
use crate::places::{self, name_of};
use crate::summary::{Status, Summary};
use crate::{Model, model};

/// A run that goes on.
pub struct Resumed {
    /// The run.
    pub run: Run,
    /// Damage of the last checkpoint, where the one before it was taken.
    pub warnings: Vec<String>,
}

/// Why a run cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum ResumeError {
    /// The run has reached its end.
    #[error("the run in {} has reached its end: there is nothing to resume", .0.display())]
    HasEnded(PathBuf),
    /// The folder, its checkpoints or the files of its scene cannot be used.
    #[error("{0}")]
    Unusable(String),
    /// The scene cannot be built any more.
    #[error(transparent)]
    Scene(#[from] SceneErrors),
    /// The checkpoint is of another scene or program.
    #[error("the checkpoint does not fit: {0}")]
    DoesNotFit(String),
    /// The folder cannot be read or written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The ranks of the run cannot go on.
    #[error(transparent)]
    Ranks(#[from] RanksError),
}

impl ResumeError {
    /// Its message; that of a run that has ended says, too, that no second runs are made, where they are asked for.
    pub fn told(&self, asked: Option<Sensitivity>) -> String {
        match (self, asked) {
            (Self::HasEnded(_), Some(_)) => {
                format!(
                    "{self}, and `--sensitivity` repeats no run that has ended: run the scene anew with it"
                )
            }
            _ => self.to_string(),
        }
    }
}

impl Run {
    /// Goes on with the run that is recorded in a folder.
    ///
    /// # Errors
    /// [`ResumeError`].
    pub fn resume(folder: &Path) -> Result<Resumed, ResumeError> {
        Self::resume_with(folder, Choices::default())
    }

    /// Resumes a run that was begun with parts of one's own, which must be given again.
    ///
    /// # Errors
    /// [`ResumeError`].
    pub fn resume_with(folder: &Path, choices: Choices) -> Result<Resumed, ResumeError> {
        if !folder.is_dir() {
            let what = if folder.exists() { "is no folder" } else { "does not exist" };
            let message = format!("{} {what}: name the output folder of a run", folder.display());
            return Err(ResumeError::Unusable(message));
        }
        let own = OutputFolder::open(folder)?;
        if let Some(instead) = places::instead(own.path()) {
            let path = own.path().display();
            return Err(ResumeError::Unusable(format!("{path} holds no run that could go on: {instead}")));
        }
        let mut warnings = Vec::new();
        let saved = (last_checkpoint(&own, &mut warnings)?, is_judged(&own));
        warnings.extend(saved.0.identity.edited());
        let run = Self::resume_saved(saved, (folder, Some(own)), choices)?;
        Ok(Resumed { run, warnings })
    }

    /// Resumes a run from its checkpoint and whether it has been judged; it is recorded in the folder if that is given as its own.
    pub(super) fn resume_saved(
        (saved, is_judged): (SavedRun, bool),
        (folder, own): (&Path, Option<OutputFolder>),
        choices: Choices,
    ) -> Result<Self, ResumeError> {
        let beside = saved.identity.folder().to_path_buf();
        let meshes = beside.as_path();
        OutsideFile::verify_all(&saved.identity.outside, meshes)
            .map_err(|error| ResumeError::Unusable(error.to_string()))?;
        let name = saved.identity.file.display().to_string();
        let loaded = read::load_text(&name, &saved.identity.text, &[], Some(meshes))?;
        let mut run = Self::new(Model::resuming_with(loaded, meshes, choices)?);
        // Killed between its last step and its summary, a run still owes the summary; interrupted while it ran again, its label.
        let steps = run.model.steps();
        if saved.settling.is_none() && saved.snapshot.state.step >= steps && is_judged {
            return Err(ResumeError::HasEnded(folder.to_path_buf()));
        }
        let SavedRun { identity, snapshot, earlier, settling } = saved;
        if earlier.stages.at > 0 {
            let (loaded, blocks) = (&run.model.loaded, run.model.simulation.blocks().clone());
            run.model.simulation = model::in_stage(loaded, meshes, blocks, earlier.stages.at)?;
        }
        run.name = name_of(&identity.file);
        run.sensitivity = identity.sensitivity;
        run.built = Some(run.model.simulation.start_snapshot());
        let restored = run.model.simulation.restore(snapshot);
        restored.map_err(|error| ResumeError::DoesNotFit(error.to_string()))?;
        let wall_s = earlier.wall_s;
        run.on_the_way = settling.map(|settling| OnTheWay { settling, wall_s });
        // Outputs begin when the scene is at rest.
        run.earlier = Some(earlier).filter(|_| run.on_the_way.is_none());
        if run.earlier.is_none() {
            let before = Duration::from_secs_f64(wall_s);
            run.started = run.started.checked_sub(before).unwrap_or(run.started);
        }
        match own {
            Some(folder) => Ok(run.record_as(identity, folder)?),
            None => Ok(run),
        }
    }
}

impl Run {
    /// Scene and state of the last checkpoint of the run in a folder.
    ///
    /// # Errors
    /// [`ResumeError`] when there is none that can be used.
    pub(crate) fn last_checkpoint(folder: &Path) -> Result<(Identity, Snapshot), ResumeError> {
        let folder = OutputFolder::open(folder)?;
        let SavedRun { identity, snapshot, settling, .. } = last_checkpoint(&folder, &mut Vec::new())?;
        if settling.is_some() {
            let folder = folder.path().display();
            return Err(ResumeError::Unusable(format!(
                "the run in {folder} was interrupted while its scene settled: `ndda resume {folder}` goes on with it"
            )));
        }
        Ok((identity, snapshot))
    }
}

/// Whether the folder of a run has a summary of its end. One of a run that was interrupted, on its way or while it ran again after its end, is none.
pub(super) fn is_judged(folder: &OutputFolder) -> bool {
    let summary = folder.summary();
    summary.exists() && Summary::read(&summary).map_or(true, |read| read.status != Status::Interrupted)
}

/// The last checkpoint that can be read, of the scene that the log begins with.
pub(super) fn last_checkpoint(
    folder: &OutputFolder,
    warnings: &mut Vec<String>,
) -> Result<SavedRun, ResumeError> {
    let scene = run_log::scene_crc32(folder);
    let of_this_run = |saved: &SavedRun| match scene {
        Some(known) if known != saved.identity.crc32() => {
            Err(format!("of {}", saved.identity.file.display()))
        }
        _ => Ok(()),
    };
    let (saved, passed_over) =
        folder.read_checkpoint(of_this_run).map_err(|error| ResumeError::Unusable(error.to_string()))?;
    if let Some(error) = passed_over {
        warnings.push(format!("{error}; going on from the checkpoint before"));
        folder.go_back()?;
    }
    Ok(saved)
}
