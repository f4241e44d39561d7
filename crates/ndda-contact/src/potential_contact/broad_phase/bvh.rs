//! Two levels of trees: blocks in space, and the elements of each block in its own frame.
//!
//! A block that has not moved on keeps its pairs with all others that have not; one that has takes its leaf of the
//! tree along. What is inside a block is placed when another comes near. The tree is rebuilt, in its own memory, when
//! as many leaves have moved as there are. Cells of a uniform grid find all pairs of boxes a few times quicker, but
//! have to be filled anew when one box has moved.

use std::sync::{Mutex, PoisonError};

use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, BlockSet, TetId, TriangleId, Vec3};
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use rayon::prelude::*;

use crate::affine::face_contactor::FaceContactor;
use crate::affine::surface::BlockFaces;
use crate::broad_phase::block_bvh::{BlockBvh, node_touches, to_parry};
use crate::broad_phase::block_pairs::BlockPairs;
use crate::broad_phase::finder::{BroadPhase, BroadScene, FEW_NODES, Side, TriangleAt, shape_of};
use crate::broad_phase::pair_lists::{Fresh, PairLists};
use crate::broad_phase::pair_run::PairRun;
use crate::broad_phase::tet_faces::TetFaces;
use crate::integration::capacity::MOST_CORNERS;

/// Blocks below which a second thread costs more than it brings.
const GRAIN_BLOCKS: usize = 16;
/// Boxes below which a second thread costs more than it brings.
const GRAIN_BOXES: usize = 2048;
/// Part of the nodes, 1 / this, beyond which placing all blocks at once is quicker than one by one.
const MANY: usize = 4;

/// The default broad phase.
#[derive(Default)]
pub struct TreeBroadPhase {
    own: Vec<Option<Box<BlockBvh>>>,
    is_convex: Vec<bool>,
    boxes: Boxes,
    tree: Bvh,
    workspace: BvhWorkspace,
    /// Leaves moved since the tree was rebuilt.
    displaced: usize,
    is_renewed: Vec<bool>,
    /// Blocks that touched a renewed one before, or do now.
    is_near: Vec<bool>,
    /// Blocks whose elements are placed where they were renewed last; one that is far from all others waits.
    is_placed: Vec<bool>,
    /// Blocks whose elements are to be placed now.
    is_due: Vec<bool>,
    /// Whether the pairs of each block changed.
    changed: Vec<bool>,
    /// One for each thread.
    fresh: Vec<Mutex<Fresh>>,
    /// Of the set that all this is about.
    shape: [usize; 4],
}

/// Boxes of the blocks, with the margin, and their sides.
#[derive(Default)]
struct Boxes {
    blocks: Vec<Aabb>,
    /// One for each of [`ConvexBlocks::faces`](crate::affine::convex_target::ConvexBlocks::faces), without a margin.
    sides: Vec<Side>,
}

/// Sets the entries that are due, on all threads.
fn place_due<T: Send>(
    entries: &mut [T],
    is_due: impl Fn(usize) -> bool + Sync,
    of: impl Fn(usize) -> T + Sync,
) {
    let place = |(i, entry): (usize, &mut T)| {
        if is_due(i) {
            *entry = of(i);
        }
    };
    entries.par_iter_mut().enumerate().with_min_len(GRAIN_BOXES).for_each(place);
}

impl Boxes {
    fn new(blocks: &BlockSet) -> Self {
        Self { blocks: vec![Aabb::empty(); blocks.len()], sides: Vec::new() }
    }

    /// Sides of all blocks that are due.
    fn place_all(&mut self, scene: &BroadScene, is_due: &[bool]) {
        let faces = scene.hulls.faces();
        self.sides.resize(faces.len(), Side::default());
        place_due(&mut self.sides, |i| is_due[faces[i].block.index()], |i| Side::new(scene, &faces[i]));
    }

    /// Sides of one block.
    fn place(&mut self, scene: &BroadScene, block: BlockId) {
        let sides = self.sides[scene.hulls.places_of(block)].iter_mut();
        sides.zip(scene.hulls.faces_of(block)).for_each(|(side, face)| *side = Side::new(scene, face));
    }
}

