//! Whether single positions of a run mean anything: a twin that begins with other velocities, by a ten-thousandth of the largest speed, and
//! ends somewhere else, or with other velocities, where the motion is sensitive, as in heaps, falling columns, toppling slopes, and where a block hops on
//! contact that is not damped.

use std::fmt;
use std::ops::ControlFlow;
use std::str::FromStr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use ndda_mesh::geometry::tet_heights;
use ndda_mesh::{BlockId, TetId, Vec3};
use ndda_solver::{BodyKind, Settle, Simulation, StartSnapshot, StepError};

use super::unless_ended;
use crate::judge::words::SECOND_RUN;
use crate::numbers::{counted, length};
use crate::summary::{Label, LabelWord, Status, Summary};

/// Whether a twin of the run is run after it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sensitivity {
    /// Where three or more blocks have moved in an accurate run, or one has hopped several times with friction in between.
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

/// Velocities of the twin differ by this part of the largest speed.
const PUSH: f64 = 1e-4;
/// Pushes of the twins over [`PUSH`]. There is one twin; where a block hops, the next one is run as long as none has parted, since a single one may end near the
/// run by chance.
const PUSHES: [f64; 3] = [1.0, -1.0, 0.5];
/// Blocks of the twin may end this part of a tetrahedron's height away: a third of what an accurate label allows.
const AWAY: f64 = 0.03;
/// Without growth, a push shifts a block by its speed times the time of the run; this many times that is no growth.
const DRIFTS: f64 = 3.0;
/// Velocities of the twin may differ by this part of the largest speed, as in an accurate label.
const FASTER: f64 = 0.01;
/// So many blocks must move for their motions to disturb each other.
const ENOUGH: usize = 3;
/// So many hops of one block, with friction in between, make small differences grow.
const HOPS: f64 = 8.0;

/// Where a run and its twin part.
#[derive(Clone, Debug, PartialEq)]
pub struct Parted {
    /// Name of the block whose end differs most, over what is allowed.
    pub block: String,
    /// How far it ends from where it ends in the run [m].
    pub apart_m: f64,
    /// By how much its velocity differs [m/s], where that is what is too much.
    pub faster_m_s: Option<f64>,
    /// How many blocks differ more than allowed.
    pub blocks: usize,
    /// Whether a block hopped many times with friction in between.
    pub hops: bool,
}

/// Whether a run that begins here makes a twin, by default, if its blocks move far enough.
pub(crate) fn may_want_twin(simulation: &Simulation) -> bool {
    let free = simulation.blocks().ids().filter(|&block| moves(simulation, block));
    simulation.has_contact() && free.take(ENOUGH).count() == ENOUGH
}

impl Sensitivity {
    /// Whether the twin of an accurate run that ends here is to be run.
    pub(super) fn wants_twin(self, simulation: &Simulation) -> bool {
        let ids = || simulation.blocks().ids();
        let moved = || {
            ids().filter(|&block| {
                let gone_m =
                    farthest(simulation, block, simulation.start_position(), &simulation.state().position);
                moves(simulation, block) && gone_m > 0.1 * height_m(simulation, block)
            })
        };
        simulation.has_contact()
            && match self {
                Self::Never => false,
                Self::Always => ids().any(|block| moves(simulation, block)),
                Self::Auto => moved().take(ENOUGH).count() == ENOUGH || hops(simulation),
            }
    }
}

