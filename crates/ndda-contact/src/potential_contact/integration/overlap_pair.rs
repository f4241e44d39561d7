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
    /// Reaction on the target's nodes.
    pub on_target: OnTarget,
}

impl OverlapPair {
    /// ∫ φ dA [m²] and its centre [m], from the corners of the tetrahedron; none where nothing presses.
    pub(crate) fn center(&self, corners: &[Vec3; 4]) -> Option<(f64, Vec3)> {
        let weights = &self.on_target.pressure;
        let total: f64 = weights.iter().sum();
        let sum: Vec3 = corners.iter().zip(weights).map(|(x, w)| *w * x).sum();
        (total > 0.0).then(|| (total, sum / total))
    }
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

/// A facet that touches, as its chunk keeps it: its hits follow those of the facet before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ChunkFacet {
    /// Its number among [`Candidates::facets`](crate::broad_phase::Candidates::facets).
    pub(super) facet: u32,
    pub(super) triangle: TriangleId,
    pub(super) target: BlockId,
    /// How many hits it has.
    pub(super) hits: u32,
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
