//! A driver in a file, to go on from on another day.

use std::path::Path;

use ndda_io::checkpoint::{self, CheckpointError};
use ndda_io::diagnostic::SceneErrors;
use ndda_io::outside_files::{OutsideFile, OutsideFileError};
use ndda_io::{WriteError, read};
use ndda_solver::{RestoreError, Snapshot, StepError};
use serde::{Deserialize, Serialize};

use super::snapshot::other_parts;
use super::{Disturbed, Driver, Parts, choices};
use crate::Model;
use crate::run::{Identity, ResumeError, Run};

/// What a file holds, its kind first.
#[derive(Serialize, Deserialize)]
struct Saved<S = Snapshot> {
    kind: String,
    origin: String,
    identity: Identity,
    snapshot: S,
    /// What other than steps has changed it since the start.
    disturbed: Option<Disturbed>,
    /// Parts that the scene does not name, in words.
    own: Option<String>,
}

const KIND: &str = "ndda.driver/5";

/// Why a driver cannot be saved.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// Its state is not to be used.
    #[error("the simulation has stopped ({0}): restore a snapshot first")]
    Stopped(StepError),
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// Why a saved driver cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The file is damaged or of another version.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// The file is not there, or holds something else.
    #[error("{0} holds no saved simulation: name a file that `save` wrote, or the output folder of a run")]
    NotSaved(String),
    /// It was saved with parts that are not in the file.
    #[error(
        "{file} was saved with {own}, which is not in the file, and is resumed with {here}: resume with it, in Python `ndda.resume(file, law=…)`"
    )]
    Own {
        /// The file.
        file: String,
        /// The parts.
        own: String,
        /// The parts that it is resumed with.
        here: String,
    },
    /// Files that the scene names have changed.
    #[error(transparent)]
    Outside(#[from] OutsideFileError),
    /// The scene cannot be built any more.
    #[error("{}", .0.render(false))]
    Scene(#[from] SceneErrors),
    /// The state is of another scene.
    #[error(transparent)]
    OtherProblem(#[from] RestoreError),
    /// The run in the folder cannot be used.
    #[error(transparent)]
    Run(#[from] ResumeError),
}

impl Driver {
    /// Writes scene and state to a file, whole or not at all.
    ///
    /// # Errors
    /// [`SaveError`].
    pub fn save(&self, file: &Path) -> Result<(), SaveError> {
        if let Some(stop) = &self.stopped {
            return Err(SaveError::Stopped(stop.clone()));
        }
        let loaded = &self.model.loaded;
        let folder = std::path::absolute(&self.model.folder).unwrap_or_else(|_| self.model.folder.clone());
        let name = Path::new(&loaded.file).file_name().unwrap_or("scene.ron".as_ref()).to_owned();
        let stem = Path::new(&name).file_stem().unwrap_or(&name).to_string_lossy().into_owned();
        let identity = Identity::new(stem, loaded.text.clone(), folder.join(name), &loaded.scene);
        let snapshot = self.model.simulation.snapshot_view();
        let (kind, origin) = (KIND.into(), self.origin.to_string());
        let (disturbed, own) = (self.course.disturbed, self.own.clone());
        let saved = Saved { kind, origin, identity, snapshot, disturbed, own };
        Ok(checkpoint::write_file(file, &saved)?)
    }

    /// Goes on, bit for bit, from a file that [`save`](Self::save) wrote, or from the last checkpoint of a run in a folder.
    ///
    /// # Errors
    /// [`LoadError`].
    pub fn load(path: &Path, parts: Option<Parts>) -> Result<Self, LoadError> {
        let (origin, identity, snapshot, disturbed) = if path.is_dir() {
            let (identity, snapshot) = Run::last_checkpoint(path)?;
            (identity.text.clone(), identity, snapshot, None)
        } else {
            let not_saved = || LoadError::NotSaved(path.display().to_string());
            let saved: Saved = match checkpoint::read_file(path) {
                Ok(saved) => saved.ok_or_else(not_saved)?,
                // Another content under a right checksum.
                Err(CheckpointError::Damaged { what, .. }) if !what.contains("checksum") => {
                    return Err(not_saved());
                }
                Err(error) => return Err(error.into()),
            };
            if saved.kind != KIND {
                return Err(not_saved());
            }
            let present = choices(parts.as_ref()).own();
            if let Some((own, here)) = other_parts(saved.own.as_deref(), present.as_deref()) {
                return Err(LoadError::Own { file: path.display().to_string(), own, here });
            }
            (saved.origin, saved.identity, saved.snapshot, saved.disturbed)
        };
        let folder = identity.folder();
        OutsideFile::verify_all(&identity.outside, folder)?;
        let file = identity.file.display().to_string();
        let loaded = read::load_text(&file, &identity.text, &[], Some(folder))?;
        if !loaded.scene.stages.is_empty() {
            let path = path.display();
            let stages = format!(
                "the scene of {path} has stages, through which a run goes on as a whole: `ndda resume {path}`"
            );
            return Err(ResumeError::Unusable(stages).into());
        }
        let mut model = Model::resuming_with(loaded, folder, choices(parts.as_ref()))?;
        let built = model.simulation.start_snapshot();
        model.simulation.restore(snapshot)?;
        Ok(Self::around(model, (origin.into(), built, disturbed), parts))
    }
}
