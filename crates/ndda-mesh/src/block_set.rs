//! All blocks of a scene: constant topology and rest shape, as structs of arrays.

mod builder;

use std::collections::BTreeMap;
use std::ops::Range;

use crate::geometry::barycentric;
use crate::node_sets::NodeSets;
use crate::{BlockId, BlockMesh, MeshError, NodeId, TetId, TriangleId, Vec3};

pub use builder::BlockSetBuilder;

/// All blocks of a scene. Blocks share nothing; each owns a contiguous range of every array.
#[derive(Clone, Debug)]
pub struct BlockSet {
    /// Name of each block.
    pub names: Vec<String>,
    /// Rest position per node [m], relative to [`origin_m`](Self::origin_m).
    pub rest_position: Vec<Vec3>,
    /// Node indices per tetrahedron, positive volume.
    pub tets: Vec<[NodeId; 4]>,
    /// Node indices per boundary triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[NodeId; 3]>,
    /// The tetrahedron behind each boundary triangle.
    pub triangle_tet: Vec<TetId>,
    /// The block of each tetrahedron.
    pub tet_block: Vec<BlockId>,
    /// The block of each boundary triangle.
    pub triangle_block: Vec<BlockId>,
    /// The named part of its block's surface that each boundary triangle is in, as an index in `surface_names`.
    pub triangle_surface: Vec<Option<u32>>,
    /// Names of parts of surfaces, of joints for instance.
    pub surface_names: Vec<String>,
    /// Vector that was subtracted from every coordinate so that map coordinates keep their digits [m].
    pub origin_m: Vec3,
    node_sets: NodeSets,
    node_start: Vec<u32>,
    tet_start: Vec<u32>,
    triangle_start: Vec<u32>,
}

impl BlockSet {
    /// Joins blocks into one set after checking each of them.
    ///
    /// Scenes far from the origin are shifted by [`origin_m`](Self::origin_m), a multiple of a power of two
    /// at least as large as the scene, so that the shift itself rounds nothing that the input had.
    ///
    /// # Errors
    /// All that [`validate::problems`] finds, with the name of the block.
    pub fn new(blocks: Vec<(String, BlockMesh)>) -> Result<Self, MeshError> {
        let mut builder = BlockSetBuilder::default();
        let sum = |of: fn(&BlockMesh) -> usize| blocks.iter().map(|(_, mesh)| of(mesh)).sum::<usize>();
        builder.make_room(blocks.len(), sum(|mesh| mesh.nodes.len()), sum(|mesh| mesh.tets.len()));
        for (name, mesh) in blocks {
            builder.push(name, &mesh);
        }
        builder.finish()
    }

    /// Number of blocks.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Whether the set holds no block.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// All block ids in order.
    pub fn ids(&self) -> impl Iterator<Item = BlockId> + use<> {
        (0..self.len() as u32).map(BlockId)
    }

    /// The block of that name.
    pub fn find(&self, name: &str) -> Option<BlockId> {
        self.names.iter().position(|n| n == name).map(|i| BlockId(i as u32))
    }

    /// Range of a block's nodes in per-node arrays.
    pub fn nodes_of(&self, block: BlockId) -> Range<usize> {
        range(&self.node_start, block)
    }

    /// Range of a block's tetrahedra in per-tetrahedron arrays.
    pub fn tets_of(&self, block: BlockId) -> Range<usize> {
        range(&self.tet_start, block)
    }

    /// Range of a block's boundary triangles in per-triangle arrays.
    pub fn triangles_of(&self, block: BlockId) -> Range<usize> {
        range(&self.triangle_start, block)
    }

    /// Named node sets of a block, by rising name.
    pub fn node_sets_of(&self, block: BlockId) -> impl Iterator<Item = (&str, &[NodeId])> {
        self.node_sets.of_block(block)
    }

