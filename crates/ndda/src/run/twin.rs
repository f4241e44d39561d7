//! Whether a run's end may be believed although each of its steps may: runs of the same scene that differ a little, its *twins*.
//!
//! A twin that begins with other velocities, by a ten-thousandth of the largest speed, ends somewhere else, or with other velocities, where the motion is
//! sensitive: in heaps, falling columns, toppling slopes, and where a block hops on contact that is not damped. One with half the step does where the errors
//! of impacts have grown in the next ones.

mod failed;
mod parted;
mod through_stages;

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use ndda_io::read::LoadedScene;
pub use ndda_io::study::SecondRuns as Sensitivity;

use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{BodyKind, Settle, Simulation, StartSnapshot, StepError};

use super::unless_ended;
use crate::judge::words::SECOND_RUN;
use crate::summary::{Label, LabelWord, Status, Summary};
use failed::Failed;
pub(super) use parted::Parted;
use parted::{farthest_m, height_m, parted};

/// How a twin differs from its run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Twin {
    /// Its velocities at the start, by so many ten-thousandths of the largest speed.
    Push(f64),
    /// Its step, which is half as long: its errors are half of those of the run where friction acts in impacts or the scheme is of first order, a quarter
    /// elsewhere.
    HalfStep,
}

/// Velocities of a twin differ by this part of the largest speed.
const PUSH: f64 = 1e-4;
/// Pushes of the twins over [`PUSH`]. There is one such twin; where a block hops, the next one is run as long as none has parted, since a single one may end
/// near the run by chance.
const PUSHES: [Twin; 3] = [Twin::Push(1.0), Twin::Push(-1.0), Twin::Push(0.5)];
/// Without growth, a push shifts a block by its speed times the time of the run; this many times that is no growth.
const DRIFTS: f64 = 3.0;
/// So many blocks must move for their motions to disturb each other.
const ENOUGH: usize = 3;
/// So many hops of one block, with friction in between, make small differences grow.
const HOPS: f64 = 8.0;
/// Part of the largest speed that contact adds to the velocity of a block in its second largest impact, from which on half the step is tried.
const IMPACT: f64 = 0.05;

/// Part of the largest speed that contact adds to the velocity of a block in its largest impact, from which on half the step is tried where contact is damped strongly.
const DAMPED_IMPACT: f64 = 0.02;
/// What steps may leave of loads along the way of a block that nothing touches, at most: of its velocity over the largest speed, and of its place over the smallest height of its
/// tetrahedra; beyond, half the step is tried. Half of what an accurate label allows, of errors that are added up without regard to their direction.
const FREE_LOADS: (f64, f64) = (0.005, 0.05);

/// Steps times boundary triangles of a run that is short: it takes about a second.
const SHORT: u64 = 2_000_000;

/// Whether a run that begins here makes a twin, by default, if its blocks move far enough.
pub(crate) fn may_want_twin(simulation: &Simulation) -> bool {
    let free = simulation.blocks().ids().filter(|&block| moves(simulation, block));
    simulation.has_contact() && free.take(ENOUGH).count() == ENOUGH
}

/// Whether a run that begins here may make a twin with half the step, by default: always without contact, with friction or a scheme of first order if it is short, else
/// where [`may_err`] finds a reason.
pub(crate) fn may_want_half_step(simulation: &Simulation) -> bool {
    let may_move = |block| match simulation.has_contact() {
        true => moves(simulation, block),
        false => simulation.shape(block).kind != BodyKind::Fixed,
    };
    simulation.blocks().ids().any(may_move)
}