impl BroadPhase for TreeBroadPhase {
    fn name(&self) -> &'static str {
        "trees of boxes"
    }

    fn heap_bytes(&self) -> usize {
        let own =
            self.own.iter().flatten().map(|own| size_of::<BlockBvh>() + own.heap_bytes()).sum::<usize>();
        let boxes = &self.boxes;
        let sides = boxes.sides.capacity() * size_of::<Side>();
        let boxes = boxes.blocks.capacity();
        let per_block = size_of::<Option<Box<BlockBvh>>>() + 6 * size_of::<bool>();
        let tree = self.tree.heap_memory_size();
        own + boxes * size_of::<Aabb>() + sides + per_block * self.changed.capacity() + tree
    }

    fn find_pairs(&mut self, scene: &BroadScene, renewed: &[BlockId], pairs: &mut PairLists) -> bool {
        let begins = self.shape != shape_of(scene.blocks);
        if begins {
            assert_eq!(renewed.len(), scene.blocks.len(), "at first all blocks are new");
            self.begin(scene.blocks);
            pairs.begin(scene.blocks.len());
        }
        self.is_renewed.fill(false);
        for block in renewed {
            self.is_renewed[block.index()] = true;
            self.is_placed[block.index()] = false;
        }
        let nodes: usize = renewed.iter().map(|block| scene.blocks.nodes_of(*block).len()).sum();
        let many = MANY * nodes > scene.position.len();
        self.is_near.fill(many);
        if many {
            self.place_blocks(scene, renewed);
            self.mark_due();
            self.place_all(scene);
        } else {
            self.mark_near(renewed);
            self.place_blocks(scene, renewed);
            self.mark_near(renewed);
            self.mark_due();
            self.place(scene);
        }
        self.search(scene, pairs) || begins
    }
}

impl TreeBroadPhase {
    fn begin(&mut self, blocks: &BlockSet) {
        self.shape = shape_of(blocks);
        self.own = blocks.ids().map(|block| BlockBvh::new(blocks, block)).collect();
        self.is_convex = blocks.ids().map(|id| BlockFaces::new(blocks, id).convex).collect();
        self.is_renewed = vec![true; blocks.len()];
        self.is_near = vec![true; blocks.len()];
        self.is_placed = vec![false; blocks.len()];
        self.is_due = vec![false; blocks.len()];
        self.changed = vec![false; blocks.len()];
        self.boxes = Boxes::new(blocks);
        let everywhere = to_parry(&Aabb::around(&blocks.rest_position));
        let leaves = blocks.ids().map(|id| (id.index(), everywhere));
        self.tree = Bvh::from_iter(BvhBuildStrategy::Binned, leaves);
        self.displaced = 0;
    }

    /// Boxes around renewed blocks, and their leaves.
    fn place_blocks(&mut self, scene: &BroadScene, renewed: &[BlockId]) {
        let is_renewed = &self.is_renewed;
        place_due(&mut self.boxes.blocks, |i| is_renewed[i], |i| scene.block_box(BlockId(i as u32)));
        self.place_leaves(renewed);
    }

    /// Marks what another block has come near to, or a far part of its own may, and is not placed.
    fn mark_due(&mut self) {
        let (is_near, is_convex, tree, boxes) =
            (&self.is_near, &self.is_convex, &self.tree, &self.boxes.blocks);
        let has_company = |index: usize| {
            tree.leaves(|node| node_touches(node, &boxes[index])).any(|other| other as usize != index)
        };
        let mark = |(index, (due, placed)): (usize, (&mut bool, &mut bool))| {
            *due = is_near[index] && !*placed && (!is_convex[index] || has_company(index));
            *placed |= *due;
        };
        let marks = self.is_due.par_iter_mut().zip(&mut self.is_placed);
        marks.enumerate().with_min_len(GRAIN_BLOCKS).for_each(mark);
    }

    fn place_all(&mut self, scene: &BroadScene) {
        self.boxes.place_all(scene, &self.is_due);
        let is_due = &self.is_due;
        let place = |(index, own): (usize, &mut Option<Box<BlockBvh>>)| {
            if let Some(own) = own.as_mut().filter(|_| is_due[index]) {
                own.place(scene, BlockId(index as u32));
            }
        };
        self.own.par_iter_mut().enumerate().with_min_len(GRAIN_BLOCKS).for_each(place);
    }

