//! Balance and depth of the pairs of a chunk.

use ndda_mesh::TetId;
use ndda_mesh::geometry::triangle_area_vector;

use crate::integration::overlap_pair::OverlapPair;
use crate::integration::scene::Scene;
use crate::potential::contact_potential::PotentialField;

/// Report on a number of overlapping pairs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct OverlapReport {
    /// Difference of action and reaction over either.
    pub(crate) action_reaction_error: f64,
    pub(crate) max_penetration_ratio: f64,
    /// In [`Candidates::pairs`]: the deepest, and the first whose force is not a number.
    pub(crate) deepest: Option<u32>,
    pub(crate) lost: Option<u32>,
}

impl OverlapReport {
    /// Takes in a hit of this largest φ.
    #[inline]
    pub(crate) fn add(&mut self, overlap: &OverlapPair, depth: f64, scene: &Scene) {
        let on_contactor: f64 = overlap.pressure.iter().sum();
        let on_target: f64 = overlap.on_target.pressure.iter().sum();
        if !on_contactor.is_finite() || !on_target.is_finite() {
            self.lost = self.lost.or(Some(overlap.pair));
            return;
        }
        // Nodal forces of a grazing pair may cancel: their sizes are what rounding is relative to.
        let scale: f64 = overlap.pressure.iter().map(|w| w.abs()).sum();
        if scale > 0.0 {
            let error = (on_contactor - on_target).abs() / scale;
            self.action_reaction_error = self.action_reaction_error.max(error);
        }
        self.look_at(overlap.pair, penetration_ratio(scene, overlap.tet, depth));
    }

    pub(crate) fn look_at(&mut self, pair: u32, ratio: f64) {
        if self.deepest.is_none() || ratio > self.max_penetration_ratio {
            (self.max_penetration_ratio, self.deepest) = (ratio, Some(pair));
        }
    }
}

/// The hits whose triangle has passed the centroid of the tetrahedron, in their order.
pub(crate) fn list_past_centroid(overlaps: &[OverlapPair], scene: &Scene, past: &mut Vec<u32>) {
    past.clear();
    past.reserve(overlaps.len());
    let has_passed = |overlap: &&OverlapPair| {
        let pair = &scene.candidates.pairs[overlap.pair as usize];
        let corners = scene.blocks.triangle_corners(pair.triangle, scene.position);
        let frame = &scene.frames[pair.tet as usize];
        frame.centroid_distance(&corners[0], &triangle_area_vector(&corners)) > 0.0
    };
    past.extend(overlaps.iter().filter(has_passed).map(|overlap| overlap.pair));
}

/// Depth over the height of the tetrahedron, or of the block that is an affine convex target. For the element potential φ = 4 λ, and λ is
/// that ratio.
fn penetration_ratio(scene: &Scene, tet: TetId, depth: f64) -> f64 {
    let most = match (scene.hulls.affine_target(scene.blocks.tet_block[tet.index()]), scene.field) {
        (Some(whole), _) => whole.most_phi,
        (None, PotentialField::Pieces(table)) => table.most_in(tet),
        (None, PotentialField::Function(field)) => field.function.most_in(tet),
        (None, PotentialField::Element) => 4.0,
    };
    if most > 0.0 { depth / most } else { 0.0 }
}