    /// Named parts of a block's surface, as in [`BlockMesh::surfaces`].
    pub fn surfaces_of(&self, block: BlockId) -> BTreeMap<String, Vec<[u32; 3]>> {
        let first = self.node_start[block.index()];
        let mut surfaces: BTreeMap<String, Vec<[u32; 3]>> = BTreeMap::new();
        for triangle in self.triangles_of(block) {
            let Some(surface) = self.triangle_surface[triangle] else { continue };
            let mut nodes = self.triangles[triangle].map(|n| n.0 - first);
            nodes.sort_unstable();
            surfaces.entry(self.surface_names[surface as usize].clone()).or_default().push(nodes);
        }
        surfaces
    }

    /// The block that a node belongs to.
    pub fn block_of(&self, node: NodeId) -> BlockId {
        BlockId(self.node_starts().partition_point(|&start| start <= node.0) as u32 - 1)
    }

    /// First node of each block, and the node count at the end (`len() + 1` entries).
    pub fn node_starts(&self) -> &[u32] {
        &self.node_start
    }

    /// The tetrahedra of a block with indices that count from the block's first node.
    pub fn local_tets(&self, block: BlockId) -> impl Iterator<Item = [u32; 4]> + '_ {
        let first = self.node_start[block.index()];
        self.tets[self.tets_of(block)].iter().map(move |tet| tet.map(|n| n.0 - first))
    }

    /// Corner positions of a tetrahedron [m], `position` being per node.
    pub fn tet_corners(&self, tet: TetId, position: &[Vec3]) -> [Vec3; 4] {
        self.tets[tet.index()].map(|n| position[n.index()])
    }

    /// The tetrahedron of a block, as drawn, in which a point lies deepest, and the point's barycentric coordinates there, the least of which is negative outside of
    /// the block. None where no tetrahedron has a volume.
    pub fn deepest_tet(&self, block: BlockId, point: &Vec3) -> Option<(TetId, [f64; 4])> {
        let mut best = (f64::NEG_INFINITY, None);
        for tet in self.tets_of(block).map(|tet| TetId(tet as u32)) {
            let Some(weights) = barycentric(&self.tet_corners(tet, &self.rest_position), point) else {
                continue;
            };
            let depth = weights.iter().copied().fold(f64::INFINITY, f64::min);
            if depth > best.0 {
                best = (depth, Some((tet, weights)));
            }
        }
        best.1
    }

    /// Corner positions of a boundary triangle [m], `position` being per node.
    #[inline]
    pub fn triangle_corners(&self, triangle: TriangleId, position: &[Vec3]) -> [Vec3; 3] {
        self.triangles[triangle.index()].map(|n| position[n.index()])
    }
}

fn range(starts: &[u32], block: BlockId) -> Range<usize> {
    starts[block.index()] as usize..starts[block.index() + 1] as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner_tet(at: f64) -> BlockMesh {
        let corners = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)];
        let nodes = corners.map(|(x, y, z)| Vec3::new(at + x, y, z)).to_vec();
        BlockMesh { nodes, tets: vec![[0, 1, 2, 3]], ..BlockMesh::default() }
    }

    #[test]
    fn blocks_own_contiguous_ranges() {
        let set = BlockSet::new(vec![("a".into(), corner_tet(0.0)), ("b".into(), corner_tet(2.0))]).unwrap();
        assert_eq!(set.nodes_of(BlockId(1)), 4..8);
        assert_eq!(set.triangles_of(BlockId(1)), 4..8);
        assert_eq!(set.tets[1][0], NodeId(4));
        assert_eq!(set.origin_m, Vec3::zeros());
        assert_eq!(set.find("b"), Some(BlockId(1)));
    }

    #[test]
    fn a_scene_in_map_coordinates_is_moved_near_the_origin_exactly() {
        let set = BlockSet::new(vec![("a".into(), corner_tet(4.5e6))]).unwrap();
        assert!((set.origin_m.x - 4.5e6).abs() <= 2.0);
        assert_eq!(set.rest_position[1] - set.rest_position[0], Vec3::x());
    }
}
