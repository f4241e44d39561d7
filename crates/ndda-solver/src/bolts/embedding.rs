//! Where a bolt runs: the blocks along its line, and points of it in their tetrahedra.

use ndda_mesh::geometry::{Aabb, barycentric};
use ndda_mesh::{BlockId, BlockSet, TetId, Vec3};

/// Pieces shorter than this part of the bolt are none: the line grazes an edge there.
const SHORT: f64 = 1e-6;

/// A straight piece of a bolt in one block, by distances from its head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Portion {
    /// The block.
    pub block: BlockId,
    /// Where it begins [m].
    pub from_m: f64,
    /// Where it ends [m].
    pub to_m: f64,
}

/// Distance from a point along a line at which it first meets a block that is there [m]; none where it meets none.
pub fn first_rock_m(
    blocks: &BlockSet,
    is_there: impl Fn(BlockId) -> bool,
    from_m: &Vec3,
    to_m: &Vec3,
) -> Option<f64> {
    let line = Line { from_m: *from_m, to_m: *to_m };
    let around = Aabb::around([from_m, to_m]);
    let near =
        |block: &BlockId| Aabb::around(&blocks.rest_position[blocks.nodes_of(*block)]).touches(&around);
    let tets =
        blocks.ids().filter(|block| is_there(*block) && near(block)).flat_map(|block| blocks.tets_of(block));
    let meets =
        tets.filter_map(|tet| line.inside(&blocks.tet_corners(TetId(tet as u32), &blocks.rest_position)));
    meets.map(|(enters_m, _)| enters_m).min_by(f64::total_cmp)
}

/// A point that moves with a tetrahedron.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Anchor {
    /// The tetrahedron's nodes.
    pub nodes: [u32; 4],
    /// Barycentric coordinates.
    pub weights: [f64; 4],
}

impl Anchor {
    /// Where it is when nodes are at `position` [m].
    pub(crate) fn place(&self, position: &[Vec3]) -> Vec3 {
        let mut sum = Vec3::zeros();
        for (node, weight) in self.nodes.iter().zip(self.weights) {
            sum += weight * position[*node as usize];
        }
        sum
    }
}

/// A straight line from `from_m` to `to_m`, in the coordinates of the blocks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    /// Head [m].
    pub from_m: Vec3,
    /// End [m].
    pub to_m: Vec3,
}

impl Line {
    pub(crate) fn length_m(&self) -> f64 {
        (self.to_m - self.from_m).norm()
    }

    /// The point at a distance from the head [m].
    pub(crate) fn at(&self, along_m: f64) -> Vec3 {
        self.from_m + (along_m / self.length_m()) * (self.to_m - self.from_m)
    }

    /// The distances between which it is in a tetrahedron [m]; none where it is not.
    fn inside(&self, corners: &[Vec3; 4]) -> Option<(f64, f64)> {
        let (start, end) = (barycentric(corners, &self.from_m)?, barycentric(corners, &self.to_m)?);
        let (mut enters, mut leaves) = (0.0f64, 1.0f64);
        for (a, b) in start.into_iter().zip(end) {
            if a < 0.0 && b < 0.0 {
                return None;
            }
            if a < 0.0 {
                enters = enters.max(a / (a - b));
            } else if b < 0.0 {
                leaves = leaves.min(a / (a - b));
            }
        }
        let length_m = self.length_m();
        (enters < leaves).then_some((enters * length_m, leaves * length_m))
    }

    /// Its pieces in the blocks that are there, in order.
    ///
    /// # Errors
    /// The two blocks in whose contact face it runs, or that overlap along it.
    pub(crate) fn portions(
        &self,
        blocks: &BlockSet,
        absent: &[BlockId],
    ) -> Result<Vec<Portion>, (BlockId, BlockId)> {
        let (mut found, short_m) = (Vec::new(), SHORT * self.length_m());
        let around = Aabb::around(&[self.from_m, self.to_m]).inflated(short_m);
        for block in blocks.ids().filter(|block| absent.binary_search(block).is_err()) {
            if Aabb::around(&blocks.rest_position[blocks.nodes_of(block)]).touches(&around) {
                self.add_portions(blocks, block, short_m, &mut found);
            }
        }
        let by_place = |a: &Portion, b: &Portion| a.from_m.total_cmp(&b.from_m).then(a.block.cmp(&b.block));
        found.sort_by(by_place);
        for k in 1..found.len() {
            let (before, after) = (found[k - 1], found[k]);
            let shorter_m = (before.to_m - before.from_m).min(after.to_m - after.from_m);
            let common_m = before.to_m.min(after.to_m) - after.from_m;
            if common_m > 0.1 * shorter_m {
                return Err((before.block, after.block));
            }
            if common_m > 0.0 {
                let middle_m = after.from_m + 0.5 * common_m;
                (found[k - 1].to_m, found[k].from_m) = (middle_m, middle_m);
            }
        }
        Ok(found)
    }

