//! Random scenes in which a broad phase is compared with all pairs.

use ndda_mesh::{BlockId, BlockSet, TetId, TriangleId, Vec3};

use crate::affine::convex_target::ConvexBlocks;
use crate::affine::surface::BlockFaces;
use crate::broad_phase::finder::{AllPairs, BroadPhase, BroadScene};
use crate::broad_phase::pair_lists::PairLists;
use crate::integration::clip::{Form, Polygon};
use crate::integration::tet_frame::TetFrame;
use crate::testing::{Random, test_box, test_horseshoe, test_set};

/// Scenes of [`check_broad_phase`].
const SCENES: usize = 10_000;
/// Steps of each scene.
const STEPS: usize = 3;

/// Counts of [`check_broad_phase`]; no pair that overlaps was missed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BroadCounts {
    /// Lists that were compared.
    pub lists: usize,
    /// Pairs in them.
    pub found: usize,
    /// Pairs whose boxes, without a margin, do not touch.
    pub extra: usize,
    /// Pairs whose boxes touch, of which it was seen from nearer by that they do not overlap.
    pub apart: usize,
    /// Pairs that overlap.
    pub overlapping: usize,
    /// Pairs within one block.
    pub in_one_block: usize,
}

/// Panics unless a broad phase keeps the contract of [`BroadPhase`]: over random blocks of sizes from 1 to 1000, some
/// concave, of which some turn, shift and deform in each step and some are affine convex targets, no pair that overlaps within the margin is missed, and
/// every pair is one of [`AllPairs`].
pub fn check_broad_phase<P: BroadPhase>(new: impl Fn() -> P) -> BroadCounts {
    let mut random = Random(1);
    let mut counts = BroadCounts::default();
    for scene in 0..SCENES {
        let blocks = random.blocks(scene % 5 == 0);
        let mut phase = new();
        let mut place = Place {
            position: random.bent(&blocks),
            margin_m: vec![0.0; blocks.len()],
            renewed: blocks.ids().collect(),
            hulls: random.hulls(&blocks),
        };
        let (mut lists, mut before) = (PairLists::default(), Vec::new());
        for step in 0..STEPS {
            place.renew(&mut random, &blocks);
            let input = place.scene(&blocks);
            let changed = phase.find_pairs(&input, &place.renewed, &mut lists);
            let found: Vec<_> = lists.pairs().collect();
            assert!(step == 0 || changed == (found != before), "what changed is not what was said to");
            before.clone_from(&found);
            // Until a node has moved by the margin whatever overlaps must be in the list.
            let moved = random.jostled(&blocks, &place);
            compare(&input, &moved, &found, &mut counts);
            random.choose(&blocks, &mut place.renewed);
        }
    }
    counts
}

fn compare(input: &BroadScene, moved: &[Vec3], found: &[(TriangleId, TetId)], counts: &mut BroadCounts) {
    let every = || input.blocks.ids().collect::<Vec<BlockId>>();
    let listed = |scene: &BroadScene| {
        let mut lists = PairLists::default();
        AllPairs.find_pairs(scene, &every(), &mut lists);
        lists.pairs().collect::<Vec<_>>()
    };
    let all = listed(input);
    let none = vec![0.0; input.blocks.len()];
    let tight = BroadScene { position: moved, margin_m: &none, ..*input };
    let touching = listed(&tight);
    assert!(found.is_sorted_by(|a, b| a < b), "a pair comes twice, or pairs are not in order");
    assert!(found.iter().all(|pair| all.binary_search(pair).is_ok()), "a pair out of reach");
    counts.lists += 1;
    counts.found += found.len();
    counts.extra += found.iter().filter(|pair| touching.binary_search(pair).is_err()).count();
    for pair in &touching {
        let listed = found.binary_search(pair).is_ok();
        let overlaps = overlap(input, moved, pair);
        assert!(listed || !overlaps, "{pair:?} overlap and are not in the list");
        counts.apart += usize::from(!listed);
        counts.overlapping += usize::from(overlaps);
        let one_block = input.blocks.triangle_block[pair.0.index()] == input.blocks.tet_block[pair.1.index()];
        counts.in_one_block += usize::from(overlaps && one_block);
    }
}

/// Whether a triangle overlaps a tetrahedron, or any of a block that is an affine convex target.
fn overlap(input: &BroadScene, position: &[Vec3], (triangle, tet): &(TriangleId, TetId)) -> bool {
    let (blocks, block) = (input.blocks, input.blocks.tet_block[tet.index()]);
    let corners = blocks.triangle_corners(*triangle, position);
    let outline = input.hulls.outline(*triangle, block);
    let overlaps = |tet: usize| {
        let frame = TetFrame::new(&blocks.tet_corners(TetId(tet as u32), position));
        let lambda = frame.lambda(&corners);
        // Inside of all four faces.
        let mut part = Polygon::all_of(outline);
        lambda.iter().for_each(|at| part.cut(&Form::through(at), 0.0));
        part.fan().map(|(_, part)| part).sum::<f64>() > 0.0
    };
    match input.hulls.affine_target(block) {
        Some(_) => blocks.tets_of(block).any(overlaps),
        None => overlaps(tet.index()),
    }
}