    fn place(&mut self, scene: &BroadScene) {
        for block in scene.blocks.ids().filter(|block| self.is_due[block.index()]) {
            self.boxes.place(scene, block);
            if let Some(own) = &mut self.own[block.index()] {
                own.place(scene, block);
            }
        }
    }

    fn place_leaves(&mut self, renewed: &[BlockId]) {
        let leaf = |block: &BlockId| (to_parry(&self.boxes.blocks[block.index()]), block.0);
        self.displaced += renewed.len();
        if self.displaced < self.boxes.blocks.len() {
            renewed.iter().map(leaf).for_each(|(bounds, index)| self.tree.insert(bounds, index));
        } else {
            for (bounds, index) in renewed.iter().map(leaf) {
                self.tree.insert_or_update_partially(bounds, index, 0.0);
            }
            self.tree.rebuild(&mut self.workspace, BvhBuildStrategy::Binned);
            self.displaced = 0;
        }
    }

    /// Marks what touches a renewed block.
    fn mark_near(&mut self, renewed: &[BlockId]) {
        for block in renewed {
            self.is_near[block.index()] = true;
            let bounds = &self.boxes.blocks[block.index()];
            let leaves = self.tree.leaves(|node| node_touches(node, bounds));
            leaves.for_each(|other| self.is_near[other as usize] = true);
        }
    }

    /// Brings the pairs of all blocks near renewed ones up to date, and says whether any changed.
    fn search(&mut self, scene: &BroadScene, pairs: &mut PairLists) -> bool {
        let threads = rayon::current_num_threads().max(self.fresh.len());
        self.fresh.resize_with(threads, Mutex::default);
        let (is_renewed, is_near, tree, scratch) = (&self.is_renewed, &self.is_near, &self.tree, &self.fresh);
        let near = Near { scene, own: &self.own, boxes: &self.boxes };
        let (is_convex, by_element) = (&self.is_convex, pairs.by_element);
        let search = |(index, (list, changed)): (usize, (&mut BlockPairs, &mut bool))| {
            *changed = false;
            if !is_near[index] {
                return;
            }
            let own = &scratch[rayon::current_thread_index().unwrap_or(0)];
            let fresh = &mut *own.lock().unwrap_or_else(PoisonError::into_inner);
            fresh.by_element = by_element;
            fresh.runs.clear();
            near.place_triangles(BlockId(index as u32), fresh);
            for other in tree.leaves(|node| node_touches(node, &near.boxes.blocks[index])) {
                let stale = is_renewed[index] || is_renewed[other as usize];
                let stale = stale && scene.is_there(BlockId(index as u32)) && scene.is_there(BlockId(other));
                if stale && (other as usize != index || !is_convex[index]) {
                    near.find(BlockId(index as u32), BlockId(other), fresh);
                }
            }
            let is_stale = |run: &PairRun| {
                is_renewed[index] || is_renewed[scene.blocks.tet_block[run.first().index()].index()]
            };
            *changed = fresh.merge_into(list, is_stale, scene.blocks, BlockId(index as u32));
        };
        let lists = pairs.each_mut().par_iter_mut().zip(&mut self.changed).enumerate();
        lists.with_min_len(GRAIN_BLOCKS).for_each(search);
        self.changed.contains(&true)
    }
}

/// Input of the search between two blocks.
struct Near<'a> {
    scene: &'a BroadScene<'a>,
    own: &'a [Option<Box<BlockBvh>>],
    boxes: &'a Boxes,
}

