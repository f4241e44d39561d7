//! The list of pairs that are worth clipping; those of two blocks are kept while neither has moved far.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

use ndda_mesh::{BlockId, BlockSet, TetId, TriangleId};
use rayon::prelude::*;

use crate::affine::convex_target::ConvexBlocks;
use crate::broad_phase::block_pairs::{BlockPairs, FacetRuns};
use crate::broad_phase::bvh::TreeBroadPhase;
use crate::broad_phase::finder::BroadPhase;
use crate::broad_phase::neighbour_list::NeighbourList;
use crate::broad_phase::pair_lists::PairLists;
use crate::broad_phase::pair_run::Tets;
use crate::model::ContactInput;

/// Blocks below which a second thread costs more than it brings.
const GRAIN_BLOCKS: usize = 64;

/// A boundary triangle and the tetrahedra of one other block that it may be in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet<'a> {
    /// Its number, ascending by (triangle, target).
    pub number: u32,
    /// The contactor's triangle.
    pub triangle: TriangleId,
    /// The block of that.
    pub owner: BlockId,
    /// The other block.
    pub target: BlockId,
    /// Its two blocks in [`Candidates::neighbours`].
    pub neighbours: u32,
    runs: FacetRuns<'a>,
}

impl<'a> Facet<'a> {
    /// The tetrahedra, which may stand for a block that is an affine convex target, ascending.
    #[inline]
    pub fn tets(&self) -> Tets<'a> {
        self.runs.tets()
    }

    /// The first of them.
    #[inline]
    pub fn first(&self) -> TetId {
        self.runs.run.first()
    }

    /// Number of pairs.
    #[inline]
    pub fn pairs(&self) -> usize {
        self.runs.pairs()
    }

    /// How many numbers it takes.
    #[inline]
    pub(crate) fn numbers(&self) -> u32 {
        self.runs.len() as u32
    }
}

