//! The list of pairs that are worth clipping, kept while nothing has moved far.

use std::ops::Range;

use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, NodeId, TetId, TriangleId, Vec3};

use crate::broad_phase::{BroadPhase, BroadScene};
use crate::bvh::TreeBroadPhase;
use crate::model::ContactInput;

/// Skin over the mean size of boundary triangles; a list then lasts for many steps of a slow scene.
const SKIN: f64 = 0.05;
/// Steps that a list should last when blocks are fast.
const LASTING_STEPS: f64 = 8.0;

/// A boundary triangle and the tetrahedra of one other block that it may be in.
#[derive(Clone, Debug, PartialEq)]
pub struct Facet {
    /// The contactor's triangle.
    pub triangle: TriangleId,
    /// The other block.
    pub target: BlockId,
    /// Its pairs in [`Candidates::pairs`].
    pub pairs: Range<usize>,
}

/// One pair; the tetrahedron is an index into [`Candidates::tets`], the overlap one into a list as long as
/// [`Candidates::overlaps`] says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// The contactor's triangle.
    pub triangle: TriangleId,
    /// Index of the target tetrahedron in `tets`.
    pub tet: u32,
    /// Index of the combination (contactor block, target tetrahedron).
    pub overlap: u32,
}

/// Pairs near contact, sorted by (triangle, target block, tetrahedron) so that sums have one order.
#[derive(Default)]
pub struct Candidates {
    /// All pairs.
    pub pairs: Vec<Pair>,
    /// Runs of pairs with one triangle and one target block.
    pub facets: Vec<Facet>,
    /// The distinct target tetrahedra, ascending.
    pub tets: Vec<TetId>,
    /// Their corners in the order of node numbers, on which neighbours agree.
    pub order: Vec<[u8; 4]>,
    /// The distinct (target tetrahedron, contactor block), block by block.
    pub overlaps: Vec<(TetId, BlockId)>,
    /// Whether facets end at the borders of target elements, too.
    pub split_by_element: bool,
    found: Vec<(TriangleId, TetId)>,
    slot_of: Vec<u32>,
    sorted: Vec<TetId>,
    /// First overlap of each contactor block.
    overlap_start: Vec<u32>,
    broad_phase: TreeBroadPhase,
    listed_at: Vec<Vec3>,
    skin_m: f64,
}

impl Candidates {
    /// The target tetrahedron of a pair.
    pub fn tet_of(&self, pair: u32) -> TetId {
        self.tets[self.pairs[pair as usize].tet as usize]
    }

    /// Makes the next update start anew.
    pub fn forget(&mut self) {
        self.listed_at.clear();
    }

    /// Brings the list up to date and says whether it changed: nothing to do while no node has moved by half the skin.
    pub fn update(&mut self, input: &ContactInput) -> bool {
        let reach = 0.5 * self.skin_m;
        let moved = |(x, y): (&Vec3, &Vec3)| (x - y).norm_squared() > reach * reach;
        if self.listed_at.len() == input.position.len()
            && !self.listed_at.iter().zip(input.position).any(moved)
        {
            return false;
        }
        self.listed_at.clear();
        self.listed_at.extend_from_slice(input.position);
        let scene =
            BroadScene { blocks: input.blocks, position: input.position, margin_m: self.margin(input) };
        self.broad_phase.find_pairs(&scene, &mut self.found);
        self.arrange(input);
        true
    }

    /// Half the skin, and the rounding of coordinates [m].
    fn margin(&mut self, input: &ContactInput) -> f64 {
        let (blocks, position) = (input.blocks, input.position);
        let diagonal = |t: &[NodeId; 3]| Aabb::around(t.iter().map(|n| &position[n.index()])).diagonal();
        let size = blocks.triangles.iter().map(diagonal).sum::<f64>() / blocks.triangles.len().max(1) as f64;
        let fastest = input.velocity.iter().map(|v| v.norm_squared()).fold(0.0, f64::max).sqrt();
        let travel = LASTING_STEPS * 2.0 * fastest * input.dt_s;
        self.skin_m = (SKIN * size).max(travel.min(size));
        let furthest = position.iter().map(|x| x.amax()).fold(0.0, f64::max);
        0.5 * self.skin_m + 8.0 * f64::EPSILON * furthest
    }

    /// Sorts the pairs and numbers what they share.
    fn arrange(&mut self, input: &ContactInput) {
        let (tet_block, triangle_block) = (&input.blocks.tet_block, &input.blocks.triangle_block);
        // Blocks are contiguous in tetrahedra, so this order is also by target block.
        self.found.sort_unstable();
        self.number_tets(input);
        self.number_overlaps(triangle_block);
        self.pairs.clear();
        self.facets.clear();
        for (i, found) in self.found.iter().enumerate() {
            let (triangle, tet_id) = *found;
            let tet = self.slot_of[tet_id.index()];
            let block = triangle_block[triangle.index()];
            let first = self.overlap_start[block.index()] as usize;
            let end = self.overlap_start.get(block.index() + 1).map_or(self.overlaps.len(), |&e| e as usize);
            let overlap = (first + self.overlaps[first..end].partition_point(|o| o.0 < tet_id)) as u32;
            self.pairs.push(Pair { triangle, tet, overlap });
            let target = tet_block[tet_id.index()];
            match self.facets.last_mut() {
                Some(last)
                    if last.triangle == triangle && last.target == target && !self.split_by_element =>
                {
                    last.pairs.end = i + 1
                }
                _ => self.facets.push(Facet { triangle, target, pairs: i..i + 1 }),
            }
        }
    }

    /// The distinct tetrahedra, ascending, and the place of each.
    fn number_tets(&mut self, input: &ContactInput) {
        self.slot_of.clear();
        self.slot_of.resize(input.blocks.tets.len(), u32::MAX);
        self.found.iter().for_each(|pair| self.slot_of[pair.1.index()] = 0);
        self.tets.clear();
        for (tet, slot) in self.slot_of.iter_mut().enumerate().filter(|(_, slot)| **slot == 0) {
            *slot = self.tets.len() as u32;
            self.tets.push(TetId(tet as u32));
        }
        self.order.clear();
        self.order.extend(self.tets.iter().map(|tet| {
            let mut order = [0, 1, 2, 3];
            order.sort_unstable_by_key(|&i: &u8| input.blocks.tets[tet.index()][usize::from(i)]);
            order
        }));
    }

    /// The distinct (tetrahedron, contactor block), block by block.
    fn number_overlaps(&mut self, triangle_block: &[BlockId]) {
        self.overlaps.clear();
        self.overlap_start.clear();
        let block_of = |pair: &(TriangleId, TetId)| triangle_block[pair.0.index()];
        for run in self.found.chunk_by(|a, b| block_of(a) == block_of(b)) {
            let block = block_of(&run[0]);
            self.overlap_start.resize(block.index() + 1, self.overlaps.len() as u32);
            self.sorted.clear();
            self.sorted.extend(run.iter().map(|pair| pair.1));
            self.sorted.sort_unstable();
            self.sorted.dedup();
            self.overlaps.extend(self.sorted.iter().map(|&tet| (tet, block)));
        }
    }
}
