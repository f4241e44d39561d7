//! The scene at rest, from which trials begin.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::Ordering;

use ndda_io::code::Code;
use ndda_io::read::LoadedScene;
use ndda_io::scene::Scene;
use ndda_mesh::Vec3;
use ndda_solver::{Settle, Settled, Simulation, StepError};

use super::free_blocks::{Moved, free, gone_m};
use super::kept::Kept;
use super::trial::Start;
use super::{SafetyError, Watch, changes};
use crate::Model;
use crate::build::Choices;
use crate::run::unless_stopped;

/// Largest factor on the strength with which the scene is brought to rest.
pub const STRONGEST: f64 = 32.0;
/// Factors on the strength with which the scene is brought to rest, until it does.
const STRENGTHS: [f64; 8] = [1.0, 1.5, 2.25, 3.375, 5.0, 8.0, 16.0, STRONGEST];
/// Tolerance of friction in trials, as a part of μN: small against the narrowest bracket.
const FRICTION_TOLERANCE: f64 = 1e-4;

/// The scene at rest, and with how many times its strength it came to rest.
///
/// Blocks that come to rest elsewhere, a toe that slides out until it lies on the ground, did not stand: the scene is brought to rest with more strength. Where that
/// holds them back little, the largest is tried at once, and only where that does not hold them either do they count as being at rest; [`Start::moved`] names them.
///
/// The state is kept in the folder of the answer, from which the next call takes it.
pub fn settled(loaded: &LoadedScene, folder: &Path, watch: &Watch) -> Result<(Start, f64), SafetyError> {
    if let Some(kept) = watch.out.and_then(|out| Kept::read(out, &loaded.scene))
        && let Some(known) = known(kept, loaded, folder, watch)?
    {
        return Ok(known);
    }
    let (start, strength) = found(loaded, folder, watch)?;
    if let Some(out) = watch.out.filter(|_| !start.still_moves) {
        Kept::write(out, &loaded.scene, &start, strength)?;
    }
    Ok((start, strength))
}

/// The state that an earlier call found; none where it is of other blocks.
fn known(
    kept: Kept,
    loaded: &LoadedScene,
    folder: &Path,
    watch: &Watch,
) -> Result<Option<(Start, f64)>, SafetyError> {
    let mut changed = loaded.clone();
    changes::weaken(&mut changed.scene, 1.0 / kept.strength);
    let softest = changes::shear_stiffness_pa_m(&mut changed.scene);
    let gravity = Vec3::from(changed.scene.gravity_m_s2);
    let mut model = Model::resuming_with(changed, folder, choices())?;
    if model.simulation.restore(kept.snapshot).is_err() {
        return Ok(None);
    }
    warn(&model, watch);
    let start = Start::new(&mut model.simulation, gravity, softest);
    let start = start.map_err(|source| SafetyError::NotSettled { strength: kept.strength, source })?;
    let is_same = start.blocks_crc32 == kept.blocks_crc32;
    Ok(is_same.then_some((Start { moved: kept.moved, ..start }, kept.strength)))
}

/// Says what nothing holds, and which water presses on nothing.
fn warn(model: &Model, watch: &Watch) {
    for warning in &model.loaded.warnings {
        match warning.code {
            Code::NotHeld => (watch.tell)(&format!("warning: {}", warning.message)),
            Code::NoEffect if warning.path.starts_with("water[") => {
                let help = warning.help.as_deref().unwrap_or_default();
                (watch.tell)(&format!("warning: {}: {}: {help}", warning.path, warning.message));
            }
            _ => {}
        }
    }
}

