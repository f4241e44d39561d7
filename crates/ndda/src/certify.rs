//! Every result of a scene with an error bar, from runs with steps that halve.

mod bars;
pub mod certificate;
pub mod chaos;
pub mod error;
pub mod extrapolate;
pub mod plan;
pub mod quantities;
pub mod report;
pub mod runs;

use std::path::PathBuf;

use ndda_io::study::LoadedStudy;

use crate::forecast::held;
use crate::study::launch::Launch;
use crate::study::make_folder;
use crate::study::runner::CaseRunner;
use crate::{Model, choose, places};
use error::CertifyError;
use plan::Plan;

/// A scene that is run over and over, and where its runs go.
pub struct Trial {
    /// The scene as runs are launched with it.
    pub loaded: LoadedStudy,
    /// Its name: the file without its ending.
    pub name: String,
    /// Settings that its runs share.
    pub plan: Plan,
    /// The output folder.
    pub out: PathBuf,
}

impl Trial {
    /// A scene in `file` that is run in `out`, which is made; `steps` is the number of steps of its longest step.
    ///
    /// # Errors
    /// [`CertifyError`] when nothing moves, or the folder cannot be made.
    pub fn new(
        model: &Model,
        (file, text): (PathBuf, String),
        overrides: &[String],
        out: PathBuf,
        steps: u64,
    ) -> Result<Self, CertifyError> {
        if !held::something_moves(&model.loaded.scene, model.simulation.blocks()) {
            return Err(CertifyError::NothingMoves);
        }
        make_folder(&out)?;
        // All runs have what was chosen for the scene as it is.
        let overrides = [choose::as_overrides(&model.loaded.chosen), overrides.to_vec()].concat();
        let plan = Plan::new(&model.loaded.scene, &model.simulation, &overrides, steps);
        let name = places::name_of(&file);
        Ok(Self { loaded: LoadedStudy::of_scene(file, text), name, plan, out })
    }

    /// The launcher of its runs, `jobs` at a time on so many threads each.
    pub fn launch<'a>(
        &'a self,
        runner: &'a dyn CaseRunner,
        say: &'a (dyn Fn(&str) + Sync),
        (jobs, threads): (u16, u16),
    ) -> Launch<'a> {
        Launch { loaded: &self.loaded, out: &self.out, jobs, threads, runner, say }
    }
}
