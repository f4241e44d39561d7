//! Positions of the blocks when their pairs were listed, and how far each may move before they are listed again.

use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, BlockSet, NodeId, Vec3};
use pulp::Arch;
use rayon::prelude::*;

use crate::affine::convex_target::ConvexBlocks;
use crate::broad_phase::finder::{BroadScene, shape_of};
use crate::model::ContactInput;

/// Skin over the mean size of a block's boundary triangles: twice the way that a resting block may creep.
const SKIN: f64 = 0.01;
/// Steps that the pairs of a block should last, and the most that a block without any is left alone.
const LASTING_STEPS: f64 = 36.0;
const ALONE_STEPS: f64 = 512.0;
/// Widest margin over the mean size of boundary triangles: twice as wide, falling blocks list four times the pairs.
const WIDEST: f64 = 0.2;
/// The part of its reach from which on a block is listed along with others: to arrange all pairs costs what listing those of many blocks does.
const SOON: f64 = 0.5;
/// Blocks below which a second thread costs more than it brings.
const GRAIN_BLOCKS: usize = 2048;

/// A record of positions, block by block.
#[derive(Default)]
pub(crate) struct NeighbourList {
    position: Vec<Vec3>,
    /// Mean size of the boundary triangles of each block at rest [m]; zero without any.
    size_m: Vec<f64>,
    /// How far each block's nodes may move [m].
    reach_m: Vec<f64>,
    /// That and the rounding of coordinates [m].
    margin_m: Vec<f64>,
    /// Steps that the answer about each block should last.
    lasting: Vec<f64>,
    has_pairs: Vec<bool>,
    moved: Vec<bool>,
    renewed: Vec<BlockId>,
    /// By how much facets may be moved out [m].
    opening_m: f64,
    /// Of the set that all this is about; none makes the next record take all blocks.
    shape: Option<[usize; 4]>,
}

impl NeighbourList {
    /// Makes the next [`renew`](Self::renew) take all blocks.
    pub(crate) fn forget(&mut self) {
        self.shape = None;
    }

    /// Makes the next [`renew`](Self::renew) take all blocks where facets are moved out by more than the margins have room for, with room for twice as much.
    pub(crate) fn make_room(&mut self, opening_m: f64) {
        if opening_m > self.opening_m {
            self.opening_m = 2.0 * opening_m;
            self.forget();
        }
    }

    /// Records the positions of all blocks that have moved out of reach, and says whether it is the first time.
    pub(crate) fn renew(&mut self, input: &ContactInput) -> bool {
        let blocks = input.blocks;
        let begins = self.shape != Some(shape_of(blocks));
        if begins {
            self.begin(blocks);
        } else {
            self.look(input);
        }
        self.renewed.clear();
        self.renewed.extend(blocks.ids().filter(|block| self.moved[block.index()]));
        for k in 0..self.renewed.len() {
            self.record(input, self.renewed[k]);
        }
        begins
    }

    /// Learns which blocks have neighbours. One that has, but was to be left alone for long, is looked at anew as soon as it moves: with
    /// less margin it may have none.
    pub(crate) fn note_neighbours(&mut self, pairs: &[(BlockId, BlockId)]) {
        self.has_pairs.fill(false);
        for block in pairs.iter().flat_map(|&(a, b)| [a, b]) {
            self.has_pairs[block.index()] = true;
        }
        for (block, _) in self.has_pairs.iter().enumerate().filter(|(_, has)| **has) {
            if self.lasting[block] > LASTING_STEPS {
                (self.lasting[block], self.reach_m[block]) = (LASTING_STEPS, 0.0);
            }
        }
    }

    /// The blocks of the last [`renew`](Self::renew), ascending.
    pub(crate) fn renewed(&self) -> &[BlockId] {
        &self.renewed
    }

