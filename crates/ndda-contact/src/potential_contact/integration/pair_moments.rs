//! One boundary triangle in one tetrahedron: the exact integrals of the element potential, one pair at a time.
//!
//! φ(P) = 4 min λᵢ(P): 0 on the faces, 1 at the centroid, linear in the four regions between (Munjiza 2004, ch. 2;
//! his printed eq. 2.36 has the maximum ¼, his codes have 1). The force on the triangle is −k_n n ∫ φ dA; in the
//! sum over all pairs of elements (the paper's eq 16) the faces inside a block cancel, so boundary triangles are
//! enough.
//!
//! Energy from the same pieces. With g the centroid and s = 1 − φ, the field F = (x − g) a(s),
//! a = −φ² (3s² + 2s + 1)/(12 s³), has div F = φ away from g, no flux through the planes between the regions (they
//! pass through g) and none through the faces (φ = 0). So for a block A with outward normal n that does not hold g
//! ∫_{A∩T} φ dV = Σ ((x − g)·n) ∫ a dA over the pieces of A's surface in T; with g inside, V_T/4 is missing, and the
//! sum is negative: that is how a penetration past the centroid is noticed.

use ndda_mesh::Vec3;

use crate::integration::clip::{Form, Outline, Polygon};
use crate::integration::region::element_regions;
use crate::integration::tet_frame::{TetFrame, is_outside};

/// Part of a tetrahedron's volume beyond which a negative integral is more than rounding.
const PAST_CENTROID: f64 = 1e-9;

/// Least and largest ψ₁ and ψ₂ on a contactor.
pub(crate) type PsiRange = [[f64; 2]; 2];

/// Integrals over the part of a contactor inside a tetrahedron or block. ψ are the shape functions of its triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairMoments {
    /// ∫ φ ψ_a dA [m²]: everything about the normal force.
    pub pressure: [f64; 3],
    /// ∫ |∂φ/∂n| ψ_a dA [m]: stiffness over k_n.
    pub slope: [f64; 3],
    /// Area of the part [m²].
    pub area: f64,
    /// Largest φ on the part.
    pub depth: f64,
}

/// Integrals over a contactor as the nodes of its target see them; λ are the target's at its corners.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OnTarget {
    /// ∫ φ λ_b dA = Σ_a λ_b(X_a) ∫ φ ψ_a dA [m²].
    pub pressure: [f64; 4],
    /// ∫ |∂φ/∂n| λ_b dA [m].
    pub slope: [f64; 4],
}

impl OnTarget {
    /// From ∫ φ ψ_a dA and ∫ |∂φ/∂n| ψ_a dA; `lambda[b][a]` is λ_b at corner a.
    #[inline(always)]
    pub(crate) fn of(lambda: &[[f64; 3]; 4], pressure: &[f64; 3], slope: &[f64; 3]) -> Self {
        let mut on_target = Self::default();
        for (b, [x, y, z]) in lambda.iter().enumerate() {
            on_target.pressure[b] = x * pressure[0] + y * pressure[1] + z * pressure[2];
            on_target.slope[b] = x * slope[0] + y * slope[1] + z * slope[2];
        }
        on_target
    }
}

impl PairMoments {
    /// ∫ φ dA [m²].
    pub(crate) fn total(&self) -> f64 {
        self.pressure.iter().sum()
    }

    /// Adds the integrals over a polygon on which φ is linear, fanned into triangles:
    /// ∫ f g dA = A/12 [(Σf)(Σg) + Σ fᵢ gᵢ],  ∫ f dA = A/3 Σf.
    pub(crate) fn add(&mut self, polygon: &Polygon, phi: &Form, slope: f64, area_m2: f64) {
        for (corners, twice) in polygon.fan() {
            let part = area_m2 * twice;
            let phi = corners.map(|c| phi.at(&c));
            let phi_sum = phi[0] + phi[1] + phi[2];
            // ψ_a at the three corners.
            let psi = [corners.map(|c| 1.0 - c[0] - c[1]), corners.map(|c| c[0]), corners.map(|c| c[1])];
            for (psi, (pressure, slope_sum)) in psi.iter().zip(self.pressure.iter_mut().zip(&mut self.slope))
            {
                let psi_sum = psi[0] + psi[1] + psi[2];
                let products = phi[0] * psi[0] + phi[1] * psi[1] + phi[2] * psi[2];
                *pressure += part / 12.0 * (phi_sum * psi_sum + products);
                *slope_sum += part / 3.0 * slope * psi_sum;
            }
            self.area += part;
            self.depth = phi.iter().copied().fold(self.depth, f64::max);
        }
    }

    /// Adds the integrals over a region of the same triangle.
    #[inline(always)]
    pub(crate) fn add_region(&mut self, part: &RegionMoments) {
        for a in 0..3 {
            self.pressure[a] += part.pressure[a];
            self.slope[a] += part.slope[a];
        }
        self.area += part.area;
        self.depth = self.depth.max(part.depth);
    }

    /// Takes integrals of what is nowhere negative for zero where rounding made them so: where nothing is left but
    /// rounding, quotients of them would put the centre of pressure anywhere.
    pub(crate) fn drop_rounding(&mut self) {
        for a in 0..3 {
            self.pressure[a] = non_negative(self.pressure[a]);
            self.slope[a] = non_negative(self.slope[a]);
        }
        self.area = non_negative(self.area);
    }

