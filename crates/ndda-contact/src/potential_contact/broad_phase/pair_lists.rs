//! Pairs near contact, compact: a triangle and up to 32 tetrahedra of one block, found and kept block by block.

use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, BlockSet, TetId, TriangleId};

/// Tetrahedra that one run can have.
const MOST_TETS: u32 = u32::BITS;
/// Room for runs of pairs that a list has beyond what it needs, at least.
const LEAST_ROOM: usize = 4;

/// A boundary triangle and those of 32 tetrahedra in a row, all of one block, that it may be in.
#[derive(Clone, Copy, Debug)]
pub struct PairRun {
    /// The contactor's triangle.
    pub triangle: TriangleId,
    /// The first tetrahedron.
    first: TetId,
    /// Bit i stands for the i-th tetrahedron from the first.
    bits: u32,
    /// Place of both blocks in [`Candidates::neighbours`](crate::broad_phase::Candidates::neighbours).
    pub(super) neighbours: u32,
}

impl PartialEq for PairRun {
    /// Whether the pairs are the same.
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key() && self.bits == other.bits
    }
}

impl PairRun {
    /// One pair.
    pub(super) fn one(triangle: TriangleId, tet: TetId) -> Self {
        Self { triangle, first: tet, bits: 1, neighbours: 0 }
    }

    /// The first tetrahedron; the others are of the same block.
    #[inline]
    pub fn first(&self) -> TetId {
        self.first
    }

    /// Number of pairs.
    #[inline]
    pub(super) fn pairs(&self) -> usize {
        self.bits.count_ones() as usize
    }

    /// Key by which runs are sorted; pairs are then sorted as well.
    #[inline]
    pub(super) fn key(&self) -> (TriangleId, TetId) {
        (self.triangle, self.first)
    }

    /// The tetrahedra, ascending.
    #[inline]
    pub fn tets(&self) -> impl Iterator<Item = TetId> + use<> {
        let (first, mut bits) = (self.first.0, self.bits);
        std::iter::from_fn(move || {
            let next = (bits != 0).then(|| TetId(first + bits.trailing_zeros()));
            bits &= bits.wrapping_sub(1);
            next
        })
    }

    /// Takes a later tetrahedron of the same block in, if there is room for it.
    #[inline]
    pub(super) fn takes(&mut self, tet: TetId) -> bool {
        let place = tet.0 - self.first.0;
        self.bits |= 1u32.checked_shl(place).unwrap_or(0);
        place < MOST_TETS
    }
}

/// The pairs of all blocks, by the block of the triangle; each block's are sorted by (triangle, tetrahedron).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PairLists {
    of_block: Vec<Vec<PairRun>>,
    /// Whether each pair is a run of its own.
    pub(super) by_element: bool,
}

impl PairLists {
    /// Begins anew, with no pairs of so many blocks.
    pub fn begin(&mut self, blocks: usize) {
        self.of_block.clear();
        self.of_block.resize_with(blocks, Vec::new);
    }

    /// Puts these pairs, sorted, in the place of all.
    pub fn set(&mut self, blocks: &BlockSet, pairs: &[(TriangleId, TetId)]) {
        self.begin(blocks.len());
        let target = |tet: TetId| blocks.tet_block[tet.index()];
        let by_element = self.by_element;
        for &(triangle, tet) in pairs {
            let runs = &mut self.of_block[blocks.triangle_block[triangle.index()].index()];
            let is_next = |run: &&mut PairRun| {
                !by_element && run.triangle == triangle && target(run.first) == target(tet)
            };
            if !runs.last_mut().filter(is_next).is_some_and(|run| run.takes(tet)) {
                runs.push(PairRun::one(triangle, tet));
            }
        }
    }

    /// The pairs of a block's triangles.
    #[inline]
    pub fn of(&self, block: BlockId) -> &[PairRun] {
        self.of_block.get(block.index()).map_or(&[], Vec::as_slice)
    }

    /// Keeps the pairs of these blocks, the contactor's and the target's, only.
    pub(super) fn keep(&mut self, is_kept: impl Fn(BlockId, BlockId) -> bool, blocks: &BlockSet) {
        for (own, runs) in blocks.ids().zip(&mut self.of_block) {
            runs.retain(|run| is_kept(own, blocks.tet_block[run.first.index()]));
        }
    }