/// Pairs near contact, in the order of (triangle, target block, tetrahedron) so that sums have one order.
pub struct Candidates {
    /// The distinct pairs of blocks, (smaller, larger), ascending.
    pub neighbours: Vec<(BlockId, BlockId)>,
    /// The distinct target tetrahedra, ascending.
    pub tets: Vec<TetId>,
    /// Their corners in the order of node numbers, on which neighbours agree.
    pub order: Vec<[u8; 4]>,
    /// Counts the changes of the list.
    pub version: u64,
    /// Whether facets end at the borders of target elements, too.
    pub split_by_element: bool,
    /// All pairs, where the broad phase keeps them.
    lists: PairLists,
    /// Number of the first facet of each block.
    start: Vec<u32>,
    /// How many pairs there are.
    pairs: usize,
    /// Place of each tetrahedron in `tets`, and of the first of each block.
    slot_of: Vec<AtomicU32>,
    slot_start: Vec<u32>,
    /// Of each target block, the contactor that it was last seen with.
    seen_with: Vec<BlockId>,
    /// First of the neighbours of each smaller block.
    neighbour_start: Vec<u32>,
    broad_phase: Box<dyn BroadPhase>,
    neighbour_list: NeighbourList,
    /// Which blocks are not there; empty where all are.
    absent: Vec<bool>,
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
            neighbours: Vec::new(),
            tets: Vec::new(),
            order: Vec::new(),
            version: 0,
            split_by_element: false,
            lists: PairLists::default(),
            start: Vec::new(),
            pairs: 0,
            slot_of: Vec::new(),
            slot_start: Vec::new(),
            seen_with: Vec::new(),
            neighbour_start: Vec::new(),
            broad_phase,
            neighbour_list: NeighbourList::default(),
            absent: Vec::new(),
        }
    }

    /// Number of pairs.
    pub fn pairs(&self) -> usize {
        self.pairs
    }

    /// All facets, ascending.
    pub fn facets(&self) -> impl Iterator<Item = Facet<'_>> {
        (0..self.start.len().saturating_sub(1)).flat_map(|block| self.facets_of(BlockId(block as u32)))
    }

    /// The facets of a block, ascending.
    #[inline]
    pub fn facets_of(&self, block: BlockId) -> impl Iterator<Item = Facet<'_>> {
        self.facets_within(block, self.numbers_of(block))
    }

    /// The facets with these numbers.
    #[inline]
    pub(crate) fn facets_within(
        &self,
        owner: BlockId,
        numbers: Range<u32>,
    ) -> impl Iterator<Item = Facet<'_>> {
        self.facets_that(owner, numbers, |_| true)
    }

    /// The facets with these numbers, but only those of wanted pairs of blocks; `is_wanted` gets the place of the pair in [`Candidates::neighbours`].
    #[inline]
    pub(crate) fn facets_that(
        &self,
        owner: BlockId,
        numbers: Range<u32>,
        is_wanted: impl Fn(u32) -> bool,
    ) -> impl Iterator<Item = Facet<'_>> {
        let (first, mut number) = (self.start[owner.index()], numbers.start);
        let places = (numbers.start - first) as usize..(numbers.end - first) as usize;
        let mut rest = self.lists.of(owner).within(places);
        std::iter::from_fn(move || {
            loop {
                let runs = rest.next_facet(self.split_by_element)?;
                let (this, triangle, neighbours) = (number, runs.run.triangle, runs.run.neighbours);
                number += runs.len() as u32;
                if is_wanted(neighbours) {
                    let (a, b) = self.neighbours[neighbours as usize];
                    let target = if a == owner { b } else { a };
                    return Some(Facet { number: this, triangle, owner, target, neighbours, runs });
                }
            }
        })
    }

    /// The numbers of the facets of a block; a facet of many tetrahedra may take more than one.
    #[inline]
    pub(crate) fn numbers_of(&self, block: BlockId) -> Range<u32> {
        self.start[block.index()]..self.start[block.index() + 1]
    }

    /// Number of blocks.
    pub(crate) fn blocks(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// Place of a target tetrahedron in `tets`.
    #[inline]
    pub fn slot_of(&self, tet: TetId) -> u32 {
        self.slot_of[tet.index()].load(Ordering::Relaxed)
    }

    /// Places of a block's tetrahedra in `tets`.
    pub(crate) fn slots_of(&self, block: BlockId) -> Range<u32> {
        self.slot_start[block.index()]..self.slot_start[block.index() + 1]
    }

    /// Name of what finds the pairs.
    pub(crate) fn finder(&self) -> &'static str {
        self.broad_phase.name()
    }

    /// Makes the next update start anew.
    pub fn forget(&mut self) {
        self.neighbour_list.forget();
    }

    /// Makes room for facets that are moved out so far before they are clipped [m].
    pub(crate) fn make_room(&mut self, opening_m: f64) {
        self.neighbour_list.make_room(opening_m);
    }

    /// Leaves blocks out from the next update on, those that are `true`.
    pub(crate) fn leave_out(&mut self, absent: &[bool]) {
        self.absent.clear();
        if absent.contains(&true) {
            self.absent.extend_from_slice(absent);
        }
        self.forget();
    }

    /// Brings the list up to date and says whether it changed: the pairs of blocks that have moved no further than
    /// their margin since they were listed stay.
    pub fn update(&mut self, input: &ContactInput, hulls: &ConvexBlocks) -> bool {
        let begins = self.neighbour_list.renew(input);
        if self.neighbour_list.renewed().is_empty() && !begins {
            return false;
        }
        self.lists.by_element = self.split_by_element;
        let scene = self.neighbour_list.scene(input.blocks, hulls, &self.absent);
        let changed = self.broad_phase.find_pairs(&scene, self.neighbour_list.renewed(), &mut self.lists);
        if !self.absent.is_empty() {
            self.lists.keep(|own, target| scene.is_there(own) && scene.is_there(target), input.blocks);
        }
        if changed || begins {
            self.arrange(input.blocks);
            self.neighbour_list.note_neighbours(&self.neighbours);
        }
        changed || begins
    }

    /// Memory on the heap [B]; it grows while a scene is new, and no longer.
    pub fn heap_bytes(&self) -> usize {
        let tets = self.tets.capacity() * size_of::<TetId>() + self.order.capacity() * size_of::<[u8; 4]>();
        let places = (self.slot_of.capacity() + self.seen_with.capacity()) * size_of::<u32>()
            + (self.start.capacity() + self.slot_start.capacity()) * size_of::<u32>()
            + self.neighbour_start.capacity() * size_of::<u32>()
            + self.neighbours.capacity() * size_of::<(BlockId, BlockId)>();
        let lists = self.lists.heap_bytes() + self.neighbour_list.heap_bytes();
        tets + places + lists + self.broad_phase.heap_bytes()
    }

    /// Numbers what the pairs share.
    fn arrange(&mut self, blocks: &BlockSet) {
        self.version += 1;
        self.start.clear();
        self.start.push(0);
        let mut end = 0;
        self.start.extend(self.lists.each().iter().map(|runs| {
            end += runs.len() as u32;
            end
        }));
        self.number_tets(blocks);
        self.list_neighbours(blocks);
    }

    /// The distinct pairs of blocks, and the place of each facet's.
    fn list_neighbours(&mut self, blocks: &BlockSet) {
        let Self { lists, neighbours, neighbour_start, seen_with, .. } = self;
        neighbours.clear();
        let listed = lists.each().iter().map(BlockPairs::count_targets).sum::<usize>();
        // Most pairs are listed from both sides, and these once.
        neighbours.reserve_exact(listed.div_ceil(2));
        seen_with.clear();
        seen_with.resize(blocks.len(), BlockId(u32::MAX));
        for (own, list) in blocks.ids().zip(lists.each()) {
            for target in list.targets().map(|tet| blocks.tet_block[tet.index()]) {
                if std::mem::replace(&mut seen_with[target.index()], own) == own {
                    continue;
                }
                if own <= target || !lists.each()[target.index()].has_target(&blocks.tets_of(own)) {
                    neighbours.push((own.min(target), own.max(target)));
                }
            }
        }
        neighbours.par_sort_unstable();
        neighbours.dedup();
        neighbour_start.clear();
        neighbour_start.resize(blocks.len() + 1, 0);
        neighbours.iter().for_each(|(a, _)| neighbour_start[a.index() + 1] += 1);
        (0..blocks.len()).for_each(|b| neighbour_start[b + 1] += neighbour_start[b]);
        let (neighbours, starts) = (&*neighbours, &*neighbour_start);
        let place = |(own, list): (usize, &mut BlockPairs)| {
            let own = BlockId(own as u32);
            list.each_target_mut(|tet, place| {
                let target = blocks.tet_block[tet.index()];
                let (a, b) = (own.min(target), own.max(target));
                let [start, end] = [0, 1].map(|next| starts[a.index() + next] as usize);
                let found = neighbours[start..end].partition_point(|pair| pair.1 < b);
                *place = (start + found) as u32;
            });
        };
        lists.each_mut().par_iter_mut().enumerate().with_min_len(GRAIN_BLOCKS).for_each(place);
    }

    /// The distinct tetrahedra, ascending, and the place of each.
    fn number_tets(&mut self, blocks: &BlockSet) {
        self.slot_of.clear();
        self.slot_of.resize_with(blocks.tets.len(), || AtomicU32::new(u32::MAX));
        let slot_of = &self.slot_of;
        let mark = |list: &BlockPairs| list.mark(|tet| slot_of[tet.index()].store(0, Ordering::Relaxed));
        self.pairs = self.lists.each().par_iter().with_min_len(GRAIN_BLOCKS).map(mark).sum();
        self.tets.clear();
        self.slot_start.clear();
        for block in blocks.ids() {
            self.slot_start.push(self.tets.len() as u32);
            for tet in blocks.tets_of(block) {
                let slot = self.slot_of[tet].get_mut();
                if *slot == 0 {
                    *slot = self.tets.len() as u32;
                    self.tets.push(TetId(tet as u32));
                }
            }
        }
        self.slot_start.push(self.tets.len() as u32);
        self.order.clear();
        self.order.extend(self.tets.iter().map(|tet| {
            let mut order = [0, 1, 2, 3];
            order.sort_unstable_by_key(|&i: &u8| blocks.tets[tet.index()][usize::from(i)]);
            order
        }));
    }
}
