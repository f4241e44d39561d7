//! A face of a convex block, carried along by its largest triangle.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, BlockSet, NodeId, Vec3};

use crate::affine::surface::BlockFaces;
use crate::integration::linear::Linear;

/// Units in the last place of coordinates that are no overlap: blocks that move side by side drift by some.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A face of a convex block, and how far the block reaches behind it.
#[derive(Clone, Debug)]
pub(crate) struct Face {
    /// Its block.
    pub block: BlockId,
    /// Its largest triangle, which carries the plane along.
    pub corners: [NodeId; 3],
    /// The node furthest below it at rest, and φ there, in a block that is an affine convex target.
    pub(super) furthest: Option<(NodeId, f64)>,
    /// n of φ = n·(p − x) in a block that is an affine convex target [1/m], in others of any length.
    normal: Vec3,
    point: Vec3,
    /// n·(x − p) from which on a point is beyond: the largest of the block's nodes, less rounding.
    reach: f64,
}

impl Face {
    pub(super) fn new(
        blocks: &BlockSet,
        block: BlockId,
        surface: &BlockFaces,
        face: usize,
        phi_per_m: Option<f64>,
    ) -> Self {
        let corners = blocks.triangles[surface.largest_triangle(blocks, block, face)];
        let furthest = phi_per_m.map(|phi_per_m| {
            let depth = |n: usize| surface.planes[face].depth_m(&blocks.rest_position[n]);
            let deeper = |a: &usize, b: &usize| depth(*a).total_cmp(&depth(*b));
            let node = blocks.nodes_of(block).max_by(deeper).expect("a block has nodes");
            (NodeId(node as u32), phi_per_m * depth(node))
        });
        Self { block, corners, furthest, normal: Vec3::zeros(), point: Vec3::zeros(), reach: f64::INFINITY }
    }

    pub(super) fn place(&mut self, nodes: &[Vec3], position: &[Vec3]) {
        let corners = self.corners.map(|n| position[n.index()]);
        (self.normal, self.point) = (triangle_area_vector(&corners), corners[0]);
        let mut reach = 0.0;
        if let Some((node, phi)) = self.furthest {
            self.normal *= phi / self.normal.dot(&(self.point - position[node.index()]));
        } else {
            let above = |x: &Vec3| self.normal.dot(&(x - self.point));
            reach = nodes.iter().map(above).fold(0.0, f64::max);
        }
        let largest = corners.iter().map(Vec3::amax).fold(0.0, f64::max);
        self.reach = reach - ROUNDING * largest * self.normal.lp_norm(1);
    }

    /// φ of this face, in a block that is an affine convex target.
    #[inline(always)]
    pub(crate) fn phi(&self, x: &Vec3) -> f64 {
        self.normal.dot(&(self.point - x))
    }

    /// ∇φ [1/m].
    #[inline(always)]
    pub(crate) fn gradient(&self) -> Vec3 {
        -self.normal
    }

    /// n·(x − p) from which on a point is beyond.
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// Whether the points are beyond by more than a distance [m].
    pub(crate) fn keeps_out(&self, points: &[Vec3], distance_m: f64) -> bool {
        let least = self.reach + distance_m * self.normal.norm();
        points.iter().all(|x| self.normal.dot(&(x - self.point)) > least)
    }

    /// A point of the plane [m].
    pub(crate) fn point(&self) -> &Vec3 {
        &self.point
    }

    /// φ as a function of place, seen from `origin`.
    pub(crate) fn linear(&self, origin: &Vec3) -> Linear {
        Linear { value: self.phi(origin), gradient: self.gradient() }
    }
}
