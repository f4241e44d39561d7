//! The list of pairs that are worth clipping; those of two blocks are kept while neither has moved far.

use std::ops::Range;

use ndda_mesh::{BlockId, BlockSet, TetId, TriangleId};
use rayon::prelude::*;

use crate::affine::convex_target::ConvexBlocks;
use crate::broad_phase::bvh::{TreeBroadPhase, make_room};
use crate::broad_phase::finder::BroadPhase;
use crate::broad_phase::neighbour_list::NeighbourList;
use crate::model::ContactInput;

/// Pairs below which a second thread costs more than it brings.
const GRAIN_PAIRS: usize = 4096;

/// A boundary triangle and the tetrahedra of one other block that it may be in.
#[derive(Clone, Debug, PartialEq)]
pub struct Facet {
    /// The contactor's triangle.
    pub triangle: TriangleId,
    /// The other block.
    pub target: BlockId,
    /// Its pairs in [`Candidates::pairs`].
    pub pairs: Range<usize>,
    /// Its two blocks in [`Candidates::neighbours`].
    pub neighbours: u32,
}

/// One pair; the tetrahedron, which may stand for a block that is an affine convex target, is an index into [`Candidates::tets`], the overlap one into a list as long as
/// [`Candidates::overlaps`] says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// The contactor's triangle.
    pub triangle: TriangleId,
    /// Index of the target tetrahedron in `tets`.
    pub tet: u32,
    /// Index of the combination (contactor block, target tetrahedron), where these are numbered.
    pub overlap: u32,
}

/// Pairs near contact, sorted by (triangle, target block, tetrahedron) so that sums have one order.
pub struct Candidates {
    /// All pairs.
    pub pairs: Vec<Pair>,
    /// Runs of pairs with one triangle and one target block.
    pub facets: Vec<Facet>,
    /// The distinct pairs of blocks, (smaller, larger), ascending.
    pub neighbours: Vec<(BlockId, BlockId)>,
    /// The distinct target tetrahedra, ascending.
    pub tets: Vec<TetId>,
    /// Their corners in the order of node numbers, on which neighbours agree.
    pub order: Vec<[u8; 4]>,
    /// The distinct (target tetrahedron, contactor block), block by block; empty where they are not needed.
    pub overlaps: Vec<(TetId, BlockId)>,
    /// Counts the changes of the list.
    pub version: u64,
    /// Whether overlaps are numbered.
    pub numbers_overlaps: bool,
    /// Whether facets end at the borders of target elements, too.
    pub split_by_element: bool,
    found: Vec<(TriangleId, TetId)>,
    slot_of: Vec<u32>,
    /// Of each target block of the contactor that it was last seen with, its place in `neighbours`.
    place_of: Vec<(BlockId, u32)>,
    sorted: Vec<TetId>,
    /// First overlap of each contactor block.
    overlap_start: Vec<u32>,
    broad_phase: Box<dyn BroadPhase>,
    neighbour_list: NeighbourList,
}

impl Default for Candidates {
    fn default() -> Self {
        Self::found_by(Box::new(TreeBroadPhase::default()))
    }
}

impl Candidates {
    /// Pairs that this broad phase finds.
    pub fn found_by(broad_phase: Box<dyn BroadPhase>) -> Self {
        Self {
            pairs: Vec::new(),
            facets: Vec::new(),
            neighbours: Vec::new(),
            tets: Vec::new(),
            order: Vec::new(),
            overlaps: Vec::new(),
            version: 0,
            numbers_overlaps: false,
            split_by_element: false,
            found: Vec::new(),
            slot_of: Vec::new(),
            place_of: Vec::new(),
            sorted: Vec::new(),
            overlap_start: Vec::new(),
            broad_phase,
            neighbour_list: NeighbourList::default(),
        }
    }

    /// The target tetrahedron of a pair.
    pub fn tet_of(&self, pair: u32) -> TetId {
        self.tets[self.pairs[pair as usize].tet as usize]
    }

