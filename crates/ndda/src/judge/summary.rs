//! The summary of a run.

use ndda_fem::stress::volume_m3;
use ndda_io::read::Chosen;
use ndda_io::scene::{Integrator, Scene};
use ndda_mesh::Vec3;
use ndda_solver::{BoltStatus, Simulation, StepCounts};

use crate::forecast::doubts;
use crate::judge::reference;
use crate::judge::verdict;
use crate::lean;
use crate::machine;
use crate::numbers::two_figures_down;
use crate::rocking::{self, Rocking};
use crate::run::motion::moved_while_settling;
use crate::run::recorder::Recorder;
use crate::summary::{
    BlockEnd, BoltEnd, Counts, Invariants, Judgement, LabelWord, MonitorEnd, Named, ReferenceError, Status,
    Summary, Verdict,
};
use crate::waves::Finding;

/// Input of the summary besides the simulation.
pub struct Ending<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its name: the file without its ending.
    pub name: &'a str,
    /// Values that were chosen for it.
    pub chosen: Vec<Chosen>,
    /// Why the run stopped early.
    pub stopped_by: Option<String>,
    /// Whether it ended before its end because somebody asked it to.
    pub interrupted: bool,
    /// Wall time [s].
    pub wall_s: f64,
    /// Threads.
    pub threads: usize,
    /// Seconds per stage outside the step.
    pub stages: Vec<(String, f64)>,
    /// Warnings found before the run.
    pub warnings: Vec<String>,
    /// Whether a limit that is passed fails the run.
    pub strict: bool,
    /// Fingerprint of the final state.
    pub state_crc32: u32,
}

/// The summary of a run.
pub fn summarise(simulation: &Simulation, recorder: &Recorder, ending: Ending) -> Summary {
    let worst = simulation.invariants();
    let mut verdicts = verdict::verdicts(simulation);
    if ending.stopped_by.is_some() {
        // A run that stops between two samples has no energy at its end; the label says why it stopped.
        verdicts.0.retain(|(name, _)| name != verdict::UNMEASURED);
    }
    let mut label = verdict::label(simulation, ending.stopped_by.as_deref());
    if label.word != LabelWord::Stopped {
        for found in at_the_start(ending.scene, simulation) {
            let verdict =
                Verdict { value: Some(found.value), limit: Some(found.limit), verdict: Judgement::Warn };
            verdicts.0.push((found.what.into(), verdict));
            label.word = LabelWord::Inaccurate;
            label.reasons.push(found.reason);
        }
    }
    let beyond = verdicts.0.iter().any(|(_, v)| v.verdict == Judgement::Fail);
    let failed = ending.strict && (beyond || label.word == LabelWord::Inaccurate);
    let status = match (&ending.stopped_by, failed) {
        (Some(_), _) => Status::Stopped,
        (None, _) if ending.interrupted => Status::Interrupted,
        (None, true) => Status::Failed,
        (None, false) => Status::Done,
    };
    let mut warnings = ending.warnings;
    warnings.extend(advice(simulation, ending.scene));
    let settles = ending.scene.settle.is_some() && ending.scene.stages.is_empty();
    let settled = settles.then(|| moved_while_settling(simulation)).flatten();
    warnings.extend(settled.clone());
    Summary {
        version: env!("CARGO_PKG_VERSION").into(),
        scene: ending.name.into(),
        title: ending.scene.title.clone(),
        status,
        stopped_by: ending.stopped_by,
        label,
        slow_error_m_s: verdict::slow_error_m_s(simulation),
        steps: simulation.state().step,
        unsettled_steps: None,
        step_s: simulation.step_s(),
        chosen: ending.chosen,
        end_s: simulation.time_s(),
        state_crc32: format!("{:08x}", ending.state_crc32),
        wall_s: ending.wall_s,
        threads: ending.threads,
        machine: machine::describe(),
        counts: counts(simulation),
        stages_s: stages(simulation, ending.stages, ending.wall_s),
        invariants: Invariants {
            energy_gain: worst.energy_gain,
            energy_loss: worst.energy_loss,
            linear_momentum: worst.linear_momentum,
            angular_momentum: worst.angular_momentum,
            max_penetration_ratio: worst.max_penetration_ratio,
            max_h: worst.max_h,
        },
        verdicts,
        stages: Vec::new(),
        motion: recorder.motions.summary(simulation),
        monitors: monitor_ends(simulation, recorder),
        blocks: block_ends(simulation, recorder),
        bolts: bolt_ends(simulation),
        reference: reference_error(ending.scene, recorder),
        warnings,
        settled,
    }
}

/// What makes a run inaccurate from its start on: blocks that lean over an edge, blocks that rock too early on a shaken base, and contact that is deep at rest beside the blocks, which may be far smaller
/// than the elements over which penetration is judged.
fn at_the_start(scene: &Scene, simulation: &Simulation) -> Vec<Finding> {
    let lean = lean::worst(scene, simulation).map(|lean| Finding {
        what: "shift of a weight towards an edge / its distance",
        value: lean.moved,
        limit: lean::MOST_MOVED,
        reason: lean.to_string(),
    });
    let rocking = rocking::worst(scene, simulation).filter(Rocking::is_doubtful).map(|rocking| Finding {
        what: "acceleration at which a block rocks, lowered by penetration",
        value: rocking.lost(),
        limit: rocking::MOST_LOST,
        reason: rocking.to_string(),
    });
    let deep = doubts::depth(scene, simulation).map(|(overlap, reason)| Finding {
        what: "overlap at rest / block size",
        value: overlap,
        limit: doubts::DEEP,
        reason,
    });
    lean.into_iter().chain(rocking).chain(deep).collect()
}

