//! Whether a run's end may be believed although each of its steps may: runs of the same scene that differ a little, its *twins*.
//!
//! A twin that begins with other velocities, by a ten-thousandth of the largest speed, ends somewhere else, or with other velocities, where the motion is
//! sensitive: in heaps, falling columns, toppling slopes, and where a block hops on contact that is not damped. One with half the step does where the errors
//! of impacts have grown in the next ones.

mod parted;

use std::ops::ControlFlow;
use std::str::FromStr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{BodyKind, Settle, Simulation, StartSnapshot, StepError};

use super::unless_ended;
use crate::judge::words::SECOND_RUN;
use crate::summary::{Label, LabelWord, Status, Summary};
pub(super) use parted::Parted;
use parted::{farthest_m, height_m, parted};

/// Whether twins of the run are run after it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sensitivity {
    /// After an accurate run in which three or more blocks have moved, or two that end beside each other, or in which one has hopped several times with
    /// friction in between, or hit twice or more.
    #[default]
    Auto,
    /// After each accurate run with contact.
    Always,
    /// Not at all.
    Never,
}

impl FromStr for Sensitivity {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        match word {
            "auto" => Ok(Self::Auto),
            "always" => Ok(Self::Always),
            "never" => Ok(Self::Never),
            other => Err(format!("`{other}` is none of auto, always, never")),
        }
    }
}

/// How a twin differs from its run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Twin {
    /// Its velocities at the start, by so many ten-thousandths of the largest speed.
    Push(f64),
    /// Its step, which is half as long: its errors are half of those of the run where friction acts in impacts, a quarter elsewhere.
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

/// Whether a run that begins here makes a twin, by default, if its blocks move far enough.
pub(crate) fn may_want_twin(simulation: &Simulation) -> bool {
    let free = simulation.blocks().ids().filter(|&block| moves(simulation, block));
    simulation.has_contact() && free.take(ENOUGH).count() == ENOUGH
}

/// Whether a run that begins here makes a twin with half the step, by default, if a block hits several times.
pub(crate) fn may_want_half_step(simulation: &Simulation) -> bool {
    simulation.has_contact() && simulation.blocks().ids().any(|block| moves(simulation, block))
}