    /// The blocks where they are recorded.
    pub(crate) fn scene<'a>(
        &'a self,
        blocks: &'a BlockSet,
        hulls: &'a ConvexBlocks,
        absent: &'a [bool],
    ) -> BroadScene<'a> {
        BroadScene { blocks, position: &self.position, margin_m: &self.margin_m, hulls, absent }
    }

    fn begin(&mut self, blocks: &BlockSet) {
        let diagonal =
            |t: &[NodeId; 3]| Aabb::around(t.iter().map(|n| &blocks.rest_position[n.index()])).diagonal();
        let mean = |block: BlockId| {
            let triangles = &blocks.triangles[blocks.triangles_of(block)];
            triangles.iter().map(diagonal).sum::<f64>() / triangles.len().max(1) as f64
        };
        self.size_m.clear();
        self.size_m.extend(blocks.ids().map(mean));
        for per_block in [&mut self.reach_m, &mut self.margin_m] {
            per_block.clear();
            per_block.resize(blocks.len(), 0.0);
        }
        self.lasting.clear();
        self.lasting.resize(blocks.len(), LASTING_STEPS);
        self.has_pairs.clear();
        self.has_pairs.resize(blocks.len(), true);
        self.position.clear();
        self.position.resize(blocks.rest_position.len(), Vec3::zeros());
        self.moved.clear();
        self.moved.resize(blocks.len(), true);
        self.shape = Some(shape_of(blocks));
    }

    /// Finds the blocks that have moved; a node that is nowhere has. Where one has moved out of reach, those that soon will have are taken, too.
    fn look(&mut self, input: &ContactInput) {
        let (position, reach_m, arch) = (&self.position, &self.reach_m, Arch::new());
        let is_beyond = |block: usize, reach_m: f64| {
            let nodes = input.blocks.nodes_of(BlockId(block as u32));
            let (was, now) = (&position[nodes.clone()], &input.position[nodes]);
            !are_within(arch, reach_m / 3f64.sqrt(), was, now)
                && !was.iter().zip(now).all(|(x, y)| (x - y).norm_squared() <= reach_m * reach_m)
        };
        let mut look = |part: f64| {
            let look = |(block, moved): (usize, &mut bool)| *moved = is_beyond(block, part * reach_m[block]);
            if self.moved.len() > GRAIN_BLOCKS {
                self.moved.par_iter_mut().enumerate().with_min_len(GRAIN_BLOCKS).for_each(look);
            } else {
                self.moved.iter_mut().enumerate().for_each(look);
            }
            self.moved.contains(&true)
        };
        if look(1.0) {
            look(SOON);
        }
    }

    fn record(&mut self, input: &ContactInput, block: BlockId) {
        let (nodes, b) = (input.blocks.nodes_of(block), block.index());
        let (now, velocity) = (&input.position[nodes.clone()], &input.velocity[nodes.clone()]);
        self.position[nodes].copy_from_slice(now);
        let fastest = velocity.iter().map(|v| v.norm_squared()).fold(0.0, f64::max).sqrt();
        let alone = (2.0 * self.lasting[b]).min(ALONE_STEPS);
        self.lasting[b] = if self.has_pairs[b] { LASTING_STEPS } else { alone };
        let travel = (self.lasting[b] * fastest * input.dt_s).min(WIDEST * self.size_m[b]);
        self.reach_m[b] = travel.max(0.5 * SKIN * self.size_m[b]);
        let furthest = now.iter().map(|x| x.amax()).fold(0.0, f64::max);
        self.margin_m[b] = self.reach_m[b] + 8.0 * f64::EPSILON * furthest;
        if self.opening_m > 0.0 {
            self.margin_m[b] += self.opening_m;
        }
    }

    /// Memory on the heap [B].
    pub(crate) fn heap_bytes(&self) -> usize {
        let numbers = self.size_m.capacity()
            + self.reach_m.capacity()
            + self.margin_m.capacity()
            + self.lasting.capacity();
        self.position.capacity() * size_of::<Vec3>()
            + numbers * size_of::<f64>()
            + self.moved.capacity()
            + self.has_pairs.capacity()
            + self.renewed.capacity() * size_of::<BlockId>()
    }
}

/// Whether no coordinate has changed by more than that: quicker than distances, since no number needs its neighbours.
fn are_within(arch: Arch, most_m: f64, was: &[Vec3], now: &[Vec3]) -> bool {
    // Compiled for each kind of processor.
    arch.dispatch(
        #[inline(always)]
        || {
            let mut within = true;
            for (x, y) in was.iter().zip(now) {
                for i in 0..3 {
                    within &= (x[i] - y[i]).abs() <= most_m;
                }
            }
            within
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{test_box, test_set};

    /// How often a block that moves by a third of a millimetre a step is recorded in so many steps.
    fn records(steps: usize, pairs: &[(BlockId, BlockId)]) -> usize {
        let blocks =
            test_set(vec![test_box([0.0; 3], [1.0; 3], [2, 2, 2]), test_box([9.0; 3], [1.0; 3], [2, 2, 2])]);
        let mut position = blocks.rest_position.clone();
        let mut velocity = vec![Vec3::zeros(); position.len()];
        let moving = blocks.nodes_of(BlockId(0));
        velocity[moving.clone()].fill(Vec3::x());
        let (mut listed, mut records) = (NeighbourList::default(), 0);
        for _ in 0..steps {
            position[moving.clone()].iter_mut().for_each(|x| x.x += 1e-3 / 3.0);
            let begins = listed.renew(&ContactInput::new(&blocks, &position, &velocity, 1e-3 / 3.0));
            listed.note_neighbours(pairs);
            records += usize::from(!begins && !listed.renewed().is_empty());
            assert!(listed.renewed().iter().all(|block| begins || *block == BlockId(0)));
        }
        records
    }

    #[test]
    fn a_block_without_pairs_is_left_alone_for_longer_and_longer() {
        let (alone, near) = (records(2700, &[]), records(2700, &[(BlockId(0), BlockId(1))]));
        assert!((3..=12).contains(&alone) && near >= 60, "{alone} and {near}");
    }

    #[test]
    fn a_node_that_is_nowhere_has_moved() {
        let here = [Vec3::zeros()];
        let are_within = |most_m, now: Vec3| are_within(Arch::new(), most_m, &here, &[now]);
        assert!(are_within(0.0, here[0]));
        assert!(!are_within(1.0, Vec3::new(0.0, f64::NAN, 0.0)));
        assert!(!are_within(1.0, Vec3::new(0.0, 0.0, -1.1)));
    }
}