impl Near<'_> {
    /// Boxes of the triangles of a block without trees.
    fn place_triangles(&self, block: BlockId, found: &mut Fresh) {
        found.triangles.clear();
        if self.own[block.index()].is_none() {
            found.triangles.extend(self.scene.blocks.triangles_of(block).map(|i| self.scene.triangle_box(i)));
        }
    }

    /// Adds the pairs of triangles of `block` that reach into the box of `other` and its tetrahedra.
    fn find(&self, block: BlockId, other: BlockId, found: &mut Fresh) {
        if block == other && self.scene.hulls.keeps_its_shape(block) {
            return;
        }
        if block != other && (self.is_apart(block, other) || self.is_apart(other, block)) {
            return;
        }
        let there = &self.boxes.blocks[other.index()];
        let faces = self.scene.hulls.contactors(block, other);
        if !faces.is_empty() {
            let mut room = [Vec3::zeros(); MOST_CORNERS];
            let reaches = |face: &&FaceContactor| self.scene.face_box(face).touches(there);
            for face in faces.iter().filter(reaches) {
                let (id, corners) = (face.triangle, face.place(self.scene.position, &mut room));
                let plane = self.scene.triangle_at(id.index(), other);
                self.find_affine_target(id, &plane, corners, (block, other), found);
            }
            return;
        }
        found.boxes.clear();
        found.faces.clear();
        if self.own[other.index()].is_none() && self.scene.hulls.affine_target(other).is_none() {
            found.boxes.extend(self.scene.blocks.tets_of(other).map(|j| self.scene.tet_box(j)));
        }
        let first = self.scene.blocks.triangles_of(block).start;
        match &self.own[block.index()] {
            None => {
                for k in 0..found.triangles.len() {
                    let bounds = found.triangles[k];
                    if bounds.touches(there) {
                        self.find_tets((first + k, &bounds), (block, other), found);
                    }
                }
            }
            Some(own) => {
                for leaf in own.triangles_near(there, self.scene.margin_m[block.index()]) {
                    let bounds = self.scene.triangle_box(first + leaf);
                    if bounds.touches(there) {
                        self.find_tets((first + leaf, &bounds), (block, other), found);
                    }
                }
            }
        }
    }

    /// Whether a side of a block keeps all of another from it; not asked of one of many nodes.
    fn is_apart(&self, block: BlockId, other: BlockId) -> bool {
        let nodes = self.scene.blocks.nodes_of(other);
        nodes.len() <= FEW_NODES && self.has_before(block, other, &self.scene.position[nodes])
    }

    fn has_before(&self, block: BlockId, other: BlockId, points: &[Vec3]) -> bool {
        let reach_m = self.scene.margin_m[block.index()] + self.scene.margin_m[other.index()];
        let sides = &self.boxes.sides[self.scene.hulls.places_of(block)];
        sides.iter().any(|side| side.is_before(points, reach_m))
    }

    /// Adds a contactor, a triangle or the face with these corners that it stands for, that may reach into another block, taken whole.
    fn find_affine_target(
        &self,
        id: TriangleId,
        triangle: &TriangleAt,
        corners: &[Vec3],
        (block, other): (BlockId, BlockId),
        found: &mut Fresh,
    ) {
        let scene = self.scene;
        let Some(whole) = scene.hulls.affine_target(other) else { return };
        let others = &scene.position[scene.blocks.nodes_of(other)];
        if !self.has_before(other, block, corners) && !triangle.are_on_one_side(others) {
            found.runs.push(PairRun::one(id, whole.host));
        }
    }

    /// Adds the pairs of a triangle, in this box, with the tetrahedra of another block.
    fn find_tets(&self, (i, bounds): (usize, &Aabb), (block, other): (BlockId, BlockId), found: &mut Fresh) {
        let scene = self.scene;
        let triangle = scene.triangle_at(i, other);
        if scene.hulls.affine_target(other).is_some() {
            let id = TriangleId(i as u32);
            return self.find_affine_target(id, &triangle, &triangle.corners, (block, other), found);
        }
        if block != other && self.has_before(other, block, &triangle.corners) {
            return;
        }
        let tets = scene.blocks.tets_of(other);
        let Fresh { boxes, faces, tets: near, .. } = found;
        let corners_of = |j: usize| scene.blocks.tet_corners(TetId(j as u32), scene.position);
        let mut add = |j: usize, is_apart: bool| {
            if !(is_apart || block == other && scene.are_neighbours(i, j)) {
                near.push(TetId(j as u32));
            }
        };
        match &self.own[other.index()] {
            None => {
                if faces.is_empty() {
                    faces.extend(tets.clone().map(|j| TetFaces::new(corners_of(j))));
                }
                for ((j, there), faces) in tets.zip(&*boxes).zip(&*faces) {
                    add(j, !bounds.touches(there) || triangle.is_apart_from_faces(faces));
                }
            }
            Some(own) => {
                let leaves = own.tets_near_triangle(&triangle.corners, triangle.reach_m);
                for j in leaves.map(|leaf| tets.start + leaf) {
                    let is_near = bounds.touches(&scene.tet_box(j));
                    add(j, !is_near || triangle.is_apart_from(&corners_of(j)));
                }
            }
        }
        found.take_tets(TriangleId(i as u32));
    }
}
