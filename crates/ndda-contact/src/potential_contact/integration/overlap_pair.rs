//! Results of the integration: pairs that overlap, and facets that touch.

use ndda_mesh::{BlockId, TetId, TriangleId, Vec3};

use crate::integration::pair_moments::{OnTarget, PairMoments};

/// A candidate pair that does overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverlapPair {
    /// Its tetrahedron.
    pub tet: TetId,
    /// Place of its frame in [`Frames`](crate::integration::frames::Frames).
    pub slot: u32,
    /// ∫ φ ψ_a dA [m²].
    pub pressure: [f64; 3],
    /// Reaction on the target's nodes.
    pub on_target: OnTarget,
}

/// Sums over the overlapping pairs of a facet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FacetMoments {
    /// ∫ φ dA [m²].
    pub pressure: f64,
    /// ∫ φ ψ_a dA [m²].
    pub weights: [f64; 3],
    /// ∫ |∂φ/∂n| ψ_a dA [m].
    pub slope: [f64; 3],
    /// Area that touches [m²].
    pub area: f64,
}

impl FacetMoments {
    #[inline(always)]
    pub(super) fn add(&mut self, moments: &PairMoments) {
        self.pressure += moments.total();
        self.area += moments.area;
        for a in 0..3 {
            self.weights[a] += moments.pressure[a];
            self.slope[a] += moments.slope[a];
        }
    }

    /// ∫ |∂φ/∂n| dA [m] where friction is spread by area, ∫ φ dA [m²] where by pressure.
    pub(crate) fn friction_weight(&self, by_area: bool) -> f64 {
        if by_area { self.slope.iter().sum() } else { self.pressure }
    }

    /// Centre of the area in contact, weighted by |∂φ/∂n| [m], on a facet with these corners; none where that is zero.
    pub(crate) fn center_of_area(&self, corners: &[Vec3; 3]) -> Option<Vec3> {
        let [a, b, c] = self.slope;
        let total = a + b + c;
        (total > 0.0).then(|| (corners[0] * a + corners[1] * b + corners[2] * c) / total)
    }

    /// Centre of pressure ∫ φ x dA / ∫ φ dA [m] on a facet with these corners; the first where there is no pressure.
    pub(crate) fn center(&self, corners: &[Vec3; 3]) -> Vec3 {
        let [a, b, c] = self.weights;
        let total = a + b + c;
        if total <= 0.0 { corners[0] } else { (corners[0] * a + corners[1] * b + corners[2] * c) / total }
    }
}

/// A facet that touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveFacet {
    /// Its number among [`Candidates::facets`](crate::broad_phase::Candidates::facets).
    pub facet: u32,
    /// Its triangle.
    pub triangle: TriangleId,
    /// The block that it is of.
    pub owner: BlockId,
    /// The block that it touches.
    pub target: BlockId,
    /// Where its hits are, and the rest.
    pub(super) chunk: u32,
    pub(super) overlaps: [u32; 2],
    pub(super) place: u32,
}
