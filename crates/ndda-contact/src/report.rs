//! What an evaluation of contact tells of itself.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{TetId, TriangleId};

use crate::candidates::Candidates;
use crate::energy::has_centroid;
use crate::integrals::{Hit, Integrals};
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
        for hit in hits(integrals) {
            let (triangle, tet) = (candidates.pairs[hit.pair as usize].triangle, candidates.tet_of(hit.pair));
            let on_contactor = hit.moments.total();
            let on_target: f64 = hit.moments.target_pressure.iter().sum();
            if !on_contactor.is_finite() || !on_target.is_finite() {
                return Err(ContactError::NotFinite { triangle, tet });
            }
            report.contact_pairs += 1;
            // Nodal forces of a grazing pair may cancel: their sizes are what rounding is relative to.
            let scale: f64 = hit.moments.pressure.iter().map(|w| w.abs()).sum();
            if scale > 0.0 {
                let error = (on_contactor - on_target).abs() / scale;
                report.action_reaction_error = report.action_reaction_error.max(error);
            }
            let ratio = penetration_ratio(field, tet, hit.moments.depth);
            if report.deepest.is_none() || ratio > report.max_penetration_ratio {
                report.max_penetration_ratio = ratio;
                report.deepest = Some((triangle, tet));
            }
        }
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
    integrals.chunks().iter().flat_map(|chunk| &chunk.hits).filter(|hit| hit.moments.area > 0.0)
}

/// Depth over the height of the tetrahedron. For the element potential φ = 4 λ, and λ is that ratio.
fn penetration_ratio(field: &Field, tet: TetId, phi: f64) -> f64 {
    match field {
        Field::Pieces(table) => {
            let most = table.of(tet).iter().flatten().copied().fold(0.0, f64::max);
            if most > 0.0 { phi / most } else { 0.0 }
        }
        Field::Element => 0.25 * phi,
    }
}