    /// Removes rounding where ψ is not positive all over: the result is bounded by the total and the range of ψ on the contactor, and
    /// adds up to the total.
    #[inline]
    pub(crate) fn drop_rounding_within(&mut self, range: &PsiRange) {
        let within = |sums: &mut [f64; 3]| {
            let total = non_negative(sums.iter().sum());
            for (sum, [least, most]) in sums[1..].iter_mut().zip(range) {
                let [least, most] = [total * least, total * most];
                // NaN stays NaN.
                *sum = if *sum < least { least } else { *sum };
                *sum = if *sum > most { most } else { *sum };
            }
            sums[0] = total - sums[1] - sums[2];
        };
        within(&mut self.pressure);
        within(&mut self.slope);
        self.area = non_negative(self.area);
    }

    /// Reaction on the target's nodes; `lambda[b][a]` is λ_b at corner a.
    #[inline(always)]
    pub fn on_target(&self, lambda: &[[f64; 3]; 4]) -> OnTarget {
        OnTarget::of(lambda, &self.pressure, &self.slope)
    }
}

/// The integrals over one region of a pair. ψ are the shape functions of the triangle.
#[derive(Clone, Copy, Debug, Default)]
pub struct RegionMoments {
    /// Which pair.
    pub pair: u32,
    /// ∫ φ ψ_a dA [m²].
    pub pressure: [f64; 3],
    /// ∫ |∂φ/∂n| ψ_a dA [m].
    pub slope: [f64; 3],
    /// Area [m²].
    pub area: f64,
    /// Largest φ.
    pub depth: f64,
}

/// Zero for less, without a branch, since this is done for every hit; what is not a number stays so.
#[inline(always)]
fn non_negative(sum: f64) -> f64 {
    if sum < 0.0 { 0.0 } else { sum }
}

/// The integrals of one pair; `None` when the triangle is outside, or a height of the tetrahedron is lost to rounding
/// (the model stops at such a tetrahedron before it gets here). `area_vector` is the triangle's, outward [m²].
pub fn pair_moments(triangle: &[Vec3; 3], area_vector: &Vec3, tet: &TetFrame) -> Option<PairMoments> {
    let lambda = tet.lambda(triangle);
    let area = area_vector.norm();
    if area == 0.0 || !tet.has_heights() || is_outside(&lambda) {
        return None;
    }
    let moments = element_moments(&lambda, &tet.slopes(&(area_vector / area)), area);
    (moments.area > 0.0).then_some(moments)
}

/// The integrals of the element potential, region by region; `slopes` are |∂φ/∂n| there [1/m].
pub(crate) fn element_moments(lambda: &[[f64; 3]; 4], slopes: &[f64; 4], area_m2: f64) -> PairMoments {
    let mut moments = PairMoments::default();
    element_regions(lambda, slopes, |_, region| {
        moments.add(&region.polygon(&Outline::TRIANGLE), &Form::through(&region.phi), region.slope, area_m2);
    });
    moments
}

/// The pair's share of ∫ φ dV over the overlap of the triangle's block with the tetrahedron [m³].
pub(crate) fn pair_energy(triangle: &[Vec3; 3], area_vector: &Vec3, tet: &TetFrame) -> f64 {
    let lambda = tet.lambda(triangle);
    let area = area_vector.norm();
    if area == 0.0 || is_outside(&lambda) {
        return 0.0;
    }
    let mut mean = 0.0;
    element_regions(&lambda, &[0.0; 4], |_, region| {
        mean += mean_flux(&region.polygon(&Outline::TRIANGLE), &Form::through(&region.phi));
    });
    // |n| dA and the height of the centroid in one product.
    mean * tet.centroid_distance(&triangle[0], area_vector)
}

/// ∫ a dA over a part of a triangle where φ is linear, over the triangle's area.
pub(crate) fn mean_flux(part: &Polygon, phi: &Form) -> f64 {
    part.fan().map(|(x, twice)| twice * mean_of_a(&x.map(|c| phi.at(&c)))).sum()
}

/// Mean of a over a triangle with linear φ. With p = Σφ, q = Σ φᵢφⱼ, r = φ₁φ₂φ₃:
/// −(p² − q − p q + r + p r) / (12 (1 − φ₁)(1 − φ₂)(1 − φ₃)), by Hermite–Genocchi; no cancellation for small φ.
fn mean_of_a(phi: &[f64; 3]) -> f64 {
    let [a, b, c] = *phi;
    let (p, q, r) = (a + b + c, a * b + b * c + c * a, a * b * c);
    let apart = (1.0 - a) * (1.0 - b) * (1.0 - c);
    // A corner at the centroid itself: F has no limit there, and the penetration is past saving.
    if apart <= 0.0 { 0.0 } else { -(p * p - q - p * q + r + p * r) / (12.0 * apart) }
}

/// Whether a flux through all pieces of a block in a tetrahedron says that its centroid is inside the block: ∫ φ dV is not
/// negative, and a centroid inside is a source that the flux leaves out.
pub(crate) fn has_centroid(integral_m3: f64, volume_m3: f64) -> bool {
    integral_m3 < -PAST_CENTROID * volume_m3
}
