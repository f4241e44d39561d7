//! `ndda check`: everything that can be wrong with a scene, without running it.

use std::fmt;
use std::path::Path;

use ndda_io::diagnostic::{Diagnostic, SceneErrors};
use ndda_io::read::{LoadedScene, load};
use ndda_solver::Simulation;
use serde::Serialize;

use crate::args::CheckArgs;
use crate::console::say;
use crate::events::{self, Events};
use crate::exit;
use crate::forecast;
use crate::guess::{self, Guess};
use crate::input;
use crate::lumped;
use crate::monitor::Monitor;
use crate::overlaps;
use crate::reference::Comparison;
use crate::rounding;
use crate::step_advice::{self, Advice};
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
    let mut ready = build(loaded, folder)?;
    // What contact cannot compute at the start stops the run with its own cause.
    match overlaps::refusal(&ready.loaded, &mut ready.simulation) {
        Ok(Some(refused)) => Err(ready.loaded.errors(vec![refused])),
        _ => Ok(ready),
    }
}

/// The same without a look at contact at the start, for a run that is past it.
///
/// # Errors
/// As [`prepare`], but for blocks that overlap.
pub fn build(mut loaded: LoadedScene, folder: &Path) -> Result<Ready, SceneErrors> {
    let located = |faults: Vec<Fault>| {
        let diagnostics: Vec<Diagnostic> =
            faults.into_iter().map(|fault| loaded.diagnose(&fault.path, fault.message)).collect();
        loaded.errors(diagnostics)
    };
    forecast::admit(&loaded, folder).map_err(|refused| loaded.errors(vec![refused]))?;
    let blocks = wiring::blocks(&loaded.scene, folder).map_err(located)?;
    let far = rounding::warning(&loaded, &blocks);
    let simulation = wiring::simulation(&loaded.scene, blocks, folder).map_err(located)?;
    let monitors = wiring::monitors(&loaded.scene, &simulation).map_err(located)?;
    loaded.warnings.extend(far);
    loaded.warnings.extend(lumped::warning(&loaded, &simulation));
    Ok(Ready { loaded, simulation, monitors })
}

/// What is found in a scene without errors.
#[derive(Serialize)]
struct Checked<'a> {
    exit_code: u8,
    scene: &'a Path,
    warnings: usize,
    blocks: usize,
    nodes: usize,
    tets: usize,
    unknowns: usize,
    factors: usize,
    steps: u64,
    advised_step_s: Option<f64>,
    contact_stability: Option<&'a Advice>,
    guess: Option<Guess>,
}

/// Runs `ndda check`; returns the exit code.
pub fn check(args: &CheckArgs) -> u8 {
    let events = Events::new(args.json, events::CHECK);
    let mut ready = match input::ready(&args.input, events) {
        Ok(ready) => ready,
        Err(code) => return code,
    };
    let loaded = &ready.loaded;
    if !loaded.warnings.is_empty() {
        events.doubt(&loaded.errors(loaded.warnings.clone()));
    }
    let advice = step_advice::advise(&loaded.scene, &mut ready.simulation);
    let guess = guess::guess(&loaded.scene, &mut ready.simulation);
    let file = input::file(&args.input);
    let stops = guess.as_ref().err().map(|error| format!("the first steps stop: {error}"));
    if let Some(stops) = &stops {
        events.warn(stops);
    }
    let (simulation, blocks) = (&ready.simulation, ready.simulation.blocks());
    let checked = Checked {
        exit_code: exit::DONE,
        scene: &file,
        warnings: loaded.warnings.len() + usize::from(stops.is_some()),
        blocks: blocks.len(),
        nodes: blocks.rest_position.len(),
        tets: blocks.tets.len(),
        unknowns: simulation.unknowns(),
        factors: simulation.factors(),
        steps: wiring::steps(&loaded.scene.time),
        advised_step_s: advice.as_ref().map(|advice| advice.step_s),
        contact_stability: advice.as_ref(),
        guess: guess.ok(),
    };
    events.emit("finished", &checked);
    if !args.json {
        say(&format!(
            "{checked}{}",
            advice.as_ref().map_or_else(String::new, |advice| format!("\n{advice}"))
        ));
    }
    checked.exit_code
}

impl fmt::Display for Checked<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { blocks, nodes, tets, unknowns, factors, steps, warnings, .. } = self;
        writeln!(f, "{}: no errors, {warnings} warning(s)", self.scene.display())?;
        write!(
            f,
            "{blocks} block(s), {nodes} nodes, {tets} tets, {unknowns} unknowns, {factors} factor(s); {steps} steps"
        )?;
        self.guess.as_ref().map_or(Ok(()), |guess| write!(f, "\n{guess}"))
    }
}
