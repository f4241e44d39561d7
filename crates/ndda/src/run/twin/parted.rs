//! Where a run and its twin part.

use std::fmt;

use ndda_fem::block_operator::RigidMotion;
use ndda_mesh::geometry::tet_heights;
use ndda_mesh::{BlockId, TetId, Vec3};
use ndda_solver::Simulation;

use super::{Twin, has_free_loads, hits_again, hops};
use crate::numbers::{counted, length};
use crate::summary::LabelWord;

/// Parts of a tetrahedron's height by which blocks of a twin may end away, and of the largest speed by which their velocities may differ: of one that
/// is pushed, a third of what an accurate label allows, and all of it.
const OF_PUSH: (f64, f64) = (0.03, 0.01);
/// The same two limits for a twin with half the step: half of what an accurate label allows, since its errors are at most half of those of the run.
const OF_STEP: (f64, f64) = (0.05, 0.005);
/// Three quarters of what that label allows: what a twin with half the step differs by without contact, where errors fall with the square of the step.
const OF_SECOND_ORDER: (f64, f64) = (0.075, 0.0075);
/// The most by which the label advises to divide a step.
const MOST: f64 = 64.0;

/// Where a run and its twin part.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Parted {
    /// How the twin differs.
    twin: Twin,
    /// Name of the block whose end differs most, over what is allowed.
    block: String,
    /// How far it ends from where it ends in the run [m].
    apart_m: f64,
    /// By how much its velocity or that of its rotation differs [m/s], where that is what is too much.
    faster_m_s: Option<f64>,
    /// How many blocks differ more than allowed, and the worst by how many times that.
    blocks: usize,
    times: f64,
    /// Whether a block hopped many times with friction in between, on contact that is not damped.
    hops: bool,
    /// Whether a block hit several times.
    hits_again: bool,
}

impl Parted {
    /// The label that this gives to the run.
    pub(crate) fn word(&self) -> LabelWord {
        match self.twin {
            Twin::Push(_) => LabelWord::Sensitive,
            Twin::HalfStep => LabelWord::Inaccurate,
        }
    }
}

impl fmt::Display for Parted {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { block, apart_m, faster_m_s, blocks, .. } = self;
        let many = counted(*blocks, "block differs", "blocks differ");
        let (ends, by, single) = match faster_m_s {
            Some(faster) => ("with other velocities", format!("{faster:.1e} m/s"), "velocities"),
            None => ("elsewhere", length(*apart_m), "positions"),
        };
        let Twin::Push(_) = self.twin else {
            return write!(
                f,
                "a run with half the step ends {ends}{}: {many}, `{block}` by {by}; divide step_s by {}",
                if self.hits_again { ", since errors of impacts grow in later ones" } else { "" },
                self.times.ceil().clamp(2.0, MOST)
            );
        };
        write!(
            f,
            "a start that differs by 1e-4 of the largest speed ends {ends}: {many}, `{block}` by {by}; believe the overall behaviour or \
             statistics of several runs (ndda certify), not the {single} of single blocks"
        )?;
        if self.hops {
            write!(
                f,
                "; blocks hop because contact is not damped: a restitution of 0.5 ends that, or `settle: ()` where gravity starts it"
            )?;
        }
        Ok(())
    }
}