/// The twins of an accurate run that ends here, to be run one after the other until one parts.
pub(crate) fn twins(asked: Sensitivity, simulation: &Simulation) -> Vec<Twin> {
    let ids = || simulation.blocks().ids();
    let moved = || {
        ids().filter(|&block| {
            let gone_m =
                farthest_m(simulation, block, simulation.start_position(), &simulation.state().position);
            moves(simulation, block) && gone_m > 0.1 * height_m(simulation, block)
        })
    };
    let hops = hops(simulation);
    let (pushes, halves) = match asked {
        Sensitivity::Never => (false, false),
        // Without impacts small differences hardly grow; whether the step resolves loads that depend on positions, only a shorter step shows.
        _ if !simulation.has_contact() => (false, may_want_half_step(simulation)),
        Sensitivity::Always => {
            let any = ids().any(|block| moves(simulation, block));
            (any, any)
        }
        Sensitivity::Auto => {
            let moved: Vec<BlockId> = moved().take(ENOUGH).collect();
            let halves = may_err(simulation) || always_halves(simulation, simulation.state().step);
            (moved.len() == ENOUGH || lie_together(simulation, &moved) || hops, halves)
        }
    };
    let mut twins = match (pushes, hops) {
        (false, _) => Vec::new(),
        (true, false) => PUSHES[..1].to_vec(),
        (true, true) => PUSHES.to_vec(),
    };
    twins.extend(halves.then_some(Twin::HalfStep));
    twins
}

/// The line that announces repetitions of a run.
pub(crate) fn told(twins: &[Twin], simulation: &Simulation) -> String {
    let pushed = "velocities changed by 1e-4 of the largest speed";
    let by = match (twins.contains(&PUSHES[0]), twins.contains(&Twin::HalfStep)) {
        (true, true) => format!("{pushed}, then with half the step"),
        (true, false) => pushed.into(),
        (false, _) if hits_again(simulation) => "half the step, since blocks have hit several times".into(),
        (false, _) if hits_damped(simulation) => {
            "half the step, since blocks that deform have hit on contact with a restitution below 0.6".into()
        }
        (false, _) if simulation.has_contact() && free_loads(simulation) => {
            "half the step, since loads change along the way of a block that nothing touches".into()
        }
        (false, _) => "half the step".into(),
    };
    format!(
        "running the scene again with {by}, to see whether the result changes (`--sensitivity never` skips this)"
    )
}

/// How a twin takes the steps of its run again.
pub(crate) enum Again<'a> {
    /// From the start of the run, and from rest where it begins at rest.
    FromStart {
        /// The start as it was built.
        start: &'a StartSnapshot,
        /// How the run begins at rest.
        settle: Option<Settle>,
    },
    /// Through the stages of the scene, which is built anew.
    ThroughStages {
        /// The scene.
        loaded: &'a LoadedScene,
        /// Folder of the files that it names.
        folder: &'a Path,
        /// Raised when somebody asks the run to end.
        stop: &'a Arc<AtomicBool>,
    },
}

/// Positions [m] and velocities [m/s] of all nodes.
type Ended = (Vec<Vec3>, Vec<Vec3>);

/// Changes the label of an accurate run if a twin ends elsewhere, and books the time that this takes. Where somebody asks to end before the twins have ended,
/// the run is interrupted: its label is not known yet.
pub(super) fn judge(
    summary: &mut Summary,
    simulation: &mut Simulation,
    (again, twins): (&Again, &[Twin]),
    (stop, strict): (&AtomicBool, bool),
) {
    let began = Instant::now();
    match label_of_twins(simulation, again, twins, stop) {
        ControlFlow::Continue(None) => {}
        ControlFlow::Continue(Some(label)) => {
            summary.label = label;
            summary.status = if strict { Status::Failed } else { summary.status };
        }
        ControlFlow::Break(label) => (summary.label, summary.status) = (label, Status::Interrupted),
    }
    let spent_s = began.elapsed().as_secs_f64();
    summary.wall_s += spent_s;
    summary.stages_s.0.push((SECOND_RUN.into(), spent_s));
}

/// The label of an accurate run of which a twin ends elsewhere; none where all end beside it. Broken off where somebody asks to end before that is known, with
/// a label that says so.
pub(crate) fn label_of_twins(
    simulation: &mut Simulation,
    again: &Again,
    twins: &[Twin],
    stop: &AtomicBool,
) -> ControlFlow<Label, Option<Label>> {
    let contacts = simulation.replace_contacts(None);
    let parted = part(simulation, again, twins, stop);
    simulation.replace_contacts(contacts);
    let (word, reason) = match parted {
        Ok(ControlFlow::Break(())) => return ControlFlow::Break(interrupted(twins)),
        Ok(ControlFlow::Continue(None)) => return ControlFlow::Continue(None),
        Ok(ControlFlow::Continue(Some(parted))) => (parted.word(), parted.to_string()),
        Err((twin, failed)) => (failed.word(twin), failed.reason(twin)),
    };
    ControlFlow::Continue(Some(Label { word, reasons: vec![reason] }))
}

