//! The scene at rest, from which trials begin.

use std::path::Path;
use std::sync::atomic::Ordering;

use ndda_io::read::LoadedScene;
use ndda_io::scene::Scene;
use ndda_mesh::Vec3;
use ndda_solver::{Settle, Simulation, StepError};

use super::free_blocks::free;
use super::trial::Start;
use super::{SafetyError, Watch, changes};
use crate::Model;
use crate::build::Choices;
use crate::run::unless_stopped;

/// Factors on the strength with which the scene is brought to rest, until it does.
const STRENGTHS: [f64; 8] = [1.0, 1.5, 2.25, 3.375, 5.0, 8.0, 16.0, 32.0];
/// Tolerance of friction in trials, as a part of μN: small against the narrowest bracket.
const FRICTION_TOLERANCE: f64 = 1e-4;

/// The scene at rest, and with how many times its strength it came to rest.
pub fn settled(loaded: &LoadedScene, folder: &Path, watch: &Watch) -> Result<(Start, f64), SafetyError> {
    let mut failed = None;
    for strength in STRENGTHS {
        let mut changed = loaded.clone();
        changes::weaken(&mut changed.scene, 1.0 / strength);
        let softest = changes::shear_stiffness_pa_m(&mut changed.scene);
        let settle = changed.scene.settle.unwrap_or_default();
        let gravity_m_s2 = Vec3::from(changed.scene.gravity_m_s2).norm();
        let most_steps = if strength < STRENGTHS[STRENGTHS.len() - 1] {
            settle.most_steps.min(most_steps(&changed.scene))
        } else {
            settle.most_steps
        };
        let mut simulation = Model::with(changed, folder, choices())?.simulation;
        if free(&simulation).next().is_none() {
            return Err(SafetyError::NothingFree);
        }
        let settle = Settle { most_steps, ..crate::build::settle(settle) };
        match rest(&mut simulation, &settle, watch) {
            Ok(true) => {
                let start = Start::new(&mut simulation, gravity_m_s2, softest);
                let start = start.map_err(|source| SafetyError::NotSettled { strength, source })?;
                return Ok((start, strength));
            }
            Ok(false) => return Err(SafetyError::Interrupted),
            Err(source) => failed = Some(SafetyError::NotSettled { strength, source }),
        }
    }
    Err(failed.expect("there are strengths"))
}

/// Steps in which a scene that stands comes to rest: what a block needs to fall by a hundred metres, or to oscillate two thousand times.
fn most_steps(scene: &Scene) -> u64 {
    let fall_s = 5.0;
    ((fall_s / scene.time.step_s) as u64).max(20_000)
}

/// Brings a simulation to rest; false if somebody asked to end.
fn rest(simulation: &mut Simulation, settle: &Settle, watch: &Watch) -> Result<bool, StepError> {
    simulation.settle_watched(settle, &mut |_| unless_stopped(watch.stop))?;
    Ok(!watch.stop.load(Ordering::Relaxed))
}

/// Friction as exact as trials need it.
pub fn choices() -> Choices {
    Choices { friction_tolerance: Some(FRICTION_TOLERANCE), ..Choices::default() }
}