/// Changes the label of an accurate run to sensitive if its twin ends elsewhere, and books the time that this takes.
pub(super) fn judge(
    summary: &mut Summary,
    simulation: &mut Simulation,
    start: &StartSnapshot,
    settle: Option<&Settle>,
    (stop, strict): (&AtomicBool, bool),
) {
    let began = Instant::now();
    match part(simulation, start, settle, stop) {
        Ok(None) if stop.load(Ordering::Relaxed) => {
            summary.warnings.push(
                "the second run was interrupted, so it is not known whether the motion is sensitive".into(),
            );
        }
        Ok(None) => {}
        Ok(Some(parted)) => {
            summary.label = Label { word: LabelWord::Sensitive, reasons: vec![parted.to_string()] };
            summary.status = if strict { Status::Failed } else { summary.status };
        }
        Err(error) => {
            let reason =
                format!("a second run whose start differs by 1e-4 of the largest speed stops {error}");
            summary.label = Label { word: LabelWord::Sensitive, reasons: vec![reason] };
            summary.status = if strict { Status::Failed } else { summary.status };
        }
    }
    let spent_s = began.elapsed().as_secs_f64();
    summary.wall_s += spent_s;
    summary.stages_s.0.push((SECOND_RUN.into(), spent_s));
}

impl fmt::Display for Parted {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { block, apart_m, faster_m_s, blocks, hops } = self;
        let many = counted(*blocks, "block differs", "blocks differ");
        let (ends, by, single) = match faster_m_s {
            Some(faster) => ("with other velocities", format!("{faster:.1e} m/s"), "velocities"),
            None => ("elsewhere", length(*apart_m), "positions"),
        };
        write!(
            f,
            "a start that differs by 1e-4 of the largest speed ends {ends}: {many}, `{block}` by {by}; believe the overall behaviour or \
             statistics of several runs (ndda certify), not the {single} of single blocks"
        )?;
        if *hops {
            write!(
                f,
                "; blocks hop because contact is not damped: a restitution of 0.5 ends that, or `settle: ()` where gravity starts it"
            )?;
        }
        Ok(())
    }
}

/// Runs the twin of a simulation that has come to its end from `start`, or several, and puts it back into its end. None where all stay together, or
/// where somebody asks to end.
///
/// # Errors
/// [`StepError`] that stops the twin; the end is put back then, too.
pub(super) fn part(
    simulation: &mut Simulation,
    start: &StartSnapshot,
    settle: Option<&Settle>,
    stop: &AtomicBool,
) -> Result<Option<Parted>, StepError> {
    let end = simulation.snapshot();
    let push_m_s = PUSH * simulation.speed_scale_m_s();
    let drift_m = DRIFTS * push_m_s * simulation.time_s();
    let pushes = if hops(simulation) { &PUSHES[..] } else { &PUSHES[..1] };
    for push in pushes {
        let outcome = run(simulation, start, (push * push_m_s, end.state.step), settle, stop);
        let twin = (simulation.state().position.clone(), simulation.state().velocity.clone());
        simulation.restore(end.clone()).expect("it is of this simulation");
        if !outcome? {
            break;
        }
        let parted = compare(simulation, &twin, drift_m);
        if parted.is_some() {
            return Ok(parted);
        }
    }
    Ok(None)
}

/// Whether the twin came to its end.
fn run(
    simulation: &mut Simulation,
    start: &StartSnapshot,
    (push_m_s, steps): (f64, u64),
    settle: Option<&Settle>,
    stop: &AtomicBool,
) -> Result<bool, StepError> {
    let mut pushed = simulation.whole(start);
    for block in simulation.blocks().ids().filter(|&block| moves(simulation, block)) {
        let push = push_m_s * direction(block);
        pushed.state.velocity[simulation.blocks().nodes_of(block)].iter_mut().for_each(|v| *v += push);
    }
    simulation.restore(pushed).expect("it is of this simulation");
    let ranks = simulation.ranks().clone();
    if let Some(settle) = settle {
        simulation.settle_watched(settle, &mut |_| unless_ended(&*ranks, stop))?;
    }
    while simulation.state().step < steps {
        if unless_ended(&*ranks, stop) == ControlFlow::Break(()) {
            return Ok(false);
        }
        simulation.step()?;
    }
    Ok(true)
}