fn counts(simulation: &Simulation) -> Counts {
    let (blocks, worst) = (simulation.blocks(), simulation.invariants());
    Counts {
        blocks: blocks.len(),
        nodes: blocks.rest_position.len(),
        tets: blocks.tets.len(),
        dofs: simulation.unknowns(),
        factors: simulation.factors(),
        candidate_pairs_max: worst.candidate_pairs_max,
        contact_pairs_max: worst.contact_pairs_max,
        candidate_pairs_total: worst.candidate_pairs_total,
        clips_total: worst.contact_pairs_total,
    }
}

/// Seconds per stage; what no stage owns is `other`, so that the shares sum to the whole.
fn stages(simulation: &Simulation, outside: Vec<(String, f64)>, wall_s: f64) -> Named<f64> {
    let times = simulation.stages();
    let inside = [("contact", times.contact_s), ("blocks", times.blocks_s), ("ledger", times.ledger_s)];
    let mut stages: Vec<(String, f64)> = inside.map(|(name, s)| (name.to_string(), s)).to_vec();
    stages.extend(outside);
    let known: f64 = stages.iter().map(|stage| stage.1).sum();
    stages.push(("other".into(), (wall_s - known).max(0.0)));
    Named(stages)
}

/// Advice on the numbers.
fn advice(simulation: &Simulation, scene: &Scene) -> Vec<String> {
    let worst = simulation.invariants();
    let mut advice = Vec::new();
    if let Some(bound) = simulation.contact_bound()
        && worst.max_h > bound
    {
        let step_s = two_figures_down(simulation.step_s() * bound / worst.max_h);
        advice.push(format!(
            "the contact stability number reached {:.2}, limit {bound}: contact may be unstable; step_s = {step_s} would be safe",
            worst.max_h
        ));
    }
    if worst.control.rejected > 0 {
        let StepCounts { rejected, most_halvings } = worst.control;
        let shortest_s = simulation.step_s() * 0.5f64.powi(most_halvings as i32);
        advice.push(format!(
            "steps went from {:.1e} s down to {shortest_s:.1e} s; {rejected} were discarded and repeated",
            simulation.step_s()
        ));
    }
    if worst.iterations_max > 0 {
        advice.push(format!(
            "Newton's method for contact took at most {} evaluations in a step",
            worst.iterations_max
        ));
    }
    if matches!(scene.time.integrator, Integrator::Newmark { .. }) && worst.max_h > 0.0 {
        let restitution = (std::f64::consts::FRAC_PI_4 * worst.max_h).exp();
        advice.push(format!(
            "Newmark takes contact at the previous positions, which adds energy at every Δt: blocks rebound with up to \
             {restitution:.4} of their speed at a contact stability number of {:.3}; use Midpoint, which does not",
            worst.max_h
        ));
    }
    if worst.energy_gain > 0.01 {
        advice.push(format!(
            "numerical error added {:.2} % to the energy: reduce step_s",
            100.0 * worst.energy_gain
        ));
    }
    advice
}

fn monitor_ends(simulation: &Simulation, recorder: &Recorder) -> Named<MonitorEnd> {
    let end = |monitor: &crate::run::monitor::Monitor| MonitorEnd {
        displacement: monitor.displacement(simulation).into(),
        velocity: monitor.velocity(simulation).into(),
    };
    recorder.monitors.iter().map(|m| (m.name.clone(), end(m))).collect()
}

fn block_ends(simulation: &Simulation, recorder: &Recorder) -> Named<BlockEnd> {
    let blocks = simulation.blocks();
    let end = |block| {
        let (operator, range) = (&simulation.shape(block).operator, blocks.nodes_of(block));
        let position = &simulation.state().position[range.clone()];
        let velocity = &simulation.state().velocity[range];
        let momentum = operator.momentum(velocity);
        let angular = operator.angular_momentum(&Vec3::zeros(), position, velocity);
        BlockEnd {
            motion: recorder.motions.of(simulation, block),
            mass: operator.mass_kg,
            velocity: (momentum / operator.mass_kg).into(),
            momentum: momentum.into(),
            angular_momentum: (angular + blocks.origin_m.cross(&momentum)).into(),
            volume_ratio: volume_m3(operator, position) / volume_m3(operator, &operator.rest),
        }
    };
    blocks.ids().map(|block| (blocks.names[block.index()].clone(), end(block))).collect()
}

fn bolt_ends(simulation: &Simulation) -> Named<BoltEnd> {
    let mut all = Vec::new();
    simulation.bolt_statuses(&mut all);
    let end = |(index, status): (usize, BoltStatus)| {
        let name = simulation.bolt(index).map_or_else(String::new, |(name, _)| name.to_string());
        let BoltStatus { axial_n, utilisation, shear_n, debonded, plate_yielded_m, dowel_yielded_m, .. } =
            status;
        let state = status.state.name().into();
        let end =
            BoltEnd { axial_n, utilisation, shear_n, state, plate_yielded_m, dowel_yielded_m, debonded };
        (name, end)
    };
    all.into_iter().enumerate().filter(|(index, _)| simulation.is_installed(*index)).map(end).collect()
}

fn reference_error(scene: &Scene, recorder: &Recorder) -> Option<ReferenceError> {
    let (kind, after_s) = reference::kind(scene.reference.as_ref()?);
    let (end, max) = (recorder.error_end?, recorder.error_max?);
    Some(ReferenceError {
        kind: kind.into(),
        error_end: end.plain,
        error_max: max.plain,
        place_end: end.place,
        after_s,
        stick_stage_end: end.stick_stage,
        stick_stage_max: max.stick_stage,
    })
}
