//! What an evaluation of contact tells of itself.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{TetId, TriangleId};

use crate::candidates::Candidates;
use crate::energy::has_centroid;
use crate::integrals::{Hit, Integrals, Scene};
use crate::model::{ContactError, ContactInput, ContactReport};
use crate::pair::{TetFrame, pair_energy};
use crate::potential::Field;

/// On which sides of a tetrahedron's centroid the pieces of another block are.
#[derive(Clone, Copy, Default, PartialEq)]
enum Reach {
    #[default]
    Nowhere,
    /// The triangle has passed the centroid.
    Past(u32),
    /// A triangle is between: the centroid is outside.
    Short,
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
    /// The report on some hits.
    pub fn of(hits: &[Hit], scene: &Scene) -> Self {
        let mut report = Self::default();
        for hit in hits {
            let on_contactor = hit.moments.total();
            let on_target: f64 = hit.moments.target_pressure.iter().sum();
            if !on_contactor.is_finite() || !on_target.is_finite() {
                report.lost = Some(hit.pair);
                break;
            }
            // Nodal forces of a grazing pair may cancel: their sizes are what rounding is relative to.
            let scale: f64 = hit.moments.pressure.iter().map(|w| w.abs()).sum();
            if scale > 0.0 {
                let error = (on_contactor - on_target).abs() / scale;
                report.action_reaction_error = report.action_reaction_error.max(error);
            }
            report.look_at(hit.pair, penetration_ratio(scene, hit));
        }
        report
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
    reach: Vec<Reach>,
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
        self.reach.clear();
        self.reach.resize(candidates.overlaps.len(), Reach::Nowhere);
        for hit in hits(integrals) {
            let pair = &candidates.pairs[hit.pair as usize];
            let corners = input.blocks.triangle_corners(pair.triangle, input.position);
            let normal = triangle_area_vector(&corners);
            let distance = frames[pair.tet as usize].centroid_distance(&corners[0], &normal);
            let reach = &mut self.reach[pair.overlap as usize];
            *reach = match *reach {
                Reach::Short => Reach::Short,
                _ if distance <= 0.0 => Reach::Short,
                _ => Reach::Past(hit.pair),
            };
        }
        // Faces that only just touch have pieces made of rounding, on any side: the integral tells.
        let swallowed = |pair: u32| {
            let pair = &candidates.pairs[pair as usize];
            let frame = &frames[pair.tet as usize];
            let flux = |hit: &Hit| {
                let other = &candidates.pairs[hit.pair as usize];
                let corners = input.blocks.triangle_corners(other.triangle, input.position);
                pair_energy(&corners, &triangle_area_vector(&corners), frame)
            };
            let pieces =
                hits(integrals).filter(|hit| candidates.pairs[hit.pair as usize].overlap == pair.overlap);
            has_centroid(pieces.map(flux).sum(), frame.volume_m3)
        };
        let past = self.reach.iter().find_map(|reach| match reach {
            Reach::Past(pair) if swallowed(*pair) => Some(*pair),
            _ => None,
        })?;
        Some((candidates.pairs[past as usize].triangle, candidates.tet_of(past)))
    }
}

/// The pairs that overlap.
fn hits(integrals: &Integrals) -> impl Iterator<Item = &Hit> {
    integrals.chunks().iter().flat_map(|chunk| &chunk.hits)
}

/// Depth over the height of the tetrahedron, or of the block that is taken whole. For the element potential φ = 4 λ, and λ is
/// that ratio.
fn penetration_ratio(scene: &Scene, hit: &Hit) -> f64 {
    let tet = scene.candidates.tet_of(hit.pair);
    let most = match (scene.hulls.whole(scene.blocks.tet_block[tet.index()]), scene.field) {
        (Some(whole), _) => whole.most_phi,
        (None, Field::Pieces(table)) => table.of(tet).iter().flatten().copied().fold(0.0, f64::max),
        (None, Field::Element) => 4.0,
    };
    if most > 0.0 { hit.moments.depth / most } else { 0.0 }
}