/// The label of an accurate run of which not all twins have ended.
fn interrupted(twins: &[Twin]) -> Label {
    let how = match (twins.contains(&PUSHES[0]), twins.contains(&Twin::HalfStep)) {
        (true, true) => "from a slightly different start and with half the step",
        (true, false) => "from a slightly different start",
        (false, _) => "with half the step",
    };
    let reason =
        format!("running the scene again {how} was interrupted: it is not known whether the result changes");
    Label { word: LabelWord::Inaccurate, reasons: vec![reason] }
}

/// Runs twins of a simulation that has come to its end. None where all stay together; broken off where somebody asks to end before that is known.
///
/// # Errors
/// The twin that has no end, and why.
fn part(
    simulation: &mut Simulation,
    again: &Again,
    twins: &[Twin],
    stop: &AtomicBool,
) -> Result<ControlFlow<(), Option<Parted>>, (Twin, Failed)> {
    // A twin through stages is pushed at the beginning of each.
    let pushes = match again {
        Again::FromStart { .. } => 1,
        Again::ThroughStages { loaded, .. } => 1 + loaded.scene.stages.len(),
    };
    let scale_m_s = simulation.speed_scale_m_s();
    let drift_m = match simulation.has_contact() {
        true => DRIFTS * PUSH * pushes as f64 * scale_m_s * simulation.time_s(),
        false => 0.0,
    };
    for &twin in twins {
        let ended = match again {
            Again::FromStart { start, settle } => {
                from_start(simulation, (start, settle.as_ref()), twin, stop)
                    .map_err(|error| (twin, error.into()))?
            }
            Again::ThroughStages { loaded, folder, stop } => {
                let ranks = simulation.ranks().clone();
                through_stages::ended((loaded, folder), (twin, scale_m_s), ranks, stop)
                    .map_err(|failed| (twin, failed))?
            }
        };
        let Some(ended) = ended else { return Ok(ControlFlow::Break(())) };
        let parted = parted(simulation, twin, &ended, drift_m);
        if parted.is_some() {
            return Ok(ControlFlow::Continue(parted));
        }
    }
    Ok(ControlFlow::Continue(None))
}

/// End of a twin from the start of its run, which is at its end before and after; none where somebody asks to end.
///
/// # Errors
/// [`StepError`] that stops the twin.
fn from_start(
    simulation: &mut Simulation,
    start: (&StartSnapshot, Option<&Settle>),
    twin: Twin,
    stop: &AtomicBool,
) -> Result<Option<Ended>, StepError> {
    let (end, step_s) = (simulation.snapshot(), simulation.step_s());
    let outcome = run(simulation, start, (twin, end.state.step), stop);
    let ended = (simulation.state().position.clone(), simulation.state().velocity.clone());
    if simulation.step_s() != step_s {
        simulation.change_step(step_s)?;
    }
    simulation.restore(end).expect("it is of this simulation");
    Ok(outcome?.then_some(ended))
}

/// Whether the twin of a run of so many steps came to its end.
fn run(
    simulation: &mut Simulation,
    (start, settle): (&StartSnapshot, Option<&Settle>),
    (twin, steps): (Twin, u64),
    stop: &AtomicBool,
) -> Result<bool, StepError> {
    let (scale_m_s, whole) = (simulation.speed_scale_m_s(), simulation.whole(start));
    let mut steps_of_twin = steps;
    if twin == Twin::HalfStep {
        steps_of_twin = 2 * steps;
        simulation.change_step(0.5 * simulation.step_s())?;
    }
    simulation.restore(whole).expect("it is of this simulation");
    let ranks = simulation.ranks().clone();
    if let Some(settle) = settle {
        simulation.settle_watched(settle, &mut |_| unless_ended(&*ranks, stop))?;
    }
    push(simulation, twin, scale_m_s);
    while simulation.state().step < steps_of_twin {
        if unless_ended(&*ranks, stop) == ControlFlow::Break(()) {
            return Ok(false);
        }
        simulation.step()?;
    }
    Ok(true)
}