fn found(loaded: &LoadedScene, folder: &Path, watch: &Watch) -> Result<(Start, f64), SafetyError> {
    let (mut failed, mut elsewhere): (_, Option<(Start, f64)>) = (None, None);
    let mut is_hopeless = false;
    // Nothing times 32 is nothing.
    let has_strength = changes::has_strength(&loaded.scene);
    let strengths = if has_strength { &STRENGTHS[..] } else { &STRENGTHS[..1] };
    for &strength in strengths {
        if is_hopeless && strength < STRONGEST {
            continue;
        }
        // The last chance of a scene that has never come to rest has all the steps that it asks for.
        let is_last = (strength == STRONGEST || !has_strength) && elsewhere.is_none();
        let mut changed = loaded.clone();
        changes::weaken(&mut changed.scene, 1.0 / strength);
        let softest = changes::shear_stiffness_pa_m(&mut changed.scene);
        let settle = changed.scene.settle.unwrap_or_default();
        let gravity = Vec3::from(changed.scene.gravity_m_s2);
        let most_steps =
            if is_last { settle.most_steps } else { settle.most_steps.min(most_steps(&changed.scene)) };
        let model = Model::with(changed, folder, choices())?;
        if strength == STRENGTHS[0] {
            warn(&model, watch);
        }
        let mut simulation = model.simulation;
        if free(&simulation).next().is_none() {
            return Err(SafetyError::NothingFree);
        }
        let begun = simulation.state().position.clone();
        // How blocks accelerate that do not come to rest is judged, with their own masses.
        let mass_scaling = settle.mass_scaling == Some(true);
        let settle = Settle { most_steps, mass_scaling, ..crate::build::settle(settle) };
        let mut slide = (!is_last).then(|| Slide::new(most_steps));
        match rest(&mut simulation, &settle, watch, &mut slide) {
            Ok(Rest::Slides) => {}
            Ok(Rest::Reached) => {
                let moved = Moved::since(&simulation, &begun);
                let start = Start::new(&mut simulation, gravity, softest);
                let start = start.map_err(|source| SafetyError::NotSettled { strength, source })?;
                if moved.is_empty() {
                    return Ok((start, strength));
                }
                let is_held = |(weaker, _): &(Start, f64)| Moved::are_held_back(&moved, &weaker.moved);
                is_hopeless = !elsewhere.as_ref().is_none_or(is_held);
                if !is_hopeless {
                    elsewhere = Some((Start { moved, ..start }, strength));
                }
            }
            Ok(Rest::Interrupted) => return Err(SafetyError::Interrupted),
            Err(source) if !has_strength => return Err(SafetyError::NotHeld { source }),
            Err(source) => {
                let mut moved = Moved::since(&simulation, &begun);
                let is_hopeless = strength == STRONGEST && elsewhere.is_none();
                // Damping may hold back what slides, so that it has not gone far yet.
                if is_hopeless && moved.is_empty() && matches!(source, StepError::NotSettled { .. }) {
                    (simulation, moved) = let_go(loaded, folder, (strength, gravity), watch)?;
                }
                if is_hopeless && !moved.is_empty() {
                    let start = Start::new(&mut simulation, gravity, softest);
                    let start = start.map_err(|source| SafetyError::NotSettled { strength, source })?;
                    return Ok((Start { moved, still_moves: true, ..start }, strength));
                }
                failed = Some(SafetyError::NotSettled { strength, source });
            }
        }
    }
    elsewhere.ok_or_else(|| failed.expect("there are strengths"))
}

/// Steps in which a scene that stands comes to rest: what a block needs to fall by a hundred metres, or to oscillate two thousand times.
fn most_steps(scene: &Scene) -> u64 {
    let fall_s = 5.0;
    ((fall_s / scene.time.step_s) as u64).max(20_000)
}

/// Steps between looks at how far blocks that are let go have gone.
const LOOK: usize = 50;
/// The way in the first half of a time over all of it, up to which motion accelerates: a quarter from rest, where a block that creeps has gone half of it.
const ACCELERATES: f64 = 0.35;
/// Part by which a block may have gone farther than in free fall: its contact vibrates.
const BEYOND_FALL: f64 = 1.05;

/// The scene from where it is drawn, without damping, with so many times its strength: the blocks that go to another place as weight that nothing holds takes them. None where none does in
/// the steps in which a scene comes to rest that stands; what creeps, jumps or is thrown apart does not count.
fn let_go(
    loaded: &LoadedScene,
    folder: &Path,
    (strength, gravity): (f64, Vec3),
    watch: &Watch,
) -> Result<(Simulation, Vec<Moved>), SafetyError> {
    let mut changed = loaded.clone();
    changes::weaken(&mut changed.scene, 1.0 / strength);
    let steps = most_steps(&changed.scene);
    let mut simulation = Model::with(changed, folder, choices())?.simulation;
    let begun = simulation.state().position.clone();
    let mut ways_m = vec![0.0];
    for _ in 0..steps / LOOK as u64 {
        for _ in 0..LOOK {
            if watch.stop.load(Ordering::Relaxed) {
                return Err(SafetyError::Interrupted);
            }
            simulation.step().map_err(|source| SafetyError::NotSettled { strength, source })?;
        }
        let gone_m = gone_m(&simulation, &begun);
        ways_m.push(gone_m.iter().map(|(_, gone_m)| *gone_m).fold(0.0, f64::max));
        let moved = Moved::since(&simulation, &begun);
        if !moved.is_empty() && slides(&ways_m, gravity, LOOK as f64 * simulation.step_s()) {
            return Ok((simulation, moved));
        }
    }
    Ok((simulation, Vec::new()))
}