    fn add_portions(&self, blocks: &BlockSet, block: BlockId, short_m: f64, found: &mut Vec<Portion>) {
        let spans = blocks
            .tets_of(block)
            .filter_map(|tet| self.inside(&blocks.tet_corners(TetId(tet as u32), &blocks.rest_position)));
        let mut spans: Vec<(f64, f64)> = spans.collect();
        spans.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut pieces: Vec<Portion> = Vec::new();
        for (from_m, to_m) in spans {
            match pieces.last_mut() {
                Some(last) if from_m <= last.to_m + short_m => last.to_m = last.to_m.max(to_m),
                _ => pieces.push(Portion { block, from_m, to_m }),
            }
        }
        found.extend(pieces.into_iter().filter(|piece| piece.to_m - piece.from_m > short_m));
    }

    /// The point at a distance from the head, in that tetrahedron of a block in which it lies deepest.
    pub(crate) fn anchor(&self, blocks: &BlockSet, block: BlockId, along_m: f64) -> Anchor {
        match blocks.deepest_tet(block, &self.at(along_m)) {
            Some((tet, weights)) => Anchor { nodes: blocks.tets[tet.index()].map(|node| node.0), weights },
            None => Anchor { nodes: [0; 4], weights: [0.25; 4] },
        }
    }
}

#[cfg(test)]
mod tests {
    use ndda_mesh::generate::{BoxPattern, box_block};

    use super::*;

    fn two_boxes(gap_m: f64) -> BlockSet {
        let lower = box_block([1.0; 3], [2, 3, 2], BoxPattern::Six).expect("sound");
        let mut upper = box_block([1.0, 1.0, 0.5], [1, 1, 2], BoxPattern::Six).expect("sound");
        upper.nodes.iter_mut().for_each(|x| x.z += 1.0 + gap_m);
        BlockSet::new(vec![("lower".into(), lower), ("upper".into(), upper)]).expect("sound")
    }

    #[test]
    fn a_line_is_in_each_block_where_it_should_be() {
        let blocks = two_boxes(0.1);
        let line = Line { from_m: Vec3::new(0.31, 0.42, 2.0), to_m: Vec3::new(0.31, 0.42, 0.25) };
        let found = line.portions(&blocks, &[]).expect("no overlap");
        assert_eq!(found.iter().map(|p| p.block.0).collect::<Vec<_>>(), [1, 0]);
        for (portion, (from_m, to_m)) in found.iter().zip([(0.4, 0.9), (1.0, 1.75)]) {
            assert!((portion.from_m - from_m).abs() < 1e-12 && (portion.to_m - to_m).abs() < 1e-12);
            for along_m in [from_m, 0.3 * from_m + 0.7 * to_m, to_m] {
                let anchor = line.anchor(&blocks, portion.block, along_m);
                assert!((anchor.place(&blocks.rest_position) - line.at(along_m)).norm() < 1e-12);
                assert!(anchor.weights.iter().all(|w| *w > -1e-9));
            }
        }
    }

    #[test]
    fn a_line_along_edges_and_faces_of_tetrahedra_is_found_once() {
        let blocks = two_boxes(0.0);
        let line = Line { from_m: Vec3::new(0.5, 1.0 / 3.0, 1.5), to_m: Vec3::new(0.5, 1.0 / 3.0, 0.0) };
        let found = line.portions(&blocks, &[]).expect("no overlap");
        assert_eq!(found.len(), 2);
        assert!((found[1].from_m - 0.5).abs() < 1e-12 && (found[1].to_m - 1.5).abs() < 1e-12);
    }

    #[test]
    fn a_line_in_the_contact_face_of_two_blocks_is_refused() {
        let blocks = two_boxes(0.0);
        let line = Line { from_m: Vec3::new(0.1, 0.3, 1.0), to_m: Vec3::new(0.9, 0.4, 1.0) };
        assert_eq!(line.portions(&blocks, &[]), Err((BlockId(1), BlockId(0))));
    }
}
