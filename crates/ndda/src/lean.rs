//! Blocks that press on their base near its edge, where contact gives way and lets them lean, or fall.
//!
//! A force N whose line meets the base d inside an edge presses on a strip of 3 d. With the width w of the base along the edge, the tilt takes the
//! part 1 − x of d, x² (1 − x) = M, M = N h L₀/(9 k_n w d³). h is how far the line moves towards the edge by the tilt: h_c/cos²α for a weight whose
//! mass centre is h_c above a base that dips by α. Beyond M = 4/27 there is no such x, and the block falls, although a rigid edge would hold it.
//!
//! Where N acts within the middle third of a base of depth B, the whole base is in contact. Its eccentricity e grows to e/(1 − R),
//! R = 6 N h L₀/(k_n w B³) = 54 M d³/B³, as long as that stays within the middle third.

use std::fmt;

use ndda_io::scene::{Contact, Potential, Scene, matches};
use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{BodyKind, Simulation};

use crate::base_of_block::{Base, Pressed, Pull, with_all_on_it};
use crate::numbers::{counted, length};
use crate::rocking::least_from;

/// Part of d that the force may move by.
pub const MOST_MOVED: f64 = 0.06;
/// M from which on it falls.
const FALLS: f64 = 4.0 / 27.0;
/// M with the penalty that is advised, and the part of d that the force moves by then.
const ADVISED: f64 = 0.02;
/// Most free blocks of a scene that are looked at: each is compared with all others.
const MOST_BLOCKS: usize = 100;
/// Factor on the penalty beyond which none is advised.
const MOST_RAISED: f64 = 1e6;

/// A block whose weight, with that of all that rests on it and the loads on them, acts near the edge of its base.
#[derive(Clone, Debug, PartialEq)]
pub struct Lean {
    /// Its name.
    pub block: String,
    /// Blocks that rest on it.
    pub blocks_on_it: usize,
    /// d [m].
    pub inside_m: f64,
    /// M.
    pub m: f64,
    /// Part of d that the force moves by: all of it where the block falls.
    pub moved: f64,
    /// Penalty with which it hardly leans [Pa].
    pub penalty_pa: f64,
}

impl fmt::Display for Lean {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { block, blocks_on_it, inside_m, m, moved, penalty_pa } = self;
        let inside = length(*inside_m);
        let (on_it, them) = match blocks_on_it {
            0 => (String::new(), "it"),
            on_it => (format!(" and of {} on it", counted(*on_it, "block", "blocks")), "them"),
        };
        write!(
            f,
            "the weight of block `{block}`{on_it}, with the loads on {them}, acts {inside} inside the edge of its base, and contact is too soft there: "
        )?;
        match *moved < 1.0 {
            true => write!(
                f,
                "the block leans, and its weight moves {:.1} % of the way to the edge, limit {:.0} %",
                100.0 * moved,
                100.0 * MOST_MOVED
            )?,
            false => write!(f, "the block falls, although a rigid edge would hold it")?,
        }
        match *m < MOST_RAISED * ADVISED {
            true => write!(f, ": raise penalty_pa to {penalty_pa:.0e}"),
            false => write!(f, ", but so close to the edge that no penalty decides whether it stands"),
        }
    }
}

/// Part of d that a force moves by, and M; all of d where the block falls.
fn moved(Pressed { normal_n, inside_m, width_m, across_m, arm_m }: Pressed, soft_m_pa: f64) -> (f64, f64) {
    let m = normal_n * arm_m * soft_m_pa / (9.0 * width_m * inside_m.powi(3));
    let (r, eccentric_m) = (54.0 * m * (inside_m / across_m).powi(3), 0.5 * across_m - inside_m);
    if 6.0 * eccentric_m < (1.0 - r) * across_m {
        return (r * eccentric_m / ((1.0 - r) * inside_m), m);
    }
    (if m < FALLS { 1.0 - left(m) } else { 1.0 }, m)
}

/// x: the part of d that is left.
fn left(m: f64) -> f64 {
    let (mut low, mut high) = (2.0 / 3.0, 1.0);
    for _ in 0..50 {
        let x = 0.5 * (low + high);
        if x * x * (1.0 - x) > m { low = x } else { high = x }
    }
    low
}