/// Where positions and velocities of the twin are too far from those of the run. A velocity counts only where the position has gone farther than the
/// difference at the start would take it by itself: in the middle of a collision, a moment makes all the difference.
fn compare(simulation: &Simulation, twin: &(Vec<Vec3>, Vec<Vec3>), drift_m: f64) -> Option<Parted> {
    let (state, largest_m_s) = (simulation.state(), simulation.speed_scale_m_s());
    let differs = |block: BlockId| {
        let apart_m = farthest(simulation, block, &state.position, &twin.0);
        let faster_m_s = (mean(simulation, block, &state.velocity) - mean(simulation, block, &twin.1)).norm();
        let place = apart_m / (AWAY * height_m(simulation, block) + drift_m);
        let speed = if apart_m > drift_m { faster_m_s / (FASTER * largest_m_s) } else { 0.0 };
        Difference { block, apart_m, faster_m_s, place, speed }
    };
    let all: Vec<Difference> = simulation.blocks().ids().map(differs).collect();
    // A position that is elsewhere says more than a velocity.
    let is_elsewhere = all.iter().any(|one| one.place > 1.0);
    let over = |one: &Difference| if is_elsewhere { one.place } else { one.speed };
    let worst = all.iter().max_by(|a, b| over(a).total_cmp(&over(b))).filter(|one| over(one) > 1.0)?;
    Some(Parted {
        block: simulation.blocks().names[worst.block.index()].clone(),
        apart_m: worst.apart_m,
        faster_m_s: (!is_elsewhere).then_some(worst.faster_m_s),
        blocks: all.iter().filter(|one| over(one) > 1.0).count(),
        hops: hops(simulation),
    })
}

/// How far a block of the twin is from that of the run.
struct Difference {
    block: BlockId,
    /// Distance [m] and difference of velocities [m/s].
    apart_m: f64,
    faster_m_s: f64,
    /// The same over what is allowed.
    place: f64,
    speed: f64,
}

/// Mean velocity of the nodes of a block [m/s].
fn mean(simulation: &Simulation, block: BlockId, velocity: &[Vec3]) -> Vec3 {
    let own = &velocity[simulation.blocks().nodes_of(block)];
    own.iter().sum::<Vec3>() / own.len() as f64
}

/// Whether a block has hopped many times with friction in between that could stop it.
fn hops(simulation: &Simulation) -> bool {
    simulation.invariants().hops_with_friction.value >= HOPS
}

/// Whether a block moves as forces ask.
fn moves(simulation: &Simulation, block: BlockId) -> bool {
    let shape = simulation.shape(block);
    shape.kind != BodyKind::Fixed && shape.is_free()
}

/// Median of the smallest heights of a block's tetrahedra [m]: a sliver inside a block is not what touches.
fn height_m(simulation: &Simulation, block: BlockId) -> f64 {
    let blocks = simulation.blocks();
    let heights = |tet| tet_heights(&blocks.tet_corners(TetId(tet as u32), &blocks.rest_position));
    let lowest = blocks.tets_of(block).map(|tet| heights(tet).into_iter().fold(f64::INFINITY, f64::min));
    let mut lowest: Vec<f64> = lowest.collect();
    let middle = lowest.len() / 2;
    *lowest.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Largest distance of a node of a block in two states [m].
fn farthest(simulation: &Simulation, block: BlockId, one: &[Vec3], other: &[Vec3]) -> f64 {
    let nodes = simulation.blocks().nodes_of(block);
    one[nodes.clone()].iter().zip(&other[nodes]).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
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
    fn two_blocks_have_no_twin_unless_one_is_asked_for() {
        let sliding = ["at_m: (0, 0, 0)"];
        for (sensitivity, has_twin) in [(Sensitivity::Auto, false), (Sensitivity::Always, true)] {
            let summary = label("(5.5, 0, -8.1)", (2e9, 2e-4), &sliding, sensitivity);
            assert_eq!(summary.stages_s.0.iter().any(|(stage, _)| stage == "sensitivity"), has_twin);
        }
    }
}
