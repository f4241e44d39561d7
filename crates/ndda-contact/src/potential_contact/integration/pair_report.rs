//! Balance and depth of the pairs of a chunk.

use ndda_mesh::{TetId, TriangleId};

use crate::integration::overlap_pair::OverlapPair;
use crate::integration::pair_moments::PairMoments;
use crate::integration::scene::Scene;
use crate::potential::contact_potential::PotentialField;

/// Report on a number of overlapping pairs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct OverlapReport {
    /// Difference of action and reaction over either.
    pub(crate) action_reaction_error: f64,
    pub(crate) max_penetration_ratio: f64,
    /// The deepest, and the first whose force is not a number.
    pub(crate) deepest: Option<(TriangleId, TetId)>,
    pub(crate) lost: Option<(TriangleId, TetId)>,
}

impl OverlapReport {
    /// Takes in a hit of a triangle, whose own integrals these are.
    #[inline]
    pub(crate) fn add(
        &mut self,
        triangle: TriangleId,
        overlap: &OverlapPair,
        own: &PairMoments,
        scene: &Scene,
    ) {
        let on_contactor: f64 = own.pressure.iter().sum();
        let on_target: f64 = overlap.on_target.pressure.iter().sum();
        if !on_contactor.is_finite() || !on_target.is_finite() {
            self.lost = self.lost.or(Some((triangle, overlap.tet)));
            return;
        }
        // Nodal forces of a grazing pair may cancel: their sizes are what rounding is relative to.
        let scale: f64 = own.pressure.iter().map(|w| w.abs()).sum();
        if scale > 0.0 {
            let error = (on_contactor - on_target).abs() / scale;
            self.action_reaction_error = self.action_reaction_error.max(error);
        }
        self.look_at((triangle, overlap.tet), penetration_ratio(scene, overlap.tet, own.depth));
    }

    pub(crate) fn look_at(&mut self, pair: (TriangleId, TetId), ratio: f64) {
        if self.deepest.is_none() || ratio > self.max_penetration_ratio {
            (self.max_penetration_ratio, self.deepest) = (ratio, Some(pair));
        }
    }
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
