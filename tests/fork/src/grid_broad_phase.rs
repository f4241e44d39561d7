//! A broad phase by a grid: blocks are compared when their boxes share a cell.

use std::collections::HashMap;

use ndda_contact::broad_phase::{BroadPhase, BroadScene, PairLists};
use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, TetId, TriangleId};

/// Cells as wide as the largest block; nothing is kept from one call to the next.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    found: Vec<(TriangleId, TetId)>,
}

impl Grid {
    /// Pairs of blocks, first and second in any order, whose boxes touch; each block with itself, too.
    fn neighbours(scene: &BroadScene) -> Vec<(BlockId, BlockId)> {
        let boxes: Vec<Aabb> = scene.blocks.ids().map(|block| scene.block_box(block)).collect();
        let width = boxes.iter().map(|b| (b.max - b.min).max()).fold(0.0, f64::max);
        let width = if width > 0.0 { width } else { 1.0 };
        let cells = |around: &Aabb| {
            let [low, high] =
                [around.min, around.max].map(|x| [0, 1, 2].map(|k| (x[k] / width).floor() as i64));
            let along = move |k: usize| low[k]..=high[k];
            along(0).flat_map(move |x| along(1).flat_map(move |y| along(2).map(move |z| [x, y, z])))
        };
        let mut in_cell: HashMap<[i64; 3], Vec<BlockId>> = HashMap::new();
        let mut pairs = Vec::new();
        for (block, around) in scene.blocks.ids().zip(&boxes) {
            pairs.push((block, block));
            for cell in cells(around) {
                let there = in_cell.entry(cell).or_default();
                let touching = there.iter().filter(|other| boxes[other.index()].touches(around));
                pairs.extend(touching.flat_map(|&other| [(block, other), (other, block)]));
                there.push(block);
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }
}

impl BroadPhase for Grid {
    fn name(&self) -> &'static str {
        "a grid"
    }

    fn find_pairs(&mut self, scene: &BroadScene, _renewed: &[BlockId], pairs: &mut PairLists) -> bool {
        self.found.clear();
        for (own, target) in Self::neighbours(scene) {
            for triangle in scene.blocks.triangles_of(own) {
                let Some(contactor) = scene.contactor_box(triangle, target) else { continue };
                let meets = |tet: &usize| {
                    contactor.touches(&scene.tet_box(*tet))
                        && !(own == target && scene.are_neighbours(triangle, *tet))
                };
                let tets = scene.blocks.tets_of(target).filter(meets);
                self.found.extend(tets.map(|tet| (TriangleId(triangle as u32), TetId(tet as u32))));
            }
        }
        self.found.sort_unstable();
        let changed = !pairs.pairs().eq(self.found.iter().copied());
        pairs.set(scene.blocks, &self.found);
        changed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_contact::broad_phase::testing::check_broad_phase;

    #[test]
    fn it_keeps_the_contract_of_a_broad_phase() {
        check_broad_phase(Grid::default);
    }

    /// Forgets the last pair.
    #[derive(Default)]
    struct Forgetful(Grid);

    impl BroadPhase for Forgetful {
        fn name(&self) -> &'static str {
            "forgetful"
        }

        fn find_pairs(&mut self, scene: &BroadScene, renewed: &[BlockId], pairs: &mut PairLists) -> bool {
            let before = pairs.clone();
            self.0.find_pairs(scene, renewed, pairs);
            let mut all: Vec<_> = pairs.pairs().collect();
            all.pop();
            pairs.set(scene.blocks, &all);
            before != *pairs
        }
    }

    #[test]
    #[should_panic(expected = "overlap and are not in the list")]
    fn a_pair_that_is_missed_is_found_out() {
        check_broad_phase(Forgetful::default);
    }
}