impl Sensitivity {
    /// The twins of an accurate run that ends here, to be run one after the other until one parts.
    pub(crate) fn twins(self, simulation: &Simulation) -> Vec<Twin> {
        let ids = || simulation.blocks().ids();
        let moved = || {
            ids().filter(|&block| {
                let gone_m =
                    farthest_m(simulation, block, simulation.start_position(), &simulation.state().position);
                moves(simulation, block) && gone_m > 0.1 * height_m(simulation, block)
            })
        };
        let hops = hops(simulation);
        let (pushes, halves) = match self {
            _ if !simulation.has_contact() => (false, false),
            Self::Never => (false, false),
            Self::Always => {
                let any = ids().any(|block| moves(simulation, block));
                (any, any)
            }
            Self::Auto => {
                let moved: Vec<BlockId> = moved().take(ENOUGH).collect();
                (moved.len() == ENOUGH || lie_together(simulation, &moved) || hops, hits_again(simulation))
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
}

/// The line that announces repetitions of a run.
pub(crate) fn told(twins: &[Twin]) -> String {
    let pushed = "velocities changed by 1e-4 of the largest speed";
    let by = match (twins.contains(&PUSHES[0]), twins.contains(&Twin::HalfStep)) {
        (true, true) => format!("{pushed}, then with half the step"),
        (true, false) => pushed.into(),
        (false, _) => "half the step, since blocks have hit several times".into(),
    };
    format!(
        "running the scene again with {by}, to see whether the result changes (`--sensitivity never` skips this)"
    )
}

/// Changes the label of an accurate run if a twin ends elsewhere, and books the time that this takes.
pub(super) fn judge(
    summary: &mut Summary,
    simulation: &mut Simulation,
    start: &StartSnapshot,
    (settle, twins): (Option<&Settle>, &[Twin]),
    (stop, strict): (&AtomicBool, bool),
) {
    let began = Instant::now();
    if let Some(label) = label_of_twins(simulation, start, settle, twins, stop) {
        summary.label = label;
        summary.status = if strict { Status::Failed } else { summary.status };
    } else if stop.load(Ordering::Relaxed) {
        summary.warnings.push(
            "the second run was interrupted, so it is not known whether the motion is sensitive".into(),
        );
    }
    let spent_s = began.elapsed().as_secs_f64();
    summary.wall_s += spent_s;
    summary.stages_s.0.push((SECOND_RUN.into(), spent_s));
}

/// The label of an accurate run of which a twin ends elsewhere; none where all end beside it, or where somebody asks to end.
pub(crate) fn label_of_twins(
    simulation: &mut Simulation,
    start: &StartSnapshot,
    settle: Option<&Settle>,
    twins: &[Twin],
    stop: &AtomicBool,
) -> Option<Label> {
    let contacts = simulation.replace_contacts(None);
    let parted = part(simulation, start, settle, twins, stop);
    simulation.replace_contacts(contacts);
    let (word, reason) = match parted {
        Ok(parted) => parted.map(|parted| (parted.word(), parted.to_string()))?,
        Err(error) => (
            LabelWord::Sensitive,
            format!("a second run, whose start or step differs a little, stops {error}"),
        ),
    };
    Some(Label { word, reasons: vec![reason] })
}

/// Runs twins of a simulation that has come to its end from `start`, and puts it back into its end. None where all stay together, or
/// where somebody asks to end.
///
/// # Errors
/// [`StepError`] that stops a twin; the end is put back then, too.
fn part(
    simulation: &mut Simulation,
    start: &StartSnapshot,
    settle: Option<&Settle>,
    twins: &[Twin],
    stop: &AtomicBool,
) -> Result<Option<Parted>, StepError> {
    let (end, step_s) = (simulation.snapshot(), simulation.step_s());
    let drift_m = DRIFTS * PUSH * simulation.speed_scale_m_s() * simulation.time_s();
    for &twin in twins {
        let outcome = run(simulation, start, (twin, end.state.step), settle, stop);
        let ended = (simulation.state().position.clone(), simulation.state().velocity.clone());
        if simulation.step_s() != step_s {
            simulation.change_step(step_s)?;
        }
        simulation.restore(end.clone()).expect("it is of this simulation");
        if !outcome? {
            break;
        }
        let parted = parted(simulation, twin, &ended, drift_m);
        if parted.is_some() {
            return Ok(parted);
        }
    }
    Ok(None)
}

/// Whether the twin of a run of so many steps came to its end.
fn run(
    simulation: &mut Simulation,
    start: &StartSnapshot,
    (twin, steps): (Twin, u64),
    settle: Option<&Settle>,
    stop: &AtomicBool,
) -> Result<bool, StepError> {
    let mut changed = simulation.whole(start);
    let mut steps_of_twin = steps;
    match twin {
        Twin::Push(times) => {
            let push_m_s = times * PUSH * simulation.speed_scale_m_s();
            for block in simulation.blocks().ids().filter(|&block| moves(simulation, block)) {
                let push = push_m_s * direction(block);
                changed.state.velocity[simulation.blocks().nodes_of(block)]
                    .iter_mut()
                    .for_each(|v| *v += push);
            }
        }
        Twin::HalfStep => {
            steps_of_twin = 2 * steps;
            simulation.change_step(0.5 * simulation.step_s())?;
        }
    }
    simulation.restore(changed).expect("it is of this simulation");
    let ranks = simulation.ranks().clone();
    if let Some(settle) = settle {
        simulation.settle_watched(settle, &mut |_| unless_ended(&*ranks, stop))?;
    }
    while simulation.state().step < steps_of_twin {
        if unless_ended(&*ranks, stop) == ControlFlow::Break(()) {
            return Ok(false);
        }
        simulation.step()?;
    }
    Ok(true)
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

/// Whether a block has hit several times.
fn hits_again(simulation: &Simulation) -> bool {
    simulation.invariants().second_impact.value >= IMPACT
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
mod tests {
    use super::*;
    use crate::{Model, Run};

    /// A floor, and blocks above it.
    fn label(
        gravity: &str,
        (penalty_pa, step_s): (f64, f64),
        blocks: &[&str],
        sensitivity: Sensitivity,
    ) -> Summary {
        let block = |(name, more): (usize, &&str)| {
            format!(
                "(name: \"{name}\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), {more}),"
            )
        };
        let blocks: String = blocks.iter().enumerate().map(block).collect();
        let text = format!(
            "(title: \"twins\", time: (step_s: {step_s:e}, end_s: 1.1), gravity_m_s2: {gravity},
            materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
            blocks: [(name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (40, 20, 1), cells: (1, 1, 1)),
                at_m: (-10, -10, -1)), {blocks}],
            contact: Potential(penalty_pa: {penalty_pa:e}, potential: Smooth(), friction: (friction_deg: 25)))"
        );
        Run::new(Model::from_text(&text).unwrap()).sensitivity(sensitivity).finish(&mut []).unwrap().summary
    }

    const TUMBLING: [&str; 4] = [
        "at_m: (0, 0, 0.5), spin_rad_s: (0.5, 0.2, 0)",
        "at_m: (0.6, 0.1, 1.8), spin_rad_s: (1, 0, 0.3)",
        "at_m: (-0.3, 0.4, 3.2), spin_rad_s: (0, 0.7, 0)",
        "at_m: (0.2, -0.3, 4.6)",
    ];

    #[test]
    fn cubes_that_tumble_over_each_other_are_sensitive_and_the_run_keeps_its_bits() {
        let [with, without] = [Sensitivity::Auto, Sensitivity::Never]
            .map(|sensitivity| label("(0, 0, -9.81)", (1e10, 5e-5), &TUMBLING, sensitivity));
        assert_eq!(without.label.word, LabelWord::Accurate, "{:?}", without.label.reasons);
        assert_eq!(with.label.word, LabelWord::Sensitive, "{:?}", with.label.reasons);
        assert_eq!((with.state_crc32, with.verdicts), (without.state_crc32, without.verdicts));
    }

    #[test]
    fn cubes_that_slide_side_by_side_are_not_sensitive_though_they_part() {
        let sliding = ["at_m: (0, 0, 0)", "at_m: (3, 0, 0)", "at_m: (0, 3, 0)"];
        let summary = label("(5.5, 0, -8.1)", (2e9, 2e-4), &sliding, Sensitivity::Auto);
        assert_eq!(summary.label.word, LabelWord::Accurate, "{:?}", summary.label.reasons);
        assert!(summary.stages_s.0.iter().any(|(stage, _)| stage == "sensitivity"));
    }

    #[test]
    fn a_cube_that_hops_on_undamped_contact_is_sensitive_in_its_velocity_and_told_how_to_end_that() {
        let text = "(title: \"pulled\", time: (step_s: 3e-5, end_s: 1), gravity_m_s2: (3.92, 0, -9.81),
            materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.2, density_kg_m3: 2600)],
            blocks: [
                (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (4, 2, 0.5), cells: (1, 1, 1)), at_m: (0, 0, -0.5)),
                (name: \"cube\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (1, 0.5, 0)),
            ],
            contact: Potential(penalty_pa: 2e8, friction: (friction_deg: 35)))";
        let summary = Run::new(Model::from_text(text).unwrap()).finish(&mut []).unwrap().summary;
        let reason = summary.label.reasons.join("; ");
        assert_eq!(summary.label.word, LabelWord::Sensitive, "{reason}");
        assert!(
            reason.contains("with other velocities") && reason.contains("restitution of 0.5"),
            "{reason}"
        );
    }

