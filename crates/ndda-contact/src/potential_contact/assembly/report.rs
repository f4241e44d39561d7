//! Reports of an evaluation of contact.

use std::sync::{Mutex, PoisonError};

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{TetId, TriangleId, Vec3};
use rayon::prelude::*;

use crate::broad_phase::candidates::Candidates;
use crate::integration::frames::Frames;
use crate::integration::integrals::Integrals;
use crate::integration::overlap_pair::{ActiveFacet, OverlapPair};
use crate::integration::pair_moments::{has_centroid, pair_energy};
use crate::integration::pair_report::OverlapReport;
use crate::model::{ContactError, ContactInput, ContactReport};
use crate::potential::contact_potential::PotentialField;

/// Facets in contact below which a second thread costs more than it brings.
const GRAIN_FACETS: usize = 512;

/// The pieces of a block in a tetrahedron, one of which has passed its centroid.
#[derive(Clone, Copy)]
struct PiecesPastCentroid {
    tet: TetId,
    /// The first triangle that has.
    triangle: TriangleId,
    /// How many such there are before it in the block.
    number: u32,
    /// Another has not: the centroid is outside.
    falls_short: bool,
    /// Of the potential, through all of them [m³].
    flux: f64,
    /// Of the tetrahedron [m³].
    volume_m3: f64,
}

/// Memory for reports, used again and again.
#[derive(Default)]
pub struct Reporter {
    /// One for each thread.
    scratch: Vec<Mutex<Vec<PiecesPastCentroid>>>,
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
        frames: &Frames,
        field: &PotentialField,
    ) -> Result<ContactReport, ContactError> {
        let mut report = ContactReport { candidate_pairs: candidates.pairs(), ..ContactReport::default() };
        let (mut all, mut action_reaction_error) = (OverlapReport::default(), 0.0f64);
        for chunk in integrals.chunks() {
            let part = &chunk.report;
            if let Some((triangle, tet)) = part.lost {
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
        report.deepest = all.deepest;
        if field.is_element() {
            report.past_centroid = self.past_centroid(input, integrals, frames);
        }
        Ok(report)
    }

    /// A pair whose triangle has passed the tetrahedron's centroid, if every piece of that block in it has: then the
    /// centroid is inside the block, and the element potential no longer pushes out. The first such pair of all.
    fn past_centroid(
        &mut self,
        input: &ContactInput,
        integrals: &Integrals,
        frames: &Frames,
    ) -> Option<(TriangleId, TetId)> {
        let threads = rayon::current_num_threads().max(self.scratch.len());
        self.scratch.resize_with(threads, Mutex::default);
        let scratch = &self.scratch;
        let find = |touching: &[ActiveFacet]| {
            let own = &scratch[rayon::current_thread_index().unwrap_or(0)];
            let passed = &mut *own.lock().unwrap_or_else(PoisonError::into_inner);
            let scene = Pieces { input, integrals, frames, touching };
            scene.past_centroid(passed)
        };
        let of_one_block = |a: &ActiveFacet, b: &ActiveFacet| a.owner == b.owner;
        let touching = integrals.touching();
        if touching.len() > GRAIN_FACETS {
            touching.par_chunk_by(of_one_block).find_map_first(find)
        } else {
            touching.chunk_by(of_one_block).find_map(find)
        }
    }
}

/// The facets of one block that touch.
struct Pieces<'a> {
    input: &'a ContactInput<'a>,
    integrals: &'a Integrals,
    frames: &'a Frames,
    touching: &'a [ActiveFacet],
}

impl Pieces<'_> {
    fn past_centroid(&self, passed: &mut Vec<PiecesPastCentroid>) -> Option<(TriangleId, TetId)> {
        passed.clear();
        let mut number = 0;
        self.each(|triangle, _, hit, has_passed| {
            if has_passed(hit) {
                let (tet, falls_short) = (hit.tet, false);
                passed.push(PiecesPastCentroid {
                    tet,
                    triangle,
                    number,
                    falls_short,
                    flux: 0.0,
                    volume_m3: 0.0,
                });
                number += 1;
            }
        });
        if passed.is_empty() {
            return None;
        }
        passed.sort_unstable_by_key(|piece| (piece.tet, piece.number));
        passed.dedup_by_key(|piece| piece.tet);
        self.each(|_, _, hit, has_passed| {
            if let Ok(place) = passed.binary_search_by_key(&hit.tet, |piece| piece.tet) {
                passed[place].falls_short |= !passed[place].falls_short && !has_passed(hit);
            }
        });
        passed.retain(|piece| !piece.falls_short);
        self.each(|_, corners, hit, _| {
            if let Ok(place) = passed.binary_search_by_key(&hit.tet, |piece| piece.tet) {
                let frame = self.frames.at(hit.slot);
                passed[place].flux += pair_energy(corners, &triangle_area_vector(corners), frame);
                passed[place].volume_m3 = frame.volume_m3;
            }
        });
        // Faces that only just touch have pieces made of rounding, on any side: the integral decides.
        let is_in = |piece: &&PiecesPastCentroid| has_centroid(piece.flux, piece.volume_m3);
        let first = passed.iter().filter(is_in).min_by_key(|piece| piece.number)?;
        Some((first.triangle, first.tet))
    }

    /// Visits all hits with their triangle and its corners, and says whether that has passed the centroid.
    fn each(
        &self,
        mut visit: impl FnMut(TriangleId, &[Vec3; 3], &OverlapPair, &dyn Fn(&OverlapPair) -> bool),
    ) {
        for touch in self.touching {
            let corners = self.input.blocks.triangle_corners(touch.triangle, self.input.position);
            let area_vector = triangle_area_vector(&corners);
            let has_passed = |hit: &OverlapPair| {
                self.frames.at(hit.slot).centroid_distance(&corners[0], &area_vector) > 0.0
            };
            for hit in self.integrals.overlaps_of(touch) {
                visit(touch.triangle, &corners, hit, &has_passed);
            }
        }
    }
}
