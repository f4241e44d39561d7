//! Two levels of trees: blocks in space, and the tetrahedra of each block in its own frame.
//!
//! The tree of a block is built once, from its rest shape. A triangle of another block is carried into that frame by
//! the inverse of the block's rigid motion x ≈ R X + c; what the block deforms is a margin on top. The tree over the
//! blocks is rebuilt in its own memory.

use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, BlockSet, Mat3, TetId, TriangleId, Vec3};
use parry3d_f64::bounding_volume::Aabb as ParryAabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode, BvhWorkspace};
use rayon::prelude::*;

use crate::block_faces::BlockFaces;
use crate::broad_phase::{BroadPhase, BroadScene};

/// Tetrahedra of a block below which looking at all of them is quicker than a tree.
const FEW_TETS: usize = 12;
/// Blocks below which a second thread costs more than it brings.
const GRAIN_BLOCKS: usize = 16;
/// The same for boxes.
const GRAIN_BOXES: usize = 2048;

/// The default broad phase.
#[derive(Default)]
pub struct TreeBroadPhase {
    own: Vec<OwnTree>,
    boxes: Boxes,
    tree: Bvh,
    workspace: BvhWorkspace,
    found: Vec<Vec<(TriangleId, TetId)>>,
}

/// Boxes of everything, with the margin.
#[derive(Default)]
struct Boxes {
    blocks: Vec<Aabb>,
    triangles: Vec<Aabb>,
    tets: Vec<Aabb>,
}

impl Boxes {
    fn place(&mut self, scene: &BroadScene) {
        let blocks = scene.blocks;
        let all = |count: usize, boxes: &mut Vec<Aabb>, of: &(dyn Fn(usize) -> Aabb + Sync)| {
            boxes.resize(count, Aabb::empty());
            let place = |(i, bounds): (usize, &mut Aabb)| *bounds = of(i);
            boxes.par_iter_mut().enumerate().with_min_len(GRAIN_BOXES).for_each(place);
        };
        all(blocks.len(), &mut self.blocks, &|i| scene.block_box(BlockId(i as u32)));
        all(blocks.triangles.len(), &mut self.triangles, &|i| scene.box_around(&blocks.triangles[i]));
        all(blocks.tets.len(), &mut self.tets, &|i| scene.box_around(&blocks.tets[i]));
    }
}

/// A block in its rest shape, and how it lies in space now.
#[derive(Default)]
struct OwnTree {
    /// Over the boxes of its tetrahedra at rest; none for a block of few.
    tree: Option<Bvh>,
    convex: bool,
    /// The rigid motion x ≈ R (X − rest) + center, and the largest deviation from it [m].
    rotation: Mat3,
    center: Vec3,
    rest: Vec3,
    deviation_m: f64,
}

impl BroadPhase for TreeBroadPhase {
    fn find_pairs(&mut self, scene: &BroadScene, pairs: &mut Vec<(TriangleId, TetId)>) {
        let blocks = scene.blocks;
        if self.own.len() != blocks.len() {
            self.own = blocks.ids().map(|block| OwnTree::new(blocks, block)).collect();
            self.found.resize_with(blocks.len(), Vec::new);
        }
        self.place_blocks(scene);
        let (own, tree, boxes) = (&self.own, &self.tree, &self.boxes);
        self.found.par_iter_mut().enumerate().with_min_len(GRAIN_BLOCKS).for_each(|(index, found)| {
            found.clear();
            let block = BlockId(index as u32);
            for other in tree.leaves(|node| node_touches(node, &boxes.blocks[index])) {
                if other as usize != index || !own[index].convex {
                    own[other as usize].find(scene, boxes, block, BlockId(other), found);
                }
            }
            // Block by block they are in order then, and the list as a whole is.
            found.sort_unstable();
        });
        pairs.clear();
        self.found.iter().for_each(|found| pairs.extend_from_slice(found));
    }
}

