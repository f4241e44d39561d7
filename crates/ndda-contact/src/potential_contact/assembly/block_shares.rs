//! Part of each block in the energies of its contacts under the element potential.

use std::ops::Range;

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, TetId};

use crate::broad_phase::candidates::Candidates;
use crate::integration::pair_moments::{has_centroid, pair_energy};
use crate::integration::tet_frame::TetFrame;
use crate::model::ContactInput;

/// Blocks whose shares are found by one thread.
pub(super) const SHARE_BLOCKS: usize = 16;

/// ∫ φ dV over the parts of tetrahedra of other blocks that are in some blocks.
#[derive(Default)]
pub(super) struct BlockShares {
    /// Pair of blocks in [`Candidates::neighbours`], and the share of one tetrahedron [m³]; by block, then by tetrahedron.
    pub(super) of_pair: Vec<(u32, f64)>,
    /// Pieces of the surface of one block that have a flux.
    pieces: Vec<Piece>,
}

/// The part of a triangle in a tetrahedron.
struct Piece {
    tet: TetId,
    /// Its number, in the order of triangles.
    number: u32,
    /// Pair of blocks in [`Candidates::neighbours`].
    pair: u32,
    flux_m3: f64,
}

impl BlockShares {
    /// Finds the shares of these blocks. What adds nothing is left out.
    pub(super) fn integrate(
        &mut self,
        input: &ContactInput,
        candidates: &Candidates,
        frames: &[TetFrame],
        blocks: Range<usize>,
    ) {
        self.of_pair.clear();
        for block in blocks {
            self.list_pieces(input, candidates, frames, BlockId(block as u32));
            self.pieces.sort_unstable_by_key(|piece| (piece.tet, piece.number));
            for pieces in self.pieces.chunk_by(|a, b| a.tet == b.tet) {
                let Piece { tet, pair, .. } = pieces[0];
                let integral = pieces.iter().fold(0.0, |sum, piece| sum + piece.flux_m3);
                let volume_m3 = frames[candidates.slot_of(tet) as usize].volume_m3;
                // ∫ φ over the whole tetrahedron is V/4: that is what a contained centroid leaves out.
                let missing = if has_centroid(integral, volume_m3) { 0.25 * volume_m3 } else { 0.0 };
                self.of_pair.push((pair, integral + missing));
            }
        }
    }

    fn list_pieces(
        &mut self,
        input: &ContactInput,
        candidates: &Candidates,
        frames: &[TetFrame],
        block: BlockId,
    ) {
        self.pieces.clear();
        let mut last = None;
        let (mut corners, mut area_vector) = Default::default();
        for facet in candidates.facets_of(block) {
            // Facets of one triangle follow each other.
            if last != Some(facet.triangle) {
                corners = input.blocks.triangle_corners(facet.triangle, input.position);
                area_vector = triangle_area_vector(&corners);
                last = Some(facet.triangle);
            }
            for tet in facet.tets() {
                let frame = &frames[candidates.slot_of(tet) as usize];
                if frame.lambda_inside(&corners).is_some() {
                    let flux_m3 = pair_energy(&corners, &area_vector, frame);
                    if flux_m3 != 0.0 {
                        let number = self.pieces.len() as u32;
                        self.pieces.push(Piece { tet, number, pair: facet.neighbours, flux_m3 });
                    }
                }
            }
        }
    }
}
