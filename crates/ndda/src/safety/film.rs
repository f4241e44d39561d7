//! The mechanism as a run of its own, for `ndda view` and ParaView: the trial at which blocks fail, until they have gone a visible way.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use ndda_io::OutputFolder;
use ndda_io::scene::Output;

use super::free_blocks::free;
use super::trial::Trial;
use super::{SafetyError, mechanism_folder};
use crate::run::motion::radius_m;
use crate::{Model, Run, RunError};

/// How far blocks go, over the size of the smallest one.
const VISIBLE: f64 = 0.5;
/// Longest film over the trial.
const LONGEST: f64 = 50.0;
const FRAMES: u32 = 24;

/// Records a failing trial in the folder `mechanism`; a film that stops early shows what there was.
pub fn record(
    mut model: Model,
    trial: &Trial,
    out: &Path,
    stop: &Arc<AtomicBool>,
) -> Result<(), SafetyError> {
    let ([first_s, _], [last_s, gone_m]) = (trial.history[0], trial.history[trial.history.len() - 1]);
    // A trial that fails while it is brought to rest has no history of free motion.
    let trial_s =
        if last_s > first_s { last_s - first_s } else { trial.steps as f64 * model.simulation.step_s() };
    let simulation = &model.simulation;
    let sizes = free(simulation).map(|block| radius_m(&simulation.shape(block).operator));
    let visible_m = VISIBLE * sizes.fold(f64::INFINITY, f64::min);
    // A constant acceleration goes as the square of time.
    let longer = if gone_m > 0.0 { (visible_m / gone_m).sqrt().clamp(1.0, LONGEST) } else { 1.0 };
    let scene = &mut model.loaded.scene;
    scene.time.end_s = (trial_s * longer / scene.time.step_s).ceil().max(1.0) * scene.time.step_s;
    scene.settle = None;
    let file = Path::new(&model.loaded.file).to_path_buf();
    model.loaded.scene.output = Output { frames: FRAMES, ..Output::default() };
    let folder = OutputFolder::create(&mechanism_folder(out), true)?;
    match Run::new(model).record(folder, file)?.stop_when(stop.clone()).finish(&mut []) {
        Ok(_) | Err(RunError::Settling(_)) => Ok(()),
        Err(RunError::InterruptedWhileSettling) => Err(SafetyError::Interrupted),
        Err(RunError::Write(error)) => Err(error.into()),
    }
}