/// The free block whose force moves by the largest part under the loads at the start and at the extremes of their tables; none without gravity, of potentials other
/// than `Smooth`, or where none moves by more than [`MOST_MOVED`].
pub fn worst(scene: &Scene, simulation: &Simulation) -> Option<Lean> {
    let Some(Contact::Potential { penalty_pa, potential: Potential::Smooth { reference_m }, .. }) =
        scene.contact
    else {
        return None;
    };
    let gravity = Vec3::from(scene.gravity_m_s2);
    let is_free = |block: &BlockId| {
        let name = &simulation.blocks().names[block.index()];
        let is_held = scene.supports.iter().any(|support| matches(&support.block, name));
        simulation.shape(*block).kind != BodyKind::Fixed && !is_held
    };
    let free: Vec<BlockId> = simulation.blocks().ids().filter(is_free).collect();
    if gravity == Vec3::zeros() || free.len() > MOST_BLOCKS {
        return None;
    }
    let bases: Vec<(BlockId, Base)> =
        free.into_iter().filter_map(|block| Some((block, Base::of(simulation, block, &gravity)?))).collect();
    if bases.is_empty() {
        return None;
    }
    // A block that rests on several others is left out, since how it divides its weight among them is not known.
    let stack_on = |block: BlockId| with_all_on_it(&bases, block).unwrap_or_else(|| vec![block]);
    let stacks: Vec<Vec<BlockId>> = bases.iter().map(|(block, _)| stack_on(*block)).collect();
    let mut worst: Vec<Option<Leaning>> = vec![None; bases.len()];
    for time_s in simulation.load_times_s(topples_in_s(simulation, &bases, &gravity)) {
        let loads = simulation.loads_as_drawn(time_s);
        for (k, (_, base)) in bases.iter().enumerate() {
            let found = Leaning::of(base, pulls(simulation, &loads, &stacks[k]), reference_m / penalty_pa);
            let is_worse = |found: &Leaning| worst[k].as_ref().is_none_or(|worst| found.cmp(worst).is_gt());
            if let Some(found) = found.filter(is_worse) {
                worst[k] = Some(found);
            }
        }
    }
    let lean = |(k, found): (usize, Option<Leaning>)| {
        let Leaning { moved, m, inside_m, over_corner } = found.filter(|found| found.moved > MOST_MOVED)?;
        let advised_pa = over_corner.map_or(penalty_pa * m / ADVISED, |pulls| {
            let moved = |penalty_pa: f64| bases[k].1.moved_outwards(&pulls, reference_m / penalty_pa);
            least_from(penalty_pa, |penalty_pa| moved(penalty_pa).is_some_and(|at| at.0 <= ADVISED))
        });
        let block = simulation.blocks().names[bases[k].0.index()].clone();
        let m = ADVISED * advised_pa / penalty_pa;
        Some(Lean { block, blocks_on_it: stacks[k].len() - 1, inside_m, m, moved, penalty_pa: advised_pa })
    };
    let leans = worst.into_iter().enumerate().filter_map(lean);
    leans.max_by(|a, b| a.moved.total_cmp(&b.moved).then(a.m.total_cmp(&b.m)))
}

/// How loads press on a base.
#[derive(Clone)]
struct Leaning {
    moved: f64,
    m: f64,
    inside_m: f64,
    /// The loads, where it moves most over a corner.
    over_corner: Option<Vec<Pull>>,
}

impl Leaning {
    /// Over the edge or the corner of a base towards which loads move most; none where they do not press within it. `soft_m_pa` is L₀/k_n.
    fn of(base: &Base, pulls: Vec<Pull>, soft_m_pa: f64) -> Option<Self> {
        let over_edges = base.pressed(&pulls).into_iter().map(|pressed| {
            let (inside_m, (moved, m)) = (pressed.inside_m, moved(pressed, soft_m_pa));
            Self { moved, m, inside_m, over_corner: None }
        });
        let over_edge = over_edges.max_by(Self::cmp)?;
        Some(match base.moved_outwards(&pulls, soft_m_pa) {
            Some((moved, inside_m)) if moved > 1.05 * over_edge.moved => {
                Self { moved, inside_m, over_corner: Some(pulls), ..over_edge }
            }
            _ => over_edge,
        })
    }

    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.moved.total_cmp(&other.moved).then(self.m.total_cmp(&other.m))
    }
}

/// √(L/g) [s] with the largest extent L of a block: loads that last no longer do not overturn it.
fn topples_in_s(simulation: &Simulation, bases: &[(BlockId, Base)], gravity: &Vec3) -> f64 {
    let blocks = simulation.blocks();
    let extent_m = |block: &BlockId| Aabb::around(&blocks.rest_position[blocks.nodes_of(*block)]).diagonal();
    let largest_m = bases.iter().map(|(block, _)| extent_m(block)).fold(0.0, f64::max);
    (largest_m / gravity.norm()).sqrt()
}

/// The loads of all nodes that are those of some blocks, and where these were drawn.
fn pulls(simulation: &Simulation, loads: &[Vec3], stack: &[BlockId]) -> Vec<Pull> {
    let blocks = simulation.blocks();
    let nodes = stack.iter().flat_map(|block| blocks.nodes_of(*block));
    nodes.map(|node| (blocks.rest_position[node], loads[node])).collect()
}

#[cfg(test)]
mod tests;
