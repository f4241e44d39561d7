//! Part of each block in the energies of its contacts under the element potential.

use std::ops::Range;

use ndda_mesh::{BlockId, TetId};
use pulp::Arch;

use crate::assembly::overlap_parts::OverlapParts;
use crate::integration::chunk_parts::Triangle;
use crate::integration::fluxes::FluxQueue;
use crate::integration::pair_moments::has_centroid;
use crate::integration::scene::Scene;
use crate::model::ContactInput;

/// Blocks whose shares are found by one thread.
pub(super) const SHARE_BLOCKS: usize = 16;

/// ∫ φ dV over the parts of tetrahedra of other blocks that are in some blocks.
#[derive(Default)]
pub(super) struct BlockShares {
    /// Pair of blocks in [`Candidates::neighbours`], whether the block is the second of it, and its share [m³]; by block, then by the other block.
    pub(super) of_pair: Vec<(u32, bool, f64)>,
}

/// Scratch memory of a thread.
#[derive(Default)]
pub(super) struct ShareScratch {
    /// Pieces of the surface of one block.
    pieces: Vec<Piece>,
    fluxes: FluxQueue,
}

/// The part of a triangle in a tetrahedron.
struct Piece {
    tet: TetId,
    /// Its number, in the order of triangles.
    number: u32,
    /// Pair of blocks in [`Candidates::neighbours`].
    pair: u32,
    /// Area of the triangle times the distance of its plane from the centroid.
    height_m3: f64,
    flux_m3: f64,
    /// Volume of the tetrahedron [m³].
    volume_m3: f64,
}

impl BlockShares {
    /// Finds the shares of these blocks. What adds nothing is left out.
    pub(super) fn integrate(
        &mut self,
        input: &ContactInput,
        parts: &OverlapParts,
        blocks: Range<usize>,
        scratch: &mut ShareScratch,
    ) {
        self.of_pair.clear();
        let (arch, scene) = (Arch::new(), parts.scene(input));
        let has_facets = |block: BlockId| !parts.candidates.numbers_of(block).is_empty();
        let may_touch = |block: &BlockId| has_facets(*block) && parts.hulls.may_touch(*block);
        for block in blocks.map(|block| BlockId(block as u32)).filter(may_touch) {
            scratch.list_pieces(arch, &scene, block);
            scratch.pieces.sort_unstable_by_key(|piece| (piece.tet, piece.number));
            for pieces in scratch.pieces.chunk_by(|a, b| a.tet == b.tet) {
                let Piece { pair, volume_m3, .. } = pieces[0];
                let integral = pieces.iter().fold(0.0, |sum, piece| sum + piece.flux_m3);
                // ∫ φ over the whole tetrahedron is V/4: that is what a contained centroid leaves out.
                let missing = if has_centroid(integral, volume_m3) { 0.25 * volume_m3 } else { 0.0 };
                let is_second = parts.candidates.neighbours[pair as usize].1 == block;
                let share_m3 = integral + missing;
                // The tetrahedra of another block follow each other.
                match self.of_pair.last_mut().filter(|last| (last.0, last.1) == (pair, is_second)) {
                    Some((_, _, sum_m3)) => *sum_m3 += share_m3,
                    None => self.of_pair.push((pair, is_second, share_m3)),
                }
            }
        }
    }
}

impl ShareScratch {
    /// The pieces of a block that have a flux.
    fn list_pieces(&mut self, arch: Arch, scene: &Scene, block: BlockId) {
        let Self { pieces, fluxes } = self;
        pieces.clear();
        let (mut last, mut triangle) = (None, Triangle::default());
        let candidates = scene.candidates;
        let near = |neighbours| !scene.hulls.are_apart(neighbours);
        for facet in candidates.facets_that(block, candidates.numbers_of(block), near) {
            // Facets of one triangle follow each other.
            if last != Some(facet.triangle) {
                (last, triangle) = (Some(facet.triangle), Triangle::new(scene, facet.triangle));
            }
            let Triangle { corners, normal, area } = &triangle;
            if *area == 0.0 {
                continue;
            }
            scene.each_near_tet(arch, &facet, (corners, normal), |tet, _, frame, lambda| {
                let (number, pair, volume_m3) = (pieces.len() as u32, facet.neighbours, frame.volume_m3);
                fluxes.push(arch, number, lambda);
                let height_m3 = area * frame.centroid_distance(&corners[0], normal);
                pieces.push(Piece { tet, number, pair, height_m3, flux_m3: 0.0, volume_m3 });
            });
        }
        fluxes.finish(arch, |piece, mean| {
            let piece = &mut pieces[piece as usize];
            piece.flux_m3 += mean * piece.height_m3;
        });
        pieces.retain(|piece| piece.flux_m3 != 0.0);
    }
}