    /// Name of what finds the pairs.
    pub(crate) fn finder(&self) -> &'static str {
        self.broad_phase.name()
    }

    /// Makes the next update start anew.
    pub fn forget(&mut self) {
        self.neighbour_list.forget();
    }

    /// Brings the list up to date and says whether it changed: the pairs of blocks that have moved no further than
    /// their margin since they were listed stay.
    pub fn update(&mut self, input: &ContactInput, hulls: &ConvexBlocks) -> bool {
        let begins = self.neighbour_list.renew(input);
        if self.neighbour_list.renewed().is_empty() && !begins {
            return false;
        }
        let scene = self.neighbour_list.scene(input.blocks, hulls);
        let changed = self.broad_phase.find_pairs(&scene, self.neighbour_list.renewed(), &mut self.found);
        if changed || begins {
            self.arrange(input);
            self.neighbour_list.note_neighbours(&self.neighbours);
        }
        changed || begins
    }

    /// Memory on the heap [B]; it grows while a scene is new, and no longer.
    pub fn heap_bytes(&self) -> usize {
        let pairs = self.pairs.capacity() * size_of::<Pair>() + self.facets.capacity() * size_of::<Facet>();
        let tets = (self.tets.capacity() + self.sorted.capacity()) * size_of::<TetId>()
            + self.order.capacity() * size_of::<[u8; 4]>();
        let found = self.found.capacity() * size_of::<(TriangleId, TetId)>();
        let overlaps = self.overlaps.capacity() * size_of::<(TetId, BlockId)>();
        let places = (self.slot_of.capacity() + self.overlap_start.capacity()) * size_of::<u32>()
            + (self.place_of.capacity() + self.neighbours.capacity()) * size_of::<(BlockId, u32)>();
        pairs
            + tets
            + found
            + overlaps
            + places
            + self.neighbour_list.heap_bytes()
            + self.broad_phase.heap_bytes()
    }

    /// Numbers what the pairs share.
    fn arrange(&mut self, input: &ContactInput) {
        self.version += 1;
        let (tet_block, triangle_block) = (&input.blocks.tet_block, &input.blocks.triangle_block);
        // Blocks are contiguous in tetrahedra, so the pairs are in the order of target blocks, too.
        self.number_tets(input);
        if self.numbers_overlaps {
            self.number_overlaps(triangle_block);
        }
        let mut pairs = std::mem::take(&mut self.pairs);
        pairs.clear();
        make_room(&mut pairs, self.found.len());
        let pair_of = |found: &(TriangleId, TetId)| Pair {
            triangle: found.0,
            tet: self.slot_of[found.1.index()],
            overlap: if self.numbers_overlaps { self.overlap_of(found, triangle_block) } else { 0 },
        };
        self.found.par_iter().with_min_len(GRAIN_PAIRS).map(pair_of).collect_into_vec(&mut pairs);
        self.pairs = pairs;
        self.facets.clear();
        for (i, &(triangle, tet_id)) in self.found.iter().enumerate() {
            let target = tet_block[tet_id.index()];
            match self.facets.last_mut() {
                Some(last)
                    if last.triangle == triangle && last.target == target && !self.split_by_element =>
                {
                    last.pairs.end = i + 1
                }
                _ => self.facets.push(Facet { triangle, target, pairs: i..i + 1, neighbours: 0 }),
            }
        }
        self.list_neighbours(input.blocks);
    }

    /// The distinct pairs of blocks, and the place of each facet's.
    fn list_neighbours(&mut self, blocks: &BlockSet) {
        let Self { facets, neighbours, place_of, .. } = self;
        let owner = |facet: &Facet| blocks.triangle_block[facet.triangle.index()];
        let pair_of = |a: BlockId, b: BlockId| (a.min(b), a.max(b));
        // Facets of a block follow each other, and most targets were seen with its last triangle.
        let forget = |place_of: &mut Vec<(BlockId, u32)>| {
            place_of.clear();
            place_of.resize(blocks.len(), (BlockId(u32::MAX), 0));
        };
        neighbours.clear();
        forget(place_of);
        for facet in facets.iter() {
            let (own, seen) = (owner(facet), &mut place_of[facet.target.index()].0);
            if std::mem::replace(seen, own) != own {
                neighbours.push(pair_of(own, facet.target));
            }
        }
        neighbours.sort_unstable();
        neighbours.dedup();
        forget(place_of);
        for facet in facets.iter_mut() {
            let (own, (seen, place)) = (owner(facet), &mut place_of[facet.target.index()]);
            if std::mem::replace(seen, own) != own {
                let found = neighbours.binary_search(&pair_of(own, facet.target));
                *place = found.expect("listed above") as u32;
            }
            facet.neighbours = *place;
        }
    }

    fn overlap_of(&self, (triangle, tet): &(TriangleId, TetId), triangle_block: &[BlockId]) -> u32 {
        let block = triangle_block[triangle.index()].index();
        let first = self.overlap_start[block] as usize;
        let end = self.overlap_start.get(block + 1).map_or(self.overlaps.len(), |&e| e as usize);
        (first + self.overlaps[first..end].partition_point(|o| o.0 < *tet)) as u32
    }

    /// The distinct tetrahedra, ascending, and the place of each.
    fn number_tets(&mut self, input: &ContactInput) {
        self.slot_of.clear();
        self.slot_of.resize(input.blocks.tets.len(), u32::MAX);
        self.found.iter().for_each(|pair| self.slot_of[pair.1.index()] = 0);
        self.tets.clear();
        for (tet, slot) in self.slot_of.iter_mut().enumerate().filter(|(_, slot)| **slot == 0) {
            *slot = self.tets.len() as u32;
            self.tets.push(TetId(tet as u32));
        }
        self.order.clear();
        self.order.extend(self.tets.iter().map(|tet| {
            let mut order = [0, 1, 2, 3];
            order.sort_unstable_by_key(|&i: &u8| input.blocks.tets[tet.index()][usize::from(i)]);
            order
        }));
    }

    /// The distinct (tetrahedron, contactor block), block by block.
    fn number_overlaps(&mut self, triangle_block: &[BlockId]) {
        self.overlaps.clear();
        self.overlap_start.clear();
        let block_of = |pair: &(TriangleId, TetId)| triangle_block[pair.0.index()];
        for run in self.found.chunk_by(|a, b| block_of(a) == block_of(b)) {
            let block = block_of(&run[0]);
            self.overlap_start.resize(block.index() + 1, self.overlaps.len() as u32);
            self.sorted.clear();
            self.sorted.extend(run.iter().map(|pair| pair.1));
            self.sorted.sort_unstable();
            self.sorted.dedup();
            self.overlaps.extend(self.sorted.iter().map(|&tet| (tet, block)));
        }
    }
}