    #[test]
    fn an_elastic_block_whose_face_hops_while_it_slides_is_sensitive_although_one_twin_ends_near_it() {
        let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../scenes/extreme/elastic_block_stands.ron");
        let set = ["gravity_ramp_s=0", "contact.penalty_pa=6e10", "output.frames=0"].map(String::from);
        let summary = Run::new(Model::open(&file, &set).unwrap()).finish(&mut []).unwrap().summary;
        assert_eq!(summary.label.word, LabelWord::Sensitive, "{:?}", summary.label.reasons);
    }

    #[test]
    fn a_stone_whose_impacts_have_grown_an_error_is_inaccurate_until_its_step_is_halved() {
        let stone = |step_s: f64| {
            let text = format!(
                "(title: \"stone\", time: (step_s: {step_s:e}, end_s: 2), gravity_m_s2: (4.905, 0, -8.496),
                materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
                blocks: [
                    (name: \"slope\", material: \"rock\", body: Fixed, shape: Box(size_m: (60, 20, 1), cells: (1, 1, 1)), at_m: (-5, -10, -1)),
                    (name: \"stone\", material: \"rock\", body: Rigid,
                        shape: Prism(outline_m: ((0, 0), (1, 0), (0.4, 0.8)), height_m: 0.7, cells: (1, 1)),
                        turns: [(axis: (0.941, -0.234, 0.225), angle_deg: 110.73)], at_m: (0, 0, 1.88),
                        velocity_m_s: (0.341, 0.105, 0), spin_rad_s: (1.441, -0.666, 0)),
                ],
                contact: Potential(penalty_pa: 1e10, potential: Smooth(), friction: (friction_deg: 60)))"
            );
            Run::new(Model::from_text(&text).unwrap()).finish(&mut []).unwrap().summary.label
        };
        let (long, short) = (stone(2e-4), stone(1e-4));
        assert_eq!(long.word, LabelWord::Inaccurate, "{:?}", long.reasons);
        assert!(long.reasons[0].contains("errors of impacts grow"), "{:?}", long.reasons);
        assert_eq!(short.word, LabelWord::Accurate, "{:?}", short.reasons);
    }

    #[test]
    fn blocks_that_rounding_alone_moves_are_not_sensitive() {
        let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/extreme/at_rest.ron");
        let run = Run::new(Model::open(&file, &[]).unwrap()).sensitivity(Sensitivity::Always);
        let summary = run.finish(&mut []).unwrap().summary;
        assert_eq!(summary.label.word, LabelWord::Accurate, "{:?}", summary.label.reasons);
    }

    #[test]
    fn two_blocks_have_no_twin_unless_one_is_asked_for() {
        let sliding = ["at_m: (0, 0, 0)"];
        for (sensitivity, has_twin) in [(Sensitivity::Auto, false), (Sensitivity::Always, true)] {
            let summary = label("(5.5, 0, -8.1)", (2e9, 2e-4), &sliding, sensitivity);
            assert_eq!(summary.stages_s.0.iter().any(|(stage, _)| stage == "sensitivity"), has_twin);
        }
    }
}
