//! `ndda check`: everything that can be wrong with a scene, without running it.

use std::path::Path;

use ndda_io::diagnostic::{Diagnostic, SceneErrors};
use ndda_io::read::{LoadedScene, load};
use ndda_solver::Simulation;

use crate::args::CheckArgs;
use crate::console::{colour, complain, say};
use crate::exit;
use crate::input;
use crate::monitor::Monitor;
use crate::reference::Comparison;
use crate::step_advice;
use crate::wiring::{self, Fault};

/// A scene that is ready to run.
pub struct Ready {
    /// The scene and its text.
    pub loaded: LoadedScene,
    /// The simulation at its start.
    pub simulation: Simulation,
    /// Its monitors.
    pub monitors: Vec<Monitor>,
}

/// Reads, checks and builds a scene.
///
/// # Errors
/// All that is wrong with it, as far as the earlier errors let one see.
pub fn prepare(path: &Path, overrides: &[String]) -> Result<Ready, SceneErrors> {
    prepare_loaded(load(path, overrides)?, path.parent().unwrap_or(Path::new(".")))
}

impl Ready {
    /// The scene's closed form, bound to the blocks as they are.
    pub fn comparison(&self) -> Option<Comparison> {
        Comparison::new(&self.loaded.scene, &self.simulation, &self.monitors)
    }
}

/// A scene that is read, ready to run; its meshes are in `folder`.
///
/// # Errors
/// As [`prepare`].
pub fn prepare_loaded(loaded: LoadedScene, folder: &Path) -> Result<Ready, SceneErrors> {
    let located = |faults: Vec<Fault>| {
        let diagnostics: Vec<Diagnostic> =
            faults.into_iter().map(|fault| loaded.diagnose(&fault.path, fault.message)).collect();
        loaded.errors(diagnostics)
    };
    let blocks = wiring::blocks(&loaded.scene, folder).map_err(located)?;
    let simulation = wiring::simulation(&loaded.scene, blocks, folder).map_err(located)?;
    let monitors = wiring::monitors(&loaded.scene, &simulation).map_err(located)?;
    Ok(Ready { loaded, simulation, monitors })
}

/// Runs `ndda check`; returns the exit code.
pub fn check(args: &CheckArgs) -> u8 {
    let ready = match input::ready(&args.input) {
        Ok(ready) => ready,
        Err(code) => return code,
    };
    if !ready.loaded.warnings.is_empty() {
        complain(&ready.loaded.errors(ready.loaded.warnings.clone()).render(colour()));
    }
    let (scene, simulation) = (&ready.loaded.scene, &ready.simulation);
    let blocks = simulation.blocks();
    say(&format!(
        "{}: no errors, {} warning(s)\n{} block(s), {} nodes, {} tets, {} unknowns, {} factor(s); {} steps",
        ready.loaded.file,
        ready.loaded.warnings.len(),
        blocks.len(),
        blocks.rest_position.len(),
        blocks.tets.len(),
        simulation.unknowns(),
        simulation.factors(),
        wiring::steps(&scene.time),
    ));
    if let Some(advice) = step_advice::advise(scene, simulation) {
        say(&advice.to_string());
    }
    exit::DONE
}
