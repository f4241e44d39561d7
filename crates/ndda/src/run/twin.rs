//! Whether single positions of a run mean anything: a twin that begins with other velocities, by a ten-thousandth of the largest speed, and
//! ends somewhere else where the motion is sensitive, as in heaps, falling columns and toppling slopes.

use std::fmt;
use std::ops::ControlFlow;
use std::str::FromStr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use ndda_io::summary::{Label, LabelWord, Status, Summary};
use ndda_mesh::geometry::tet_heights;
use ndda_mesh::{BlockId, TetId, Vec3};
use ndda_solver::{BodyKind, Settle, Simulation, StartSnapshot, StepError};

use super::unless_ended;
use crate::judge::words::SECOND_RUN;
use crate::numbers::{counted, length};

/// Whether a twin of the run is run after it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sensitivity {
    /// Where three or more blocks have moved in an accurate run.
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
/// Blocks of the twin may end this part of a tetrahedron's height away: a third of what an accurate label allows.
const AWAY: f64 = 0.03;
/// Without growth, a push shifts a block by its speed times the time of the run; this many times that is no growth.
const DRIFTS: f64 = 3.0;
/// So many blocks must move for their motions to disturb each other.
const ENOUGH: usize = 3;

/// Where a run and its twin part.
#[derive(Clone, Debug, PartialEq)]
pub struct Parted {
    /// Name of the block that ends farthest from where it ends in the run, over its height.
    pub block: String,
    /// How far [m].
    pub apart_m: f64,
    /// How many blocks end farther away than allowed.
    pub blocks: usize,
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
                Self::Auto => moved().take(ENOUGH).count() == ENOUGH,
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
        let Self { block, apart_m, blocks } = self;
        write!(
            f,
            "a start that differs by 1e-4 of the largest speed ends elsewhere: {} differ, `{block}` by {}; believe the \
             overall behaviour or statistics of several runs (ndda certify), not the positions of single blocks",
            counted(*blocks, "block", "blocks"),
            length(*apart_m)
        )
    }
}

/// Runs the twin of a simulation that has come to its end from `start`, and puts it back into its end. None where both stay together, or
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
    let time_s = simulation.time_s();
    let outcome = run(simulation, start, (push_m_s, end.state.step), settle, stop);
    let twin = simulation.state().position.clone();
    simulation.restore(end).expect("it is of this simulation");
    let whole = outcome?;
    Ok(whole.then(|| compare(simulation, &twin, DRIFTS * push_m_s * time_s)).flatten())
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

fn compare(simulation: &Simulation, twin: &[Vec3], drift_m: f64) -> Option<Parted> {
    let away = |block: &BlockId| {
        let apart_m = farthest(simulation, *block, &simulation.state().position, twin);
        (apart_m, apart_m / (AWAY * height_m(simulation, *block) + drift_m))
    };
    let blocks = || simulation.blocks().ids().map(|block| (block, away(&block)));
    let (block, (apart_m, _)) = blocks().max_by(|a, b| a.1.1.total_cmp(&b.1.1)).filter(|b| b.1.1 > 1.0)?;
    let count = blocks().filter(|(_, (_, over))| *over > 1.0).count();
    Some(Parted { block: simulation.blocks().names[block.index()].clone(), apart_m, blocks: count })
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
    fn two_blocks_have_no_twin_unless_one_is_asked_for() {
        let sliding = ["at_m: (0, 0, 0)"];
        for (sensitivity, has_twin) in [(Sensitivity::Auto, false), (Sensitivity::Always, true)] {
            let summary = label("(5.5, 0, -8.1)", (2e9, 2e-4), &sliding, sensitivity);
            assert_eq!(summary.stages_s.0.iter().any(|(stage, _)| stage == "sensitivity"), has_twin);
        }
    }
}
