//! Reports of an evaluation of contact.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{TetId, TriangleId};

use crate::broad_phase::candidates::Candidates;
use crate::integration::integrals::Integrals;
use crate::integration::overlap_pair::OverlapPair;
use crate::integration::pair_moments::{has_centroid, pair_energy};
use crate::integration::pair_report::OverlapReport;
use crate::integration::tet_frame::TetFrame;
use crate::model::{ContactError, ContactInput, ContactReport};
use crate::potential::contact_potential::PotentialField;

/// The pieces of a block in a tetrahedron, one of which has passed its centroid.
struct PiecesPastCentroid {
    /// One that has, in [`Candidates::pairs`].
    pair: u32,
    /// Another has not: the centroid is outside.
    falls_short: bool,
    /// Of the potential, through all of them [m³].
    flux: f64,
}

/// Memory for reports, used again and again.
#[derive(Default)]
pub struct Reporter {
    passed: Vec<PiecesPastCentroid>,
    /// Of each of [`Candidates::overlaps`], its place in `passed`, from one; zero for those without.
    place_of: Vec<u32>,
}

impl Reporter {
    /// Counts, the deepest pair, and whether action is reaction.
    ///
    /// # Errors
    /// [`ContactError::NotFinite`] naming the pair whose force is not a number.
    pub fn report(
        &mut self,
        input: &ContactInput,
        candidates: &Candidates,
        integrals: &Integrals,
        frames: &[TetFrame],
        field: &PotentialField,
    ) -> Result<ContactReport, ContactError> {
        let mut report =
            ContactReport { candidate_pairs: candidates.pairs.len(), ..ContactReport::default() };
        let place = |pair: u32| (candidates.pairs[pair as usize].triangle, candidates.tet_of(pair));
        let (mut all, mut action_reaction_error) = (OverlapReport::default(), 0.0f64);
        for chunk in integrals.chunks() {
            let part = &chunk.report;
            if let Some((triangle, tet)) = part.lost.map(place) {
                return Err(ContactError::NotFinite { triangle, tet });
            }
            report.contact_pairs += chunk.overlaps.len();
            action_reaction_error = action_reaction_error.max(part.action_reaction_error);
            if let Some(deepest) = part.deepest {
                all.look_at(deepest, part.max_penetration_ratio);
            }
        }
        report.action_reaction_error = Some(action_reaction_error);
        report.max_penetration_ratio = all.max_penetration_ratio;
        report.deepest = all.deepest.map(place);
        if field.is_element() {
            report.past_centroid = self.past_centroid(input, candidates, integrals, frames);
        }
        Ok(report)
    }

    /// A pair whose triangle has passed the tetrahedron's centroid, if every piece of that block in it has: then the
    /// centroid is inside the block, and the element potential no longer pushes out.
    fn past_centroid(
        &mut self,
        input: &ContactInput,
        candidates: &Candidates,
        integrals: &Integrals,
        frames: &[TetFrame],
    ) -> Option<(TriangleId, TetId)> {
        self.list_pieces_past_centroid(candidates, integrals);
        let Self { passed, place_of } = self;
        if passed.is_empty() {
            return None;
        }
        let overlap_of = |pair: u32| candidates.pairs[pair as usize].overlap as usize;
        let place_at = |overlap: &OverlapPair| {
            place_of[overlap_of(overlap.pair)].checked_sub(1).map(|place| place as usize)
        };
        for chunk in integrals.chunks() {
            let mut past = chunk.past.iter().peekable();
            for overlap in &chunk.overlaps {
                let has_passed = past.next_if_eq(&&overlap.pair).is_some();
                if let Some(place) = place_at(overlap) {
                    passed[place].falls_short |= !has_passed;
                }
            }
        }
        for overlap in integrals.chunks().iter().flat_map(|chunk| &chunk.overlaps) {
            let Some(place) = place_at(overlap).filter(|&place| !passed[place].falls_short) else { continue };
            let pair = &candidates.pairs[overlap.pair as usize];
            let corners = input.blocks.triangle_corners(pair.triangle, input.position);
            let frame = &frames[pair.tet as usize];
            passed[place].flux += pair_energy(&corners, &triangle_area_vector(&corners), frame);
        }
        passed.iter().for_each(|found| place_of[overlap_of(found.pair)] = 0);
        // Faces that only just touch have pieces made of rounding, on any side: the integral decides.
        let frame_of = |pair: u32| &frames[candidates.pairs[pair as usize].tet as usize];
        let is_in =
            |p: &&PiecesPastCentroid| !p.falls_short && has_centroid(p.flux, frame_of(p.pair).volume_m3);
        let past = passed.iter().find(is_in)?.pair;
        Some((candidates.pairs[past as usize].triangle, candidates.tet_of(past)))
    }

    /// The overlaps of which a piece has passed the centroid.
    fn list_pieces_past_centroid(&mut self, candidates: &Candidates, integrals: &Integrals) {
        self.passed.clear();
        self.place_of.resize(candidates.overlaps.len(), 0);
        for &pair in integrals.chunks().iter().flat_map(|chunk| &chunk.past) {
            let place = &mut self.place_of[candidates.pairs[pair as usize].overlap as usize];
            if *place == 0 {
                self.passed.push(PiecesPastCentroid { pair, falls_short: false, flux: 0.0 });
                *place = self.passed.len() as u32;
            }
        }
    }
}
