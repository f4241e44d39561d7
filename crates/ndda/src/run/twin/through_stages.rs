//! The twin of a run through stages: the scene is built anew, and its blocks are pushed when it begins and at the beginning of each stage, since damping
//! takes a push away.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use ndda_io::read::LoadedScene;
use ndda_ranks::Communicator;

use super::{Ended, Failed, Twin, push, unless_ended};
use crate::Model;
use crate::run::outputs::{self, Outputs};
use crate::run::stages::Course;

/// Positions and velocities at the end of a twin; `scale_m_s` is the largest speed of its run. None if the run is asked to end before.
///
/// # Errors
/// Why the twin has no end.
pub(super) fn ended(
    (loaded, folder): (&LoadedScene, &Path),
    (twin, scale_m_s): (Twin, f64),
    ranks: Arc<dyn Communicator>,
    stop: &Arc<AtomicBool>,
) -> Result<Option<Ended>, Failed> {
    let mut loaded = loaded.clone();
    loaded.scene.output.history_rows = 1;
    if twin == Twin::HalfStep {
        loaded.scene.time.step_s *= 0.5;
    }
    let model = Model::resuming(loaded, folder).map_err(|errors| Failed::Steps(errors.render(false)))?;
    let steps = model.steps();
    let Model { loaded, mut simulation, .. } = model;
    simulation.share_steps(ranks.clone());
    if let Some(settle) = loaded.scene.settle.map(crate::build::settle) {
        let settled = simulation.settle_watched(&settle, &mut |_| unless_ended(&*ranks, stop));
        settled.map_err(Failed::from)?;
    }
    push(&mut simulation, twin, scale_m_s);
    let course = outputs::Course { steps, started: Instant::now(), stop: stop.clone(), checkpoints: false };
    let nothing = (Vec::new(), None);
    let outputs = Outputs::new((&loaded.scene, &simulation), nothing, (None, None), &mut [], course);
    let mut outputs = outputs.map_err(|error| Failed::Steps(error.to_string()))?;
    let begun = &mut |simulation: &mut _| push(simulation, twin, scale_m_s);
    let through = Course { loaded: &loaded, folder, stop, tell: &|_| {} };
    through.go(&mut simulation, &mut outputs, begun).map_err(|error| Failed::Steps(error.to_string()))?;
    let has_ended = simulation.state().step >= steps && !stop.load(Ordering::Relaxed);
    let state = simulation.state();
    Ok(has_ended.then(|| (state.position.clone(), state.velocity.clone())))
}
