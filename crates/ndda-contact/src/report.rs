//! What an evaluation of contact tells of itself.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{TetId, TriangleId};

use crate::candidates::Candidates;
use crate::energy::has_centroid;
use crate::integrals::{Hit, Integrals, Scene};
use crate::model::{ContactError, ContactInput, ContactReport};
use crate::pair::{TetFrame, pair_energy};
use crate::potential::Field;

/// The pieces of a block in a tetrahedron, one of which has passed its centroid.
struct Passed {
    /// One that has, in [`Candidates::pairs`].
    pair: u32,
    /// Another has not: the centroid is outside.
    falls_short: bool,
    /// Of the potential, through all of them [m³].
    flux: f64,
}

/// What some hits tell of themselves.
#[derive(Clone, Copy, Debug, Default)]
pub struct HitReport {
    /// Difference of action and reaction over either.
    action_reaction_error: f64,
    max_penetration_ratio: f64,
    /// In [`Candidates::pairs`]: the deepest, and the first whose force is not a number.
    deepest: Option<u32>,
    lost: Option<u32>,
}

impl HitReport {
    /// Takes in a hit of this largest φ.
    #[inline]
    pub fn add(&mut self, hit: &Hit, depth: f64, scene: &Scene) {
        let on_contactor: f64 = hit.pressure.iter().sum();
        let on_target: f64 = hit.on_target.pressure.iter().sum();
        if !on_contactor.is_finite() || !on_target.is_finite() {
            self.lost = self.lost.or(Some(hit.pair));
            return;
        }
        // Nodal forces of a grazing pair may cancel: their sizes are what rounding is relative to.
        let scale: f64 = hit.pressure.iter().map(|w| w.abs()).sum();
        if scale > 0.0 {
            let error = (on_contactor - on_target).abs() / scale;
            self.action_reaction_error = self.action_reaction_error.max(error);
        }
        self.look_at(hit.pair, penetration_ratio(scene, hit.tet, depth));
    }

    fn look_at(&mut self, pair: u32, ratio: f64) {
        if self.deepest.is_none() || ratio > self.max_penetration_ratio {
            (self.max_penetration_ratio, self.deepest) = (ratio, Some(pair));
        }
    }
}

/// Memory for reports, used again and again.
#[derive(Default)]
pub struct Reporter {
    passed: Vec<Passed>,
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
        field: &Field,
    ) -> Result<ContactReport, ContactError> {
        let mut report =
            ContactReport { candidate_pairs: candidates.pairs.len(), ..ContactReport::default() };
        let place = |pair: u32| (candidates.pairs[pair as usize].triangle, candidates.tet_of(pair));
        let mut all = HitReport::default();
        for chunk in integrals.chunks() {
            let part = &chunk.report;
            if let Some((triangle, tet)) = part.lost.map(place) {
                return Err(ContactError::NotFinite { triangle, tet });
            }
            report.contact_pairs += chunk.hits.len();
            report.action_reaction_error = report.action_reaction_error.max(part.action_reaction_error);
            if let Some(deepest) = part.deepest {
                all.look_at(deepest, part.max_penetration_ratio);
            }
        }
        report.max_penetration_ratio = all.max_penetration_ratio;
        report.deepest = all.deepest.map(place);
        if *field == Field::Element {
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
        self.list_passed(candidates, integrals);
        let Self { passed, place_of } = self;
        if passed.is_empty() {
            return None;
        }
        let overlap_of = |pair: u32| candidates.pairs[pair as usize].overlap as usize;
        let place_at = |hit: &Hit| place_of[overlap_of(hit.pair)].checked_sub(1).map(|place| place as usize);
        for chunk in integrals.chunks() {
            let mut past = chunk.past.iter().peekable();
            for hit in &chunk.hits {
                let has_passed = past.next_if_eq(&&hit.pair).is_some();
                if let Some(place) = place_at(hit) {
                    passed[place].falls_short |= !has_passed;
                }
            }
        }
        for hit in integrals.chunks().iter().flat_map(|chunk| &chunk.hits) {
            let Some(place) = place_at(hit).filter(|&place| !passed[place].falls_short) else { continue };
            let pair = &candidates.pairs[hit.pair as usize];
            let corners = input.blocks.triangle_corners(pair.triangle, input.position);
            let frame = &frames[pair.tet as usize];
            passed[place].flux += pair_energy(&corners, &triangle_area_vector(&corners), frame);
        }
        passed.iter().for_each(|found| place_of[overlap_of(found.pair)] = 0);
        // Faces that only just touch have pieces made of rounding, on any side: the integral tells.
        let frame_of = |pair: u32| &frames[candidates.pairs[pair as usize].tet as usize];
        let is_in = |p: &&Passed| !p.falls_short && has_centroid(p.flux, frame_of(p.pair).volume_m3);
        let past = passed.iter().find(is_in)?.pair;
        Some((candidates.pairs[past as usize].triangle, candidates.tet_of(past)))
    }

    /// The overlaps of which a piece has passed the centroid.
    fn list_passed(&mut self, candidates: &Candidates, integrals: &Integrals) {
        self.passed.clear();
        self.place_of.resize(candidates.overlaps.len(), 0);
        for &pair in integrals.chunks().iter().flat_map(|chunk| &chunk.past) {
            let place = &mut self.place_of[candidates.pairs[pair as usize].overlap as usize];
            if *place == 0 {
                self.passed.push(Passed { pair, falls_short: false, flux: 0.0 });
                *place = self.passed.len() as u32;
            }
        }
    }
}

/// The hits whose triangle has passed the centroid of the tetrahedron, in their order.
pub fn list_past_centroid(hits: &[Hit], scene: &Scene, past: &mut Vec<u32>) {
    past.clear();
    past.reserve(hits.len());
    let has_passed = |hit: &&Hit| {
        let pair = &scene.candidates.pairs[hit.pair as usize];
        let corners = scene.blocks.triangle_corners(pair.triangle, scene.position);
        let frame = &scene.frames[pair.tet as usize];
        frame.centroid_distance(&corners[0], &triangle_area_vector(&corners)) > 0.0
    };
    past.extend(hits.iter().filter(has_passed).map(|hit| hit.pair));
}

/// Depth over the height of the tetrahedron, or of the block that is taken whole. For the element potential φ = 4 λ, and λ is
/// that ratio.
fn penetration_ratio(scene: &Scene, tet: TetId, depth: f64) -> f64 {
    let most = match (scene.hulls.whole(scene.blocks.tet_block[tet.index()]), scene.field) {
        (Some(whole), _) => whole.most_phi,
        (None, Field::Pieces(table)) => table.most_in(tet),
        (None, Field::Element) => 4.0,
    };
    if most > 0.0 { depth / most } else { 0.0 }
}