/// Whether these ways, from one look to the next, are those of blocks that their weight accelerates.
fn slides(ways_m: &[f64], gravity: Vec3, look_s: f64) -> bool {
    let (last, all_m) = (ways_m.len() - 1, ways_m[ways_m.len() - 1]);
    let fall_m = 0.5 * gravity.norm() * (look_s * last as f64).powi(2);
    all_m <= BEYOND_FALL * fall_m && ways_m[last / 2] <= ACCELERATES * all_m
}

/// How bringing a scene to rest ended.
enum Rest {
    /// It rests.
    Reached,
    /// Blocks slide, and would until the steps are used up.
    Slides,
    /// Somebody asked to end.
    Interrupted,
}

/// Part of the steps that a scene is given to come to rest, and how many times the steps before, in which one that oscillates comes past a peak of its energy.
const SLIDES_FOR: u64 = 8;

/// Watches for blocks that slide. What comes to rest oscillates, and its kinetic energy falls again and again; that of blocks that slide grows and grows.
struct Slide {
    least_steps: u64,
    /// Step from which on the energy has been the largest so far.
    since: u64,
}

impl Slide {
    fn new(most_steps: u64) -> Self {
        Self { least_steps: most_steps / SLIDES_FOR, since: 0 }
    }

    /// Whether blocks slide after this step: their energy has grown for an eighth of all steps, and for eight times as long as all went before.
    fn is_seen(&mut self, settled: &Settled) -> bool {
        if settled.speed_ratio < 1.0 {
            self.since = settled.steps;
        }
        settled.steps - self.since >= self.least_steps.max(SLIDES_FOR * self.since)
    }
}

/// Brings a simulation to rest, unless blocks are seen to slide.
fn rest(
    simulation: &mut Simulation,
    settle: &Settle,
    watch: &Watch,
    slide: &mut Option<Slide>,
) -> Result<Rest, StepError> {
    let mut slides = false;
    simulation.settle_watched(settle, &mut |settled| {
        slides = slide.as_mut().is_some_and(|slide| slide.is_seen(settled));
        if slides { ControlFlow::Break(()) } else { unless_stopped(watch.stop) }
    })?;
    Ok(match (slides, watch.stop.load(Ordering::Relaxed)) {
        (_, true) => Rest::Interrupted,
        (true, false) => Rest::Slides,
        (false, false) => Rest::Reached,
    })
}

/// Friction as exact as trials need it.
pub fn choices() -> Choices {
    Choices { friction_tolerance: Some(FRICTION_TOLERANCE), ..Choices::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The step in which blocks are seen to slide, where the energy falls in these steps and grows in all others.
    fn seen(most_steps: u64, falls: impl Fn(u64) -> bool) -> Option<u64> {
        let mut slide = Slide::new(most_steps);
        (1..=most_steps).find(|&steps| {
            slide.is_seen(&Settled {
                steps,
                speed_ratio: if falls(steps) { 0.5 } else { 1.0 },
                ..Settled::default()
            })
        })
    }

    #[test]
    fn blocks_slide_that_go_as_their_weight_takes_them_and_not_those_that_creep_or_are_thrown() {
        let is_slide = |way: &dyn Fn(f64) -> f64| {
            slides(&(0..=40).map(|k| way(f64::from(k))).collect::<Vec<_>>(), Vec3::z(), 1.0)
        };
        assert!(is_slide(&|t| 0.5 * t * t) && is_slide(&|t| 0.01 * t * t));
        assert!(!is_slide(&|t| 0.01 * t) && !is_slide(&|t| 0.6 * t * t) && !is_slide(&|t| 0.1 * t.sqrt()));
    }

    #[test]
    fn blocks_slide_whose_energy_grows_for_an_eighth_of_all_steps_and_eight_times_as_long_as_before() {
        assert_eq!(seen(24_000, |_| false), Some(3000));
        assert_eq!(seen(24_000, |step| step <= 100), Some(3100));
        assert_eq!(seen(24_000, |step| step <= 1000), Some(9000));
        // A pendulum comes past the peaks of its energy.
        assert_eq!(seen(24_000, |step| step % 2000 == 0), None);
    }
}
