//! A scene that is ready to run.

use std::path::{Path, PathBuf};

use ndda_io::diagnostic::{Diagnostic, SceneErrors};
use ndda_io::read::{self, LoadedScene};
use ndda_mesh::BlockSet;
use ndda_solver::Simulation;

use crate::build::{self, Choices, Fault, RockReport, overlaps};
use crate::choose;
use crate::forecast::{admit, creep, dry, gaps, held, lumped, rounding, slivers};
use crate::judge::reference::Comparison;
use crate::run::monitor::Monitor;

/// A scene, its simulation at the start, and its monitors.
pub struct Model {
    /// The scene and its text.
    pub loaded: LoadedScene,
    /// The simulation at its start.
    pub simulation: Simulation,
    /// Its monitors.
    pub monitors: Vec<Monitor>,
    /// What its rock was cut into.
    pub rock: Vec<RockReport>,
    /// Where the files are that the scene names.
    pub folder: PathBuf,
}

impl Model {
    /// Reads, checks and builds the scene in a file; `overrides` are `path=value` as `ndda run --set` takes them.
    ///
    /// # Errors
    /// All that is wrong with it, as far as the earlier errors let one see.
    pub fn open(file: &Path, overrides: &[String]) -> Result<Self, SceneErrors> {
        Self::new(read::load(file, overrides)?, file.parent().unwrap_or(Path::new(".")))
    }

    /// Checks and builds the scene in a text; files that it names are in the present folder.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn from_text(text: &str) -> Result<Self, SceneErrors> {
        let folder = Path::new(".");
        Self::new(read::load_text("scene.ron", text, &[], Some(folder))?, folder)
    }

    /// Builds a scene that has been read and checked; files that it names are in `folder`.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn new(loaded: LoadedScene, folder: &Path) -> Result<Self, SceneErrors> {
        Self::with(loaded, folder, Choices::default())
    }

    /// Opens a scene with parts of one's own in the place of what the scene names.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn with(loaded: LoadedScene, folder: &Path, choices: Choices) -> Result<Self, SceneErrors> {
        let mut model = Self::resuming_with(loaded, folder, choices)?;
        // Contact that cannot be computed at the start stops the run with its own cause.
        match overlaps::refusal(&model.loaded, &mut model.simulation) {
            Ok(Some(refused)) => Err(model.loaded.errors(vec![refused])),
            _ => {
                model.loaded.warnings.extend(overlaps::warning(&model.loaded, &model.simulation));
                Ok(model)
            }
        }
    }

    /// As [`new`](Self::new), without a look at contact at the start: for a run that is past it.
    ///
    /// # Errors
    /// As [`open`](Self::open), but for blocks that overlap.
    pub fn resuming(loaded: LoadedScene, folder: &Path) -> Result<Self, SceneErrors> {
        Self::resuming_with(loaded, folder, Choices::default())
    }

    /// Resumes a run with parts of one's own.
    ///
    /// # Errors
    /// As [`resuming`](Self::resuming).
    pub fn resuming_with(loaded: LoadedScene, folder: &Path, choices: Choices) -> Result<Self, SceneErrors> {
        let (mut loaded, cut) = choose::complete_on_blocks(loaded, folder)?;
        let located = |faults: Vec<Fault>| {
            let diagnostics: Vec<Diagnostic> =
                faults.into_iter().map(|fault| loaded.diagnose(&fault.path, fault.message)).collect();
            loaded.errors(diagnostics)
        };
        let (blocks, rock) = match cut {
            Some(cut) => cut,
            None => {
                admit::admit(&loaded, folder).map_err(|refused| loaded.errors(vec![refused]))?;
                build::blocks_and_rock(&loaded.scene, folder).map_err(located)?
            }
        };
        let far = rounding::warning(&loaded, &blocks);
        build::stages::refuse(&loaded.scene, &blocks, folder).map_err(located)?;
        let simulation = build::stages::simulation_in_stage(&loaded.scene, blocks, folder, choices, 0);
        let simulation = simulation.map_err(located)?;
        let monitors = build::monitors(&loaded.scene, &simulation).map_err(located)?;
        loaded.warnings.extend(far);
        loaded.warnings.extend(held::warnings(&loaded, simulation.blocks()));
        loaded.warnings.extend(dry::warnings(&loaded, &simulation));
        loaded.warnings.extend(slivers::warnings(&loaded, &rock));
        loaded.warnings.extend(gaps::warnings(&loaded, &rock));
        loaded.warnings.extend(lumped::warning(&loaded, &simulation));
        loaded.warnings.extend(creep::warning(&loaded));
        Ok(Self { loaded, simulation, monitors, rock, folder: folder.to_path_buf() })
    }

    /// The scene's closed form, bound to the blocks as they are now.
    pub fn comparison(&self) -> Option<Comparison> {
        Comparison::new(&self.loaded.scene, &self.simulation, &self.monitors)
    }

    /// Steps of the run.
    pub fn steps(&self) -> u64 {
        build::all_steps(&self.loaded.scene)
    }
}

/// The simulation of a scene as it is in a stage, counted from 1, on its blocks; nothing has moved in it yet.
///
/// # Errors
/// What cannot be built.
pub(crate) fn in_stage(
    loaded: &LoadedScene,
    folder: &Path,
    blocks: BlockSet,
    stage: usize,
) -> Result<Simulation, SceneErrors> {
    let built = build::stages::simulation_in_stage(&loaded.scene, blocks, folder, Choices::default(), stage);
    built.map_err(|faults| {
        let diagnose = |fault: Fault| loaded.diagnose(&fault.path, fault.message);
        loaded.errors(faults.into_iter().map(diagnose).collect())
    })
}
