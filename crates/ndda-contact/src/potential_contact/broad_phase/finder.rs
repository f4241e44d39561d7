//! Which triangles may be in which tetrahedra: the seam, and its definition.

use ndda_mesh::geometry::{Aabb, triangle_area_vector};
use ndda_mesh::{BlockId, BlockSet, NodeId, TetId, TriangleId, Vec3};

use crate::affine::convex_target::ConvexBlocks;
use crate::affine::face::Face;
use crate::affine::face_contactor::FaceContactor;
use crate::broad_phase::pair_lists::PairLists;
use crate::broad_phase::tet_faces::{TetFaces, outward_normal};

/// Blocks of more nodes are compared by their elements only.
pub(crate) const FEW_NODES: usize = 64;

/// Blocks where they were when they were last looked at.
#[derive(Clone, Copy, Debug)]
pub struct BroadScene<'a> {
    /// Topology and rest shape.
    pub blocks: &'a BlockSet,
    /// Position of each node [m].
    pub position: &'a [Vec3],
    /// How far the nodes of each block may move while the answer is in use [m].
    pub margin_m: &'a [f64],
    /// Which blocks are affine convex targets: the only tetrahedron of these is their host, and stands for all of the block.
    pub hulls: &'a ConvexBlocks,
    /// Which blocks are not there; empty where all are. Pairs with these may be left out: they are taken out afterwards.
    pub absent: &'a [bool],
}

impl BroadScene<'_> {
    /// Whether a block is there.
    #[inline]
    pub fn is_there(&self, block: BlockId) -> bool {
        self.absent.get(block.index()) != Some(&true)
    }

    /// Box around a boundary triangle, with the margin of its block.
    pub(crate) fn triangle_box(&self, triangle: usize) -> Aabb {
        let block = self.blocks.triangle_block[triangle];
        self.around(&self.blocks.triangles[triangle]).inflated(self.margin_m[block.index()])
    }

    /// Box around a boundary triangle as a contactor in another block, or around the face that it stands for there; none where another
    /// triangle stands for that face.
    pub fn contactor_box(&self, triangle: usize, target: BlockId) -> Option<Aabb> {
        let id = TriangleId(triangle as u32);
        match self.hulls.contactors(self.blocks.triangle_block[triangle], target) {
            [] => Some(self.triangle_box(triangle)),
            _ => self.hulls.contactor(id, target).map(|face| self.face_box(face)),
        }
    }

    /// Box around a tetrahedron, or around the block that it stands for, with the margin of its block.
    pub fn tet_box(&self, tet: usize) -> Aabb {
        let block = self.blocks.tet_block[tet];
        match self.hulls.affine_target(block) {
            Some(whole) if whole.host.index() == tet => self.block_box(block),
            Some(_) => Aabb::empty(),
            None => self.around(&self.blocks.tets[tet]).inflated(self.margin_m[block.index()]),
        }
    }

    /// Box around a block, with its margin.
    pub fn block_box(&self, block: BlockId) -> Aabb {
        Aabb::around(&self.position[self.blocks.nodes_of(block)]).inflated(self.margin_m[block.index()])
    }

    /// Box around a face that is put into blocks taken whole, with the margin of its block.
    pub(crate) fn face_box(&self, face: &FaceContactor) -> Aabb {
        let block = self.blocks.triangle_block[face.triangle.index()];
        face.bounds(self.position).inflated(self.margin_m[block.index()])
    }

    /// A triangle, to be compared with tetrahedra of a block.
    pub(crate) fn triangle_at(&self, triangle: usize, other: BlockId) -> TriangleAt {
        let corners = self.blocks.triangle_corners(TriangleId(triangle as u32), self.position);
        let own = self.blocks.triangle_block[triangle];
        let reach_m = self.margin_m[own.index()] + self.margin_m[other.index()];
        TriangleAt { corners, normal: triangle_area_vector(&corners), reach_m }
    }

    fn around(&self, nodes: &[NodeId]) -> Aabb {
        Aabb::around(nodes.iter().map(|n| &self.position[n.index()]))
    }

    /// Whether a triangle and a tetrahedron of one block are too near each other at rest to be contact later: they
    /// share a node, or are no further apart than they are large, or the block moves by affine maps, under which parts that are apart stay so.
    pub fn are_neighbours(&self, triangle: usize, tet: usize) -> bool {
        if self.hulls.keeps_its_shape(self.blocks.tet_block[tet]) {
            return true;
        }
        let rest = |nodes: &[NodeId]| {
            let around = Aabb::around(nodes.iter().map(|n| &self.blocks.rest_position[n.index()]));
            around.inflated(0.5 * around.diagonal())
        };
        rest(&self.blocks.triangles[triangle]).touches(&rest(&self.blocks.tets[tet]))
    }
}

/// A boundary triangle, and how near it is to what it may soon be in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TriangleAt {
    /// Corners [m].
    pub corners: [Vec3; 3],
    /// Area vector [m²].
    normal: Vec3,
    /// Margin of both blocks [m].
    pub reach_m: f64,
}

impl TriangleAt {
    /// Whether a plane of one of them keeps the triangle and a tetrahedron apart by more than both margins: any point of
    /// either, while its nodes stay within the margin, is that near to a point where it is now.
    pub(crate) fn is_apart_from(&self, others: &[Vec3; 4]) -> bool {
        self.are_on_one_side(others)
            || (0..4).any(|face| {
                let (outward, from) = outward_normal(others, face);
                self.are_beyond(&outward, &from, &self.corners)
            })
    }