    /// The lists of all blocks, to be changed each by itself.
    pub(super) fn each_mut(&mut self) -> &mut [Vec<PairRun>] {
        &mut self.of_block
    }

    /// The lists of all blocks.
    pub(super) fn each(&self) -> &[Vec<PairRun>] {
        &self.of_block
    }

    /// All pairs, sorted.
    pub fn pairs(&self) -> impl Iterator<Item = (TriangleId, TetId)> + '_ {
        let of_run = |run: &PairRun| {
            let triangle = run.triangle;
            run.tets().map(move |tet| (triangle, tet))
        };
        self.of_block.iter().flatten().flat_map(of_run)
    }

    /// Memory on the heap [B].
    pub(crate) fn heap_bytes(&self) -> usize {
        let runs = self.of_block.iter().map(Vec::capacity).sum::<usize>();
        runs * size_of::<PairRun>() + self.of_block.capacity() * size_of::<Vec<PairRun>>()
    }
}

/// Room for so many more; where there is too little, for a quarter more, so that blocks that come a bit nearer
/// do not ask again.
fn make_room(list: &mut Vec<PairRun>, more: usize) {
    let needed = list.len() + more;
    if list.capacity() < needed {
        list.reserve_exact(more + needed / 4 + LEAST_ROOM);
    }
}

/// Pairs with a renewed block, on either side: scratch memory of a thread for one block.
#[derive(Default)]
pub(super) struct Fresh {
    pub(super) runs: Vec<PairRun>,
    /// Tetrahedra near one triangle.
    pub(super) tets: Vec<TetId>,
    pub(super) by_element: bool,
    /// Boxes of the block's triangles, and of the tetrahedra of another one, where they have no trees.
    pub(super) triangles: Vec<Aabb>,
    pub(super) boxes: Vec<Aabb>,
}

impl Fresh {
    /// Adds the pairs of a triangle with the tetrahedra of one block.
    pub(super) fn take_tets(&mut self, triangle: TriangleId) {
        self.tets.sort_unstable();
        let start = self.runs.len();
        for &tet in &self.tets {
            if self.by_element || !self.runs[start..].last_mut().is_some_and(|run| run.takes(tet)) {
                self.runs.push(PairRun::one(triangle, tet));
            }
        }
        self.tets.clear();
    }

    /// Puts the fresh pairs in the place of those that `is_stale`, and says whether that changed the list.
    pub(super) fn merge_into(
        &mut self,
        list: &mut Vec<PairRun>,
        is_stale: impl Fn(&PairRun) -> bool,
    ) -> bool {
        self.runs.sort_unstable_by_key(PairRun::key);
        let changed = !list.iter().filter(|run| is_stale(run)).eq(&self.runs);
        if changed {
            list.retain(|run| !is_stale(run));
            make_room(list, self.runs.len());
            list.extend_from_slice(&self.runs);
            list.sort_unstable_by_key(PairRun::key);
        }
        changed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{test_box, test_set};

    #[test]
    fn lists_give_back_the_pairs_that_were_put_in() {
        let small = || test_box([0.0; 3], [1.0; 3], [1, 1, 1]);
        let blocks = test_set(vec![small(), test_box([0.0; 3], [1.0; 3], [3, 3, 3]), small()]);
        // Every third tetrahedron of the large block and all that follow it, for two triangles of each block.
        let mut pairs = Vec::new();
        for block in blocks.ids() {
            for triangle in blocks.triangles_of(block).take(2) {
                let others = (0..blocks.tets.len()).filter(|&tet| {
                    blocks.tet_block[tet] != block && (blocks.tet_block[tet] != BlockId(1) || tet % 3 == 0)
                });
                pairs.extend(others.map(|tet| (TriangleId(triangle as u32), TetId(tet as u32))));
            }
        }
        let mut lists = PairLists::default();
        lists.set(&blocks, &pairs);
        assert_eq!(lists.pairs().collect::<Vec<_>>(), pairs);
        for block in blocks.ids() {
            for run in lists.of(block) {
                let of_tets = |tet: TetId| blocks.tet_block[tet.index()];
                assert!(run.tets().all(|tet| of_tets(tet) == of_tets(run.first())));
                assert_eq!(run.tets().count(), run.pairs());
            }
        }
    }
}