/// Where blocks are listed.
struct Place {
    position: Vec<Vec3>,
    margin_m: Vec<f64>,
    renewed: Vec<BlockId>,
    hulls: ConvexBlocks,
}

impl Place {
    fn scene<'a>(&'a self, blocks: &'a BlockSet) -> BroadScene<'a> {
        BroadScene {
            blocks,
            position: &self.position,
            margin_m: &self.margin_m,
            hulls: &self.hulls,
            absent: &[],
        }
    }

    /// Turns, shifts and deforms what is to be renewed, and gives it another margin.
    fn renew(&mut self, random: &mut Random, blocks: &BlockSet) {
        for &block in &self.renewed {
            let turn = nalgebra::Rotation3::new(random.vector()).into_inner();
            let nodes = blocks.nodes_of(block);
            let center = self.position[nodes.start];
            let shift = 0.2 * random.vector();
            let (is_affine, stretch) = (self.hulls.affine_target(block).is_some(), 0.01 * random.vector());
            for x in &mut self.position[nodes] {
                let strain = if is_affine { stretch } else { 0.01 * random.vector() };
                let arm = turn * (*x - center);
                *x = center + shift + arm + strain * if is_affine { arm.x + arm.y } else { arm.norm() };
            }
            self.margin_m[block.index()] = 0.02 * random.unit();
        }
    }
}

impl Random {
    /// Each coordinate from −1/2 to 1/2.
    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.unit() - 0.5, self.unit() - 0.5, self.unit() - 0.5)
    }

    /// One to five blocks, with a horseshoe or without.
    fn blocks(&mut self, horseshoe: bool) -> BlockSet {
        let count = 2 + (4.0 * self.unit()) as usize - usize::from(horseshoe);
        let mut meshes = Vec::new();
        for _ in 0..count {
            let size = [1.0, 1.0, 0.1, 0.001][(4.0 * self.unit()) as usize];
            let cells = [1, 1 + (2.0 * self.unit()) as u32, 1 + (2.0 * self.unit()) as u32];
            let corner = [self.unit(), self.unit(), self.unit()];
            meshes.push(test_box(corner, [size, size * (0.5 + self.unit()), size], cells));
        }
        if horseshoe {
            meshes.push(test_horseshoe([self.unit(), self.unit(), self.unit()], 1.0 + self.unit()));
        }
        test_set(meshes)
    }

    /// Some of the convex blocks are affine convex targets.
    fn hulls(&mut self, blocks: &BlockSet) -> ConvexBlocks {
        let (mut hulls, share) = (ConvexBlocks::default(), 1.5 * self.unit() - 0.25);
        let affine: Vec<bool> = blocks.ids().map(|_| self.unit() < share).collect();
        hulls.fit(blocks, &BlockFaces::of_all(blocks), Some(1.0), &affine, self.unit() < 0.5);
        hulls
    }

    /// The rest shape with the upper ends of horseshoes drawn together, some of them past each other.
    fn bent(&mut self, blocks: &BlockSet) -> Vec<Vec3> {
        let mut position = blocks.rest_position.clone();
        for block in blocks.ids().filter(|&block| blocks.tets_of(block).len() == 72) {
            let nodes = &mut position[blocks.nodes_of(block)];
            let bounds = ndda_mesh::geometry::Aabb::around(nodes.iter());
            let (center, size) = (bounds.center(), bounds.max - bounds.min);
            let closing = 0.8 * self.unit() * size.x / size.z;
            nodes.iter_mut().for_each(|x| x.x -= (x.x - center.x).signum() * closing * (x.z - bounds.min.z));
        }
        position
    }

    /// All nodes moved by at most the margin.
    fn jostled(&mut self, blocks: &BlockSet, place: &Place) -> Vec<Vec3> {
        let mut moved = place.position.clone();
        for block in blocks.ids() {
            let way_m = 1.15 * place.margin_m[block.index()];
            let shift = self.vector();
            let is_affine = place.hulls.affine_target(block).is_some();
            let shifts = || if is_affine { shift } else { self.vector() };
            moved[blocks.nodes_of(block)]
                .iter_mut()
                .zip(std::iter::repeat_with(shifts))
                .for_each(|(x, shift)| *x += way_m * shift);
        }
        moved
    }

    /// None, some or all of the blocks.
    fn choose(&mut self, blocks: &BlockSet, chosen: &mut Vec<BlockId>) {
        let share = 1.5 * self.unit();
        chosen.clear();
        chosen.extend(blocks.ids().filter(|_| self.unit() < share));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::broad_phase::TreeBroadPhase;

    #[test]
    fn it_finds_what_all_pairs_finds() {
        let counts = check_broad_phase(TreeBroadPhase::default);
        println!("{counts:?}");
        assert!(counts.overlapping > 100_000 && counts.in_one_block > 1000, "the scenes hardly touch");
    }
}
