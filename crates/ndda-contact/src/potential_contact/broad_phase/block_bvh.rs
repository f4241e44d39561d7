//! The tetrahedra and boundary triangles of one block in its own frame.
//!
//! The trees of a block are built once, from its rest shape. What is near the block in space is carried into that
//! frame by the inverse of the rigid motion x ≈ R (X − rest) + center; what the block deforms is a margin on top.

use std::ops::Range;

use nalgebra::Rotation3;
use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, BlockSet, Mat3, NodeId, Vec3};
use parry3d_f64::bounding_volume::Aabb as ParryAabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode};

use crate::broad_phase::finder::BroadScene;

/// Tetrahedra of a block up to which looking at all of them is quicker than a tree.
const FEW_TETS: usize = 12;
/// Steps of the fit of a rotation; whatever they leave is part of the deviation.
const FIT_STEPS: usize = 20;

/// Trees over a block at rest, and how the block lies in space now.
pub(crate) struct BlockBvh {
    tets: Bvh,
    triangles: Bvh,
    rotation: Mat3,
    center: Vec3,
    rest: Vec3,
    /// Largest distance of a node from where the rigid motion has it, and the rounding of both frames [m].
    deviation_m: f64,
}

impl BlockBvh {
    /// Trees over a block; none for one of so few tetrahedra that they would not pay.
    pub(crate) fn new(blocks: &BlockSet, block: BlockId) -> Option<Box<Self>> {
        if blocks.tets_of(block).len() <= FEW_TETS {
            return None;
        }
        Some(Box::new(Self {
            tets: tree_over(blocks, &blocks.tets, blocks.tets_of(block)),
            triangles: tree_over(blocks, &blocks.triangles, blocks.triangles_of(block)),
            rotation: Mat3::identity(),
            center: Vec3::zeros(),
            rest: Vec3::zeros(),
            deviation_m: 0.0,
        }))
    }

    /// Fits the rigid motion; whatever the fit, the deviation covers the rest.
    pub(crate) fn place(&mut self, scene: &BroadScene, block: BlockId) {
        let nodes = scene.blocks.nodes_of(block);
        let (now, rest) = (&scene.position[nodes.clone()], &scene.blocks.rest_position[nodes]);
        let count = now.len() as f64;
        self.rest = rest.iter().sum::<Vec3>() / count;
        let center = now.iter().sum::<Vec3>() / count;
        // Where a node is nowhere the deviation is infinite, about any point that is somewhere.
        self.center = if is_finite(&center) { center } else { self.rest };
        let moment: Mat3 =
            now.iter().zip(rest).map(|(x, r)| (x - self.center) * (r - self.rest).transpose()).sum();
        let guess = Rotation3::from_matrix_unchecked(self.rotation);
        let fit = Rotation3::from_matrix_eps(&moment, 1e-9, FIT_STEPS, guess).into_inner();
        self.rotation = if is_finite(&fit) { fit } else { Mat3::identity() };
        let off = |(x, r): (&Vec3, &Vec3)| (x - self.center - self.rotation * (r - self.rest)).norm();
        let deviation = now.iter().zip(rest).map(off).fold(0.0, largest);
        let furthest = now.iter().chain(rest).map(|x| x.amax()).fold(0.0, largest);
        self.deviation_m = deviation + 16.0 * f64::EPSILON * furthest;
    }

    /// The boundary triangles, counted from the block's first, that may reach into a box.
    pub(crate) fn triangles_near(&self, bounds: &Aabb, margin_m: f64) -> impl Iterator<Item = usize> + '_ {
        leaves_near(&self.triangles, self.carried(bounds, margin_m))
    }

    /// The tetrahedra, counted from the block's first, that may reach a triangle.
    pub(crate) fn tets_near_triangle(
        &self,
        corners: &[Vec3; 3],
        margin_m: f64,
    ) -> impl Iterator<Item = usize> + '_ {
        let back = corners.map(|x| self.carried_back(&x));
        leaves_near(&self.tets, Aabb::around(&back).inflated(margin_m + self.deviation_m))
    }

    fn carried_back(&self, x: &Vec3) -> Vec3 {
        self.rotation.tr_mul(&(x - self.center)) + self.rest
    }

    /// Box around a box, in the rest frame.
    fn carried(&self, bounds: &Aabb, margin_m: f64) -> Aabb {
        let center = self.carried_back(&bounds.center());
        let half = self.rotation.abs().tr_mul(&(0.5 * (bounds.max - bounds.min)));
        Aabb { min: center - half, max: center + half }.inflated(margin_m + self.deviation_m)
    }

    /// Memory beside the struct itself [B].
    pub(crate) fn heap_bytes(&self) -> usize {
        self.tets.heap_memory_size() + self.triangles.heap_memory_size()
    }
}

fn is_finite<const C: usize>(numbers: &nalgebra::SMatrix<f64, 3, C>) -> bool {
    numbers.iter().all(|x| x.is_finite())
}

/// The larger one; infinite where one is not a number, so that nothing is missed.
fn largest(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}

fn tree_over<const N: usize>(blocks: &BlockSet, elements: &[[NodeId; N]], range: Range<usize>) -> Bvh {
    let rest_box =
        |nodes: &[NodeId; N]| to_parry(&Aabb::around(nodes.iter().map(|n| &blocks.rest_position[n.index()])));
    Bvh::from_iter(BvhBuildStrategy::Binned, elements[range].iter().map(rest_box).enumerate())
}

fn leaves_near(tree: &Bvh, bounds: Aabb) -> impl Iterator<Item = usize> + '_ {
    tree.leaves(move |node| node_touches(node, &bounds)).map(|leaf| leaf as usize)
}

/// The box as the tree's library has it.
pub(crate) fn to_parry(bounds: &Aabb) -> ParryAabb {
    let vector = |v: &Vec3| Vector::new(v.x, v.y, v.z);
    ParryAabb::new(vector(&bounds.min), vector(&bounds.max))
}

/// Whether a node of a tree and a box share a point.
pub(crate) fn node_touches(node: &BvhNode, bounds: &Aabb) -> bool {
    let (min, max) = (node.mins(), node.maxs());
    (0..3).all(|i| min[i] <= bounds.max[i] && bounds.min[i] <= max[i])
}
