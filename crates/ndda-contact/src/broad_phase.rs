//! Which boxes touch: the definition.

use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, TetId, TriangleId};

/// Boxes of triangles and tetrahedra with their owners; the slices are as long as the ids go.
#[derive(Clone, Copy, Debug)]
pub struct Boxes<'a> {
    /// Box of each boundary triangle.
    pub triangles: &'a [Aabb],
    /// Its block.
    pub triangle_block: &'a [BlockId],
    /// Box of each tetrahedron.
    pub tets: &'a [Aabb],
    /// Its block.
    pub tet_block: &'a [BlockId],
    /// Box of each block.
    pub blocks: &'a [Aabb],
}

/// Finds the pairs of a boundary triangle and a tetrahedron of another block whose boxes touch.
///
/// Contract (checked by [`check_broad_phase`](crate::testing::check_broad_phase)): `pairs` holds every such pair of
/// `AllPairs`, each once, and no other.
pub trait BroadPhase: Send {
    /// Replaces `pairs` by the touching pairs, in any order.
    fn find_pairs(&mut self, boxes: &Boxes, pairs: &mut Vec<(TriangleId, TetId)>);
}

/// The definition, in O(triangles × tetrahedra); oracle of tests and baseline of benches.
#[derive(Clone, Copy, Debug, Default)]
pub struct AllPairs;

impl BroadPhase for AllPairs {
    fn find_pairs(&mut self, boxes: &Boxes, pairs: &mut Vec<(TriangleId, TetId)>) {
        pairs.clear();
        for (i, triangle) in boxes.triangles.iter().enumerate() {
            for (j, tet) in boxes.tets.iter().enumerate() {
                if boxes.triangle_block[i] != boxes.tet_block[j] && triangle.touches(tet) {
                    pairs.push((TriangleId(i as u32), TetId(j as u32)));
                }
            }
        }
    }
}
