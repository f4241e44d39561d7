//! Part of each block in the energies of its contacts under the element potential.

use std::ops::Range;

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, TetId};

use crate::assembly::overlap_parts::OverlapParts;
use crate::integration::frames::FrameCache;
use crate::integration::pair_moments::{has_centroid, pair_energy};
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
    /// Pieces of the surface of one block that have a flux.
    pieces: Vec<Piece>,
    frames: FrameCache,
}

/// The part of a triangle in a tetrahedron.
struct Piece {
    tet: TetId,
    /// Its number, in the order of triangles.
    number: u32,
    /// Pair of blocks in [`Candidates::neighbours`].
    pair: u32,
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
        for block in blocks.map(|block| BlockId(block as u32)) {
            scratch.list_pieces(input, parts, block);
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
    fn list_pieces(&mut self, input: &ContactInput, parts: &OverlapParts, block: BlockId) {
        let OverlapParts { candidates, frames: placed, hulls, .. } = *parts;
        let Self { pieces, frames } = self;
        pieces.clear();
        let mut last = None;
        let (mut corners, mut area_vector) = Default::default();
        for facet in candidates.facets_of(block) {
            // Facets of one triangle follow each other.
            if last != Some(facet.triangle) {
                corners = input.blocks.triangle_corners(facet.triangle, input.position);
                area_vector = triangle_area_vector(&corners);
                last = Some(facet.triangle);
            }
            let shift = hulls.may_touch(facet.target).then(|| placed.shift_of(facet.target));
            for tet in facet.tets() {
                let frame = match shift {
                    Some(shift) => placed.at(candidates.slot_of(tet).wrapping_add(shift)),
                    None => frames.of(tet, candidates, input),
                };
                if frame.lambda_inside(&corners).is_some() {
                    let flux_m3 = pair_energy(&corners, &area_vector, frame);
                    if flux_m3 != 0.0 {
                        let (number, pair, volume_m3) =
                            (pieces.len() as u32, facet.neighbours, frame.volume_m3);
                        pieces.push(Piece { tet, number, pair, flux_m3, volume_m3 });
                    }
                }
            }
        }
    }
}