/// Where positions and velocities of the twin are too far from those of the run. A velocity counts only where the position has gone farther than the
/// difference at the start would take it by itself: in the middle of a collision, a moment makes all the difference. With half the step, that does not hold for a block that its loads
/// move while nothing touches it.
pub(super) fn parted(
    simulation: &Simulation,
    twin: Twin,
    ended: &(Vec<Vec3>, Vec<Vec3>),
    drift_m: f64,
) -> Option<Parted> {
    let (state, largest_m_s) = (simulation.state(), simulation.speed_scale_m_s());
    let (away, faster) = match twin {
        Twin::Push(_) => OF_PUSH,
        Twin::HalfStep if !simulation.has_contact() && simulation.is_of_second_order() => OF_SECOND_ORDER,
        Twin::HalfStep => OF_STEP,
    };
    let differs = |block: BlockId| {
        let apart_m = farthest_m(simulation, block, &state.position, &ended.0);
        let starts_equal = twin == Twin::HalfStep && has_free_loads(simulation, block);
        let drift_m = if starts_equal { 0.0 } else { drift_m };
        let faster_m_s = faster_m_s(simulation, block, (&state.position, &state.velocity), ended);
        let place = apart_m / (away * height_m(simulation, block) + drift_m);
        let scale_m_s = largest_m_s.max(simulation.rest_speed_m_s(block));
        let allowed_m_s = faster * scale_m_s + simulation.rounding_speed_m_s(block);
        let speed = if apart_m > drift_m { faster_m_s / allowed_m_s } else { 0.0 };
        Difference { block, apart_m, faster_m_s, place, speed }
    };
    let all: Vec<Difference> = simulation.blocks().ids().map(differs).collect();
    // A position that is elsewhere says more than a velocity.
    let is_elsewhere = all.iter().any(|one| one.place > 1.0);
    let over = |one: &Difference| if is_elsewhere { one.place } else { one.speed };
    let worst = all.iter().max_by(|a, b| over(a).total_cmp(&over(b))).filter(|one| over(one) > 1.0)?;
    Some(Parted {
        twin,
        block: simulation.blocks().names[worst.block.index()].clone(),
        apart_m: worst.apart_m,
        faster_m_s: (!is_elsewhere).then_some(worst.faster_m_s),
        blocks: all.iter().filter(|one| over(one) > 1.0).count(),
        times: over(worst),
        hops: hops(simulation) && !simulation.damps_contact(),
        hits_again: hits_again(simulation),
    })
}

/// How far a block of the twin is from that of the run.
struct Difference {
    block: BlockId,
    /// Distance [m] and difference of velocities [m/s].
    apart_m: f64,
    faster_m_s: f64,
    /// Both over their limits.
    place: f64,
    speed: f64,
}

/// By how much the velocity of a block differs, or its spin times the distance of its farthest node from the middle, if that is more [m/s]. Spins are those of a
/// block of the run's present shape with the angular momenta of both: vibrations change shapes.
fn faster_m_s(
    simulation: &Simulation,
    block: BlockId,
    (position, velocity): (&[Vec3], &[Vec3]),
    ended: &(Vec<Vec3>, Vec<Vec3>),
) -> f64 {
    let (nodes, operator) = (simulation.blocks().nodes_of(block), &simulation.shape(block).operator);
    let own = &position[nodes.clone()];
    let run = operator.rigid_motion(own, &velocity[nodes.clone()]);
    let twin = operator.rigid_motion(&ended.0[nodes.clone()], &ended.1[nodes]);
    let reach_m = own.iter().map(|x| (x - run.center).norm()).fold(0.0, f64::max);
    let momentum = |motion: &RigidMotion| {
        motion.inverse_inertia.try_inverse().map_or(Vec3::zeros(), |inertia| inertia * motion.spin_rad_s)
    };
    let spin_m_s = reach_m * (run.inverse_inertia * (momentum(&run) - momentum(&twin))).norm();
    spin_m_s.max((run.velocity_m_s - twin.velocity_m_s).norm())
}

/// Median of the smallest heights of a block's tetrahedra [m]: a sliver inside a block is not what touches.
pub(super) fn height_m(simulation: &Simulation, block: BlockId) -> f64 {
    let blocks = simulation.blocks();
    let heights = |tet| tet_heights(&blocks.tet_corners(TetId(tet as u32), &blocks.rest_position));
    let lowest = blocks.tets_of(block).map(|tet| heights(tet).into_iter().fold(f64::INFINITY, f64::min));
    let mut lowest: Vec<f64> = lowest.collect();
    let middle = lowest.len() / 2;
    *lowest.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Largest distance of a node of a block in two states [m].
pub(super) fn farthest_m(simulation: &Simulation, block: BlockId, one: &[Vec3], other: &[Vec3]) -> f64 {
    let nodes = simulation.blocks().nodes_of(block);
    one[nodes.clone()].iter().zip(&other[nodes]).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}
