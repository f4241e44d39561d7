//! Which boxes touch: parry3d's bounding volume hierarchy over all tetrahedra.

use ndda_mesh::geometry::Aabb;
use ndda_mesh::{TetId, TriangleId};
use parry3d_f64::bounding_volume::Aabb as ParryAabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode, BvhWorkspace};

use crate::broad_phase::{Boxes, BroadPhase};

/// A tree over the boxes of all tetrahedra, rebuilt in its own memory.
#[derive(Default)]
pub struct BvhBroadPhase {
    tree: Bvh,
    workspace: BvhWorkspace,
    meets: Vec<bool>,
    order: Vec<usize>,
}

impl BroadPhase for BvhBroadPhase {
    fn find_pairs(&mut self, boxes: &Boxes, pairs: &mut Vec<(TriangleId, TetId)>) {
        pairs.clear();
        self.find_meeting_blocks(boxes);
        for (leaf, tet) in boxes.tets.iter().enumerate() {
            self.tree.insert_or_update_partially(to_parry(tet), leaf as u32, 0.0);
        }
        self.tree.rebuild(&mut self.workspace, BvhBuildStrategy::Binned);
        for (i, triangle) in boxes.triangles.iter().enumerate() {
            let owner = boxes.triangle_block[i];
            if !self.meets[owner.index()] {
                continue;
            }
            for leaf in self.tree.leaves(|node| node_touches(node, triangle)) {
                let tet = leaf as usize;
                if boxes.tet_block[tet] != owner && triangle.touches(&boxes.tets[tet]) {
                    pairs.push((TriangleId(i as u32), TetId(leaf)));
                }
            }
        }
    }
}

impl BvhBroadPhase {
    /// Marks blocks whose box touches another's: sorted along x, swept once.
    fn find_meeting_blocks(&mut self, boxes: &Boxes) {
        self.meets.clear();
        self.meets.resize(boxes.blocks.len(), false);
        self.order.clear();
        self.order.extend(0..boxes.blocks.len());
        self.order.sort_unstable_by(|&i, &j| boxes.blocks[i].min.x.total_cmp(&boxes.blocks[j].min.x));
        for (k, &i) in self.order.iter().enumerate() {
            let a = &boxes.blocks[i];
            for &j in self.order[k + 1..].iter().take_while(|&&j| boxes.blocks[j].min.x <= a.max.x) {
                if a.touches(&boxes.blocks[j]) {
                    self.meets[i] = true;
                    self.meets[j] = true;
                }
            }
        }
    }
}

fn to_parry(bounds: &Aabb) -> ParryAabb {
    let vector = |v: &ndda_mesh::Vec3| Vector::new(v.x, v.y, v.z);
    ParryAabb::new(vector(&bounds.min), vector(&bounds.max))
}

fn node_touches(node: &BvhNode, bounds: &Aabb) -> bool {
    let (min, max) = (node.mins(), node.maxs());
    (0..3).all(|i| min[i] <= bounds.max[i] && bounds.min[i] <= max[i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::check_broad_phase;

    #[test]
    fn it_finds_what_all_pairs_finds() {
        check_broad_phase(&mut BvhBroadPhase::default());
    }
}
