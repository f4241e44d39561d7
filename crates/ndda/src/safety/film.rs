//! The mechanism as a run of its own, for `ndda view` and ParaView: the trial at which blocks fail, until they have gone a visible way.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use ndda_io::OutputFolder;
use ndda_io::scene::Output;
use ndda_solver::Simulation;

use super::free_blocks::{free, gone_m};
use super::trial::Trial;
use super::{SafetyError, mechanism_folder};
use crate::run::Sensitivity;
use crate::run::motion::radius_m;
use crate::{Model, Run, RunError};

/// How far blocks go, over the size of the smallest one.
const VISIBLE: f64 = 0.5;
/// Longest film over the trial, its most steps, and its most steps times free blocks: of many blocks it would take longer than all trials.
const LONGEST: u64 = 50;
const MOST_STEPS: u64 = 200_000;
const MOST_OF_ALL_BLOCKS: u64 = 1_000_000;
const FRAMES: u32 = 24;

/// Records a failing trial in the folder `mechanism`; a film that stops early shows what there was.
pub fn record(
    mut model: Model,
    trial: &Trial,
    out: &Path,
    stop: &Arc<AtomicBool>,
) -> Result<(), SafetyError> {
    push(&mut model, trial);
    let blocks = free(&model.simulation).count().max(1) as u64;
    let most_steps = (trial.steps.max(1) * LONGEST).min(MOST_STEPS).min(MOST_OF_ALL_BLOCKS / blocks).max(1);
    let steps = match is_short(&model, trial, most_steps) {
        true => most_steps,
        false => visible_after(&mut model, most_steps, stop).ok_or(SafetyError::Interrupted)?,
    };
    let scene = &mut model.loaded.scene;
    scene.time.end_s = steps as f64 * scene.time.step_s;
    scene.settle = None;
    let file = Path::new(&model.loaded.file).to_path_buf();
    model.loaded.scene.output = Output { frames: FRAMES, ..Output::default() };
    let folder = OutputFolder::create(&mechanism_folder(out), true)?;
    let run = Run::new(model).sensitivity(Sensitivity::Never).record(folder, file)?;
    match run.stop_when(stop.clone()).finish(&mut []) {
        Ok(_) | Err(RunError::Settling(_)) => Ok(()),
        Err(RunError::InterruptedWhileSettling) => Err(SafetyError::Interrupted),
        Err(RunError::Write(error)) => Err(error.into()),
    }
}

/// Whether blocks that go on as at the end of the trial go far less than a visible way in so many steps.
fn is_short(model: &Model, trial: &Trial, steps: u64) -> bool {
    let [.., [from_s, from_m], [to_s, to_m]] = trial.history[..] else { return false };
    let (speed_m_s, time_s) = ((to_m - from_m) / (to_s - from_s), steps as f64 * model.simulation.step_s());
    // From rest to this speed in the time of the trial.
    let way_m = speed_m_s * time_s * (1.0 + 0.5 * time_s / to_s);
    way_m < 0.25 * visible_m(&model.simulation)
}

/// Starts the blocks with the velocities at which the trial ended: some hardly fail by themselves.
fn push(model: &mut Model, trial: &Trial) {
    let simulation = &mut model.simulation;
    let blocks: Vec<_> = free(simulation).collect();
    for block in blocks {
        let name = &simulation.blocks().names[block.index()];
        if let Some(velocity) = trial.velocities.iter().find(|velocity| velocity.block == *name) {
            let (v, spin) = (velocity.velocity_m_s.into(), velocity.spin_rad_s.into());
            // Blocks that are held somewhere start at rest.
            let _ = simulation.set_velocity(block, v, spin);
        }
    }
}

/// A way that is seen [m].
fn visible_m(simulation: &Simulation) -> f64 {
    let sizes = free(simulation).map(|block| radius_m(&simulation.shape(block).operator));
    VISIBLE * sizes.fold(f64::INFINITY, f64::min)
}

/// Steps after which a block has gone a visible way from the state of the model, at most so many; none if somebody asked to end.
fn visible_after(model: &mut Model, most_steps: u64, stop: &AtomicBool) -> Option<u64> {
    let simulation = &mut model.simulation;
    let visible_m = visible_m(simulation);
    let (begun, start) = (simulation.snapshot(), simulation.state().position.clone());
    let mut steps = 0;
    while steps < most_steps {
        if stop.load(Ordering::Relaxed) {
            return None;
        }
        // The film shows a step that fails, too, with its reason.
        let failed = simulation.step().is_err();
        steps += 1;
        if failed || gone_m(simulation, &start).iter().any(|(_, gone_m)| *gone_m >= visible_m) {
            break;
        }
    }
    simulation.restore(begun).expect("the blocks are the same");
    Some(steps)
}
