//! Which triangles may be in which tetrahedra: the seam, and its definition.

use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, BlockSet, NodeId, TetId, TriangleId, Vec3};

/// Blocks where they are.
#[derive(Clone, Copy, Debug)]
pub struct BroadScene<'a> {
    /// Topology and rest shape.
    pub blocks: &'a BlockSet,
    /// Position of each node [m].
    pub position: &'a [Vec3],
    /// How far a node may move while the answer is in use [m].
    pub margin_m: f64,
}

impl BroadScene<'_> {
    /// Box around nodes, with the margin.
    pub fn box_around(&self, nodes: &[NodeId]) -> Aabb {
        Aabb::around(nodes.iter().map(|n| &self.position[n.index()])).inflated(self.margin_m)
    }

    /// Box around a block, with the margin.
    pub fn block_box(&self, block: BlockId) -> Aabb {
        Aabb::around(&self.position[self.blocks.nodes_of(block)]).inflated(self.margin_m)
    }

    /// Whether the boxes of a triangle and a tetrahedron, with their margins, touch.
    pub fn boxes_touch(&self, triangle: usize, tet: usize) -> bool {
        let triangle = self.box_around(&self.blocks.triangles[triangle]);
        triangle.touches(&self.box_around(&self.blocks.tets[tet]))
    }

    /// Whether a triangle and a tetrahedron of one block are too near each other at rest to be contact later: they
    /// share a node, or are no further apart than they are large.
    pub fn are_neighbours(&self, triangle: usize, tet: usize) -> bool {
        let rest = |nodes: &[NodeId]| {
            let around = Aabb::around(nodes.iter().map(|n| &self.blocks.rest_position[n.index()]));
            around.inflated(0.5 * around.diagonal())
        };
        rest(&self.blocks.triangles[triangle]).touches(&rest(&self.blocks.tets[tet]))
    }
}

/// Finds the pairs of a boundary triangle and a tetrahedron that may overlap before a node has moved by the margin.
///
/// Contract (checked by [`check_broad_phase`](crate::testing::check_broad_phase)): no such pair of two blocks is
/// missed, nor one of two far parts of a concave block; each pair comes once, and neighbours in one block never.
pub trait BroadPhase: Send {
    /// Replaces `pairs`, in any order.
    fn find_pairs(&mut self, scene: &BroadScene, pairs: &mut Vec<(TriangleId, TetId)>);
}

/// The definition, in O(triangles × tetrahedra); oracle of tests and baseline of benches.
#[derive(Clone, Copy, Debug, Default)]
pub struct AllPairs;

impl BroadPhase for AllPairs {
    fn find_pairs(&mut self, scene: &BroadScene, pairs: &mut Vec<(TriangleId, TetId)>) {
        pairs.clear();
        let blocks = scene.blocks;
        for i in 0..blocks.triangles.len() {
            for j in 0..blocks.tets.len() {
                let one_block = blocks.triangle_block[i] == blocks.tet_block[j];
                if scene.boxes_touch(i, j) && !(one_block && scene.are_neighbours(i, j)) {
                    pairs.push((TriangleId(i as u32), TetId(j as u32)));
                }
            }
        }
    }
}
