//! Pairs near contact, found and kept block by block.

use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, BlockSet, TetId, TriangleId};

use crate::broad_phase::block_pairs::{BlockPairs, Runs};
use crate::broad_phase::pair_run::PairRun;
use crate::broad_phase::tet_faces::TetFaces;

/// The pairs of all blocks, by the block of the triangle; each block's are sorted by (triangle, tetrahedron).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PairLists {
    of_block: Vec<BlockPairs>,
    /// Whether each pair is a run of its own.
    pub(super) by_element: bool,
}

impl PairLists {
    /// Begins anew, with no pairs of so many blocks.
    pub fn begin(&mut self, blocks: usize) {
        self.of_block.clear();
        self.of_block.resize_with(blocks, BlockPairs::default);
    }

    /// Puts these pairs, sorted, in the place of all.
    pub fn set(&mut self, blocks: &BlockSet, pairs: &[(TriangleId, TetId)]) {
        self.of_block.resize_with(blocks.len(), BlockPairs::default);
        let owner = |pair: &(TriangleId, TetId)| blocks.triangle_block[pair.0.index()];
        let (by_element, mut runs, mut rest) = (self.by_element, Vec::new(), pairs);
        for (own, list) in blocks.ids().zip(&mut self.of_block) {
            let count = rest.partition_point(|pair| owner(pair) <= own);
            let (here, others) = rest.split_at(count);
            runs.clear();
            add_runs(&mut runs, here, blocks, by_element);
            list.set(&runs, blocks, own);
            rest = others;
        }
    }

    /// The pairs of a block's triangles.
    #[inline]
    pub(super) fn of(&self, block: BlockId) -> Runs<'_> {
        self.of_block.get(block.index()).map_or(Runs::NONE, BlockPairs::runs)
    }

    /// Keeps the pairs of these blocks, the contactor's and the target's, only.
    pub(super) fn keep(&mut self, is_kept: impl Fn(BlockId, BlockId) -> bool, blocks: &BlockSet) {
        let mut kept = Vec::new();
        for (own, list) in blocks.ids().zip(&mut self.of_block) {
            let is_kept = |run: &PairRun| is_kept(own, blocks.tet_block[run.first.index()]);
            kept.clear();
            kept.extend(list.runs().filter(is_kept));
            if kept.len() < list.len() {
                list.set(&kept, blocks, own);
            }
        }
    }

    /// The lists of all blocks, to be changed each by itself.
    pub(super) fn each_mut(&mut self) -> &mut [BlockPairs] {
        &mut self.of_block
    }

    /// The lists of all blocks.
    pub(super) fn each(&self) -> &[BlockPairs] {
        &self.of_block
    }

    /// All pairs, sorted.
    pub fn pairs(&self) -> impl Iterator<Item = (TriangleId, TetId)> + '_ {
        let of_run = |run: PairRun| run.tets().map(move |tet| (run.triangle, tet));
        self.of_block.iter().flat_map(BlockPairs::runs).flat_map(of_run)
    }

    /// Memory on the heap [B].
    pub(crate) fn heap_bytes(&self) -> usize {
        let lists = self.of_block.iter().map(BlockPairs::heap_bytes).sum::<usize>();
        lists + self.of_block.capacity() * size_of::<BlockPairs>()
    }
}

/// Adds runs of the sorted pairs of one block.
fn add_runs(runs: &mut Vec<PairRun>, pairs: &[(TriangleId, TetId)], blocks: &BlockSet, by_element: bool) {
    let target = |tet: TetId| blocks.tet_block[tet.index()];
    for &(triangle, tet) in pairs {
        let is_next =
            |run: &&mut PairRun| !by_element && run.triangle == triangle && target(run.first) == target(tet);
        if !runs.last_mut().filter(is_next).is_some_and(|run| run.takes(tet)) {
            runs.push(PairRun::one(triangle, tet));
        }
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
    /// The faces of these tetrahedra, once a triangle is compared with them.
    pub(super) faces: Vec<TetFaces>,
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

    /// Puts the fresh pairs in the place of those of a block's list that are `is_stale`, and says whether that changed the list.
    pub(super) fn merge_into(
        &mut self,
        list: &mut BlockPairs,
        is_stale: impl Fn(&PairRun) -> bool,
        blocks: &BlockSet,
        own: BlockId,
    ) -> bool {
        self.runs.sort_unstable_by_key(PairRun::key);
        let changed = !list.runs().filter(|run| is_stale(run)).eq(self.runs.iter().copied());
        if changed {
            let fresh = self.runs.len();
            self.runs.extend(list.runs().filter(|run| !is_stale(run)));
            if self.runs.len() > fresh {
                self.runs.sort_unstable_by_key(PairRun::key);
            }
            list.set(&self.runs, blocks, own);
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