/// Gives free blocks the velocities by which a twin differs, where it does.
pub(super) fn push(simulation: &mut Simulation, twin: Twin, scale_m_s: f64) {
    let Twin::Push(times) = twin else { return };
    let mut velocity = vec![Vec3::zeros(); simulation.state().velocity.len()];
    for block in simulation.blocks().ids().filter(|&block| moves(simulation, block)) {
        velocity[simulation.blocks().nodes_of(block)].fill(times * PUSH * scale_m_s * direction(block));
    }
    simulation.push(&velocity);
}

/// Whether a block has hopped many times with friction in between that could stop it.
fn hops(simulation: &Simulation) -> bool {
    simulation.invariants().hops_with_friction.value >= HOPS
}

/// Whether two blocks that have moved are beside each other at the end, by their boxes: they may have disturbed each other all the way.
fn lie_together(simulation: &Simulation, moved: &[BlockId]) -> bool {
    let bounds =
        |block: &BlockId| Aabb::around(&simulation.state().position[simulation.blocks().nodes_of(*block)]);
    let [one, other] = moved else { return false };
    bounds(one).touches(&bounds(other))
}

/// Whether so many steps of a scene are repeated with half the step whatever its blocks do: without contact, and, where that does not take long, with friction or a
/// scheme of first order. Other collisions are judged by their energy.
pub(crate) fn always_halves(simulation: &Simulation, steps: u64) -> bool {
    let is_short = steps.saturating_mul(simulation.blocks().triangles.len() as u64) <= SHORT;
    let may_err = simulation.has_friction() || !simulation.is_of_second_order();
    (is_short && may_err || !simulation.has_contact()) && may_want_half_step(simulation)
}

/// Whether a block has hit several times.
pub(crate) fn hits_again(simulation: &Simulation) -> bool {
    simulation.invariants().second_impact.value >= IMPACT
}

/// Whether a run may be off though each of its steps passes: a block has hit several times, or on strongly damped contact, or its loads have changed along its way.
fn may_err(simulation: &Simulation) -> bool {
    hits_again(simulation) || hits_damped(simulation) || free_loads(simulation)
}

/// Whether a block has hit where contact is damped strongly and blocks deform.
pub(crate) fn hits_damped(simulation: &Simulation) -> bool {
    simulation.damps_strongly() && simulation.invariants().impact.value >= DAMPED_IMPACT
}

/// Whether loads have changed along the way of a block that nothing touches by more than steps resolve for sure.
fn free_loads(simulation: &Simulation) -> bool {
    let worst = simulation.invariants();
    worst.free_speed.value > FREE_LOADS.0 || worst.free_place.value > FREE_LOADS.1
}

/// Whether loads have changed along the way of a block by more than steps resolve for sure, if nothing touches it.
fn has_free_loads(simulation: &Simulation, block: BlockId) -> bool {
    let (speed, place) = simulation.free_load_errors(block);
    speed > FREE_LOADS.0 || place > FREE_LOADS.1
}

/// Whether a block moves as forces ask.
fn moves(simulation: &Simulation, block: BlockId) -> bool {
    let shape = simulation.shape(block);
    shape.kind != BodyKind::Fixed && shape.is_free()
}

/// A direction for each block, spread over the sphere by the golden angle (Fibonacci's lattice).
fn direction(block: BlockId) -> Vec3 {
    let turns = 0.618_033_988_749_894_9 * (block.index() + 1) as f64;
    let z = 2.0 * (0.754_877_666_246_692_7 * (block.index() + 1) as f64).fract() - 1.0;
    let (sin, cos) = (std::f64::consts::TAU * turns.fract()).sin_cos();
    let r = (1.0 - z * z).sqrt();
    Vec3::new(r * cos, r * sin, z)
}

#[cfg(test)]
mod tests;