impl TreeBroadPhase {
    fn place_blocks(&mut self, scene: &BroadScene) {
        self.boxes.place(scene);
        for (index, bounds) in self.boxes.blocks.iter().enumerate() {
            self.tree.insert_or_update_partially(to_parry(bounds), index as u32, 0.0);
        }
        self.tree.rebuild(&mut self.workspace, BvhBuildStrategy::Binned);
        let place = |(index, own): (usize, &mut OwnTree)| own.place(scene, BlockId(index as u32));
        self.own.par_iter_mut().enumerate().with_min_len(GRAIN_BLOCKS).for_each(place);
    }
}

impl OwnTree {
    fn new(blocks: &BlockSet, block: BlockId) -> Self {
        let tets = blocks.tets_of(block);
        let rest_box = |tet: usize| {
            to_parry(&Aabb::around(blocks.tets[tet].iter().map(|n| &blocks.rest_position[n.index()])))
        };
        let tree = (tets.len() > FEW_TETS).then(|| {
            Bvh::from_iter(BvhBuildStrategy::Binned, tets.clone().map(|t| (t - tets.start, rest_box(t))))
        });
        Self { tree, convex: BlockFaces::new(blocks, block).convex, ..Self::default() }
    }

    /// Fits the rigid motion; whatever the fit, the deviation covers the rest.
    fn place(&mut self, scene: &BroadScene, block: BlockId) {
        if self.tree.is_none() {
            return;
        }
        let nodes = scene.blocks.nodes_of(block);
        let (now, rest) = (&scene.position[nodes.clone()], &scene.blocks.rest_position[nodes]);
        let count = now.len() as f64;
        self.center = now.iter().sum::<Vec3>() / count;
        self.rest = rest.iter().sum::<Vec3>() / count;
        let moment: Mat3 =
            now.iter().zip(rest).map(|(x, r)| (x - self.center) * (r - self.rest).transpose()).sum();
        let guess = nalgebra::Rotation3::from_matrix_unchecked(self.rotation);
        let guess = if self.rotation == Mat3::zeros() { nalgebra::Rotation3::identity() } else { guess };
        self.rotation = nalgebra::Rotation3::from_matrix_eps(&moment, 1e-9, 20, guess).into_inner();
        let off = |(x, r): (&Vec3, &Vec3)| (x - self.center - self.rotation * (r - self.rest)).norm();
        self.deviation_m = now.iter().zip(rest).map(off).fold(0.0, f64::max);
    }

    /// Adds the pairs of triangles of `block` and tetrahedra of `other`, which is this one.
    fn find(
        &self,
        scene: &BroadScene,
        boxes: &Boxes,
        block: BlockId,
        other: BlockId,
        found: &mut Vec<(TriangleId, TetId)>,
    ) {
        let blocks = scene.blocks;
        let first = blocks.tets_of(other).start;
        let one_block = block == other;
        for i in blocks.triangles_of(block) {
            let triangle = &boxes.triangles[i];
            if !triangle.touches(&boxes.blocks[other.index()]) {
                continue;
            }
            let mut add = |j: usize| {
                if triangle.touches(&boxes.tets[j]) && !(one_block && scene.are_neighbours(i, j)) {
                    found.push((TriangleId(i as u32), TetId(j as u32)));
                }
            };
            match &self.tree {
                None => blocks.tets_of(other).for_each(&mut add),
                Some(tree) => {
                    let here = self.carried(scene, i);
                    tree.leaves(|node| node_touches(node, &here)).for_each(|leaf| add(first + leaf as usize));
                }
            }
        }
    }

    /// Box of a triangle in the block's rest frame, with the margins of both.
    fn carried(&self, scene: &BroadScene, triangle: usize) -> Aabb {
        let back = |x: Vec3| self.rotation.tr_mul(&(x - self.center)) + self.rest;
        let corners = scene.blocks.triangles[triangle].map(|n| back(scene.position[n.index()]));
        Aabb::around(&corners).inflated(2.0 * scene.margin_m + self.deviation_m)
    }
}

fn to_parry(bounds: &Aabb) -> ParryAabb {
    let vector = |v: &Vec3| Vector::new(v.x, v.y, v.z);
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
        check_broad_phase(TreeBroadPhase::default);
    }
}