    /// As [`is_apart_from`](Self::is_apart_from), for a tetrahedron whose face normals have been found before.
    pub(crate) fn is_apart_from_faces(&self, other: &TetFaces) -> bool {
        let TetFaces { corners, faces } = other;
        let is_beyond = |(outward, norm2, from): &(Vec3, f64, Vec3)| {
            self.are_beyond_plane((outward, *norm2), from, &self.corners)
        };
        self.are_on_one_side(corners) || faces.iter().any(is_beyond)
    }

    /// Whether the points are before the triangle's plane or behind it by more than the margin.
    pub(crate) fn are_on_one_side(&self, points: &[Vec3]) -> bool {
        let [first, ..] = &self.corners;
        self.are_beyond(&self.normal, first, points) || self.are_beyond(&-self.normal, first, points)
    }

    /// Whether n·(x − p) > reach |n| for all of the points, without a root.
    fn are_beyond(&self, normal: &Vec3, from: &Vec3, points: &[Vec3]) -> bool {
        self.are_beyond_plane((normal, normal.norm_squared()), from, points)
    }

    /// The test of [`are_beyond`](Self::are_beyond), given n and |n|².
    fn are_beyond_plane(&self, (normal, norm2): (&Vec3, f64), from: &Vec3, points: &[Vec3]) -> bool {
        let least = self.reach_m * self.reach_m * norm2;
        points.iter().map(|x| normal.dot(&(x - from))).all(|d| d > 0.0 && d * d > least)
    }
}

/// A face of a convex block, where the block was when it was last looked at.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Side {
    normal: Vec3,
    point: Vec3,
    /// |n|.
    length: f64,
    /// Largest n·(x − p) of the block.
    furthest: f64,
}

impl Side {
    /// The side of a face.
    pub(crate) fn new(scene: &BroadScene, face: &Face) -> Self {
        let corners = face.corners.map(|n| scene.position[n.index()]);
        let normal = triangle_area_vector(&corners);
        let above = |x: &Vec3| normal.dot(&(x - corners[0]));
        let nodes = &scene.position[scene.blocks.nodes_of(face.block)];
        let furthest = match nodes.len() <= FEW_NODES {
            true => nodes.iter().map(above).fold(0.0, f64::max),
            false if scene.hulls.affine_target(face.block).is_some() => 0.0,
            // It would take longer to know than it saves.
            false => f64::INFINITY,
        };
        Self { normal, point: corners[0], length: normal.norm(), furthest }
    }

    /// Whether the points are beyond the block by more than `reach_m`; then whatever they span stays out of it until the margins
    /// of both are used up.
    #[inline]
    pub(crate) fn is_before(&self, points: &[Vec3], reach_m: f64) -> bool {
        let least = self.furthest + reach_m * self.length;
        points.iter().all(|x| self.normal.dot(&(x - self.point)) > least)
    }
}

/// Numbers of blocks, nodes, tetrahedra and boundary triangles: a set with others is another set.
pub(crate) fn shape_of(blocks: &BlockSet) -> [usize; 4] {
    [blocks.len(), blocks.rest_position.len(), blocks.tets.len(), blocks.triangles.len()]
}

/// Finds the pairs of a boundary triangle and a tetrahedron that may overlap before a node has moved by the margin.
///
/// Contract (checked by [`check_broad_phase`](crate::broad_phase::testing::check_broad_phase)): no such pair of two blocks is
/// missed, nor one of two far parts of a concave block; each pair comes once, and neighbours in one block never.
pub trait BroadPhase: Send + Sync {
    /// Its name, for reports.
    fn name(&self) -> &'static str;

    /// Brings `pairs`, the answer to the last call, up to date after the blocks `renewed` (ascending; in the first
    /// call all of them) were given other positions or margins, and says whether they changed.
    fn find_pairs(&mut self, scene: &BroadScene, renewed: &[BlockId], pairs: &mut PairLists) -> bool;

    /// Memory on the heap [B].
    fn heap_bytes(&self) -> usize {
        0
    }
}

/// The definition, in O(triangles × tetrahedra); oracle of tests and baseline of benches.
#[derive(Clone, Copy, Debug, Default)]
pub struct AllPairs;

impl BroadPhase for AllPairs {
    fn name(&self) -> &'static str {
        "all pairs"
    }

    fn find_pairs(&mut self, scene: &BroadScene, _renewed: &[BlockId], pairs: &mut PairLists) -> bool {
        let (blocks, mut all) = (scene.blocks, Vec::new());
        let tet_boxes: Vec<Aabb> = (0..blocks.tets.len()).map(|tet| scene.tet_box(tet)).collect();
        for i in 0..blocks.triangles.len() {
            for (j, tet) in tet_boxes.iter().enumerate() {
                let (own, target) = (blocks.triangle_block[i], blocks.tet_block[j]);
                let Some(contactor) = scene.contactor_box(i, target) else { continue };
                if contactor.touches(tet) && !(own == target && scene.are_neighbours(i, j)) {
                    all.push((TriangleId(i as u32), TetId(j as u32)));
                }
            }
        }
        pairs.set(blocks, &all);
        true
    }
}
