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

use crate::batch::RegionMoments;
use crate::clip::{Form, Outline, Polygon};
use crate::region::element_regions;

/// One number for each face of a tetrahedron; face b is opposite to corner b.
type Faces = [f64; 4];

/// What the kernel needs of a target tetrahedron; made once per step.
///
/// λ_b(x) = n·(x − p) / n·(x_b − p), the normal n and the point p of the face opposite to corner b taken from its
/// corners in the order of their coordinates. Two tetrahedra that share a face therefore compute the same n·(x − p)
/// to the last bit, and no point near the face is in both of them or in neither.
#[derive(Clone, Copy, Debug, Default)]
pub struct TetFrame {
    /// n, coordinate by coordinate, so that a processor with four lanes does the four faces at once.
    normal: [Faces; 3],
    /// p: the first corner in order, but for the face opposite to it, which has the second.
    point: [Faces; 3],
    per_height: Faces,
    centroid: Vec3,
    origin: Vec3,
    /// Volume [m³].
    pub volume_m3: f64,
}

impl TetFrame {
    /// The frame of a tetrahedron with these corners [m].
    #[inline]
    pub fn new(corners: &[Vec3; 4]) -> Self {
        Self::in_order(corners, &lexicographic(corners))
    }

    /// The frame of a tetrahedron whose corners come in this order; any order that neighbours agree on will do.
    #[inline]
    pub fn in_order(corners: &[Vec3; 4], order: &[u8; 4]) -> Self {
        let order = [0, 1, 2, 3].map(|k| usize::from(order[k]));
        let (p, q, r, s) = (corners[order[0]], corners[order[1]], corners[order[2]], corners[order[3]]);
        let [a, b, c] = [q - p, r - p, s - p];
        let normals = [(r - q).cross(&(s - q)), b.cross(&c), a.cross(&c), a.cross(&b)];
        let heights = [-normals[0].dot(&a), normals[1].dot(&a), normals[2].dot(&b), normals[3].dot(&c)];
        let (along, across, up) = (corners[1] - corners[0], corners[2] - corners[0], corners[3] - corners[0]);
        let mut frame = Self {
            centroid: p + (a + b + c) / 4.0,
            origin: corners[0],
            volume_m3: along.dot(&across.cross(&up)) / 6.0,
            ..Self::default()
        };
        for (k, point) in [q, p, p, p].iter().enumerate() {
            let face = order[k];
            frame.per_height[face] = 1.0 / heights[k];
            for i in 0..3 {
                (frame.normal[i][face], frame.point[i][face]) = (normals[k][i], point[i]);
            }
        }
        frame
    }

    /// Whether none of its heights is lost to rounding; without one there is no λ.
    pub fn has_heights(&self) -> bool {
        self.per_height.iter().all(|h| h.is_finite())
    }

    /// All λ at a point.
    #[inline(always)]
    pub fn lambda_at(&self, x: &Vec3) -> [f64; 4] {
        let ([nx, ny, nz], [px, py, pz]) = (&self.normal, &self.point);
        let mut lambda = [0.0; 4];
        for b in 0..4 {
            let above = nx[b] * (x.x - px[b]) + ny[b] * (x.y - py[b]) + nz[b] * (x.z - pz[b]);
            lambda[b] = self.per_height[b] * above;
        }
        lambda
    }

    /// λ_b at the corners of a triangle, as `[b][a]`.
    pub fn lambda(&self, [x, y, z]: &[Vec3; 3]) -> [[f64; 3]; 4] {
        by_face([&self.lambda_at(x), &self.lambda_at(y), &self.lambda_at(z)])
    }

    /// The same, or nothing if a face separates the triangle from the tetrahedron.
    #[inline(always)]
    pub fn lambda_inside(&self, [x, y, z]: &[Vec3; 3]) -> Option<[[f64; 3]; 4]> {
        let (x, y, z) = (self.lambda_at(x), self.lambda_at(y), self.lambda_at(z));
        let at = [&x, &y, &z];
        if some_face_separates(at) { None } else { Some(by_face(at)) }
    }

    /// Whether a triangle that lies in the plane of face b is to be counted in this tetrahedron: if the tetrahedron is
    /// on the inner side of the triangle, so that one of two that share the face has it, and touching is not overlap.
    pub fn owns_plane(&self, b: usize, outward: &Vec3) -> bool {
        self.gradient(b).dot(outward) < 0.0
    }

    /// |∂φ/∂n| in the four regions [1/m].
    pub fn slopes(&self, normal: &Vec3) -> [f64; 4] {
        let [nx, ny, nz] = &self.normal;
        let mut slopes = [0.0; 4];
        for b in 0..4 {
            let along = nx[b] * normal.x + ny[b] * normal.y + nz[b] * normal.z;
            slopes[b] = 4.0 * (self.per_height[b] * along).abs();
        }
        slopes
    }

    /// Corner 0 [m].
    pub fn origin(&self) -> &Vec3 {
        &self.origin
    }

    /// ∇λ_b [1/m].
    pub fn gradient(&self, b: usize) -> Vec3 {
        self.per_height[b] * Vec3::new(self.normal[0][b], self.normal[1][b], self.normal[2][b])
    }

    /// (x − g)·n [m] of a plane through x.
    pub fn centroid_distance(&self, x: &Vec3, normal: &Vec3) -> f64 {
        (x - self.centroid).dot(normal)
    }
}

/// λ as `[b][a]` of λ as `[a][b]`.
#[inline(always)]
pub(crate) fn by_face([x, y, z]: [&Faces; 3]) -> [[f64; 3]; 4] {
    let mut lambda = [[0.0; 3]; 4];
    for b in 0..4 {
        lambda[b] = [x[b], y[b], z[b]];
    }
    lambda
}

/// Whether no corner of a triangle is inside some face, from λ as `[a][b]`; without a branch, since either answer is
/// as likely.
#[inline(always)]
pub(crate) fn some_face_separates([x, y, z]: [&Faces; 3]) -> bool {
    let mut separates = false;
    for b in 0..4 {
        let larger = if x[b] > y[b] { x[b] } else { y[b] };
        let largest = if z[b] > larger { z[b] } else { larger };
        separates |= largest <= 0.0;
    }
    separates
}

/// Least and largest ψ₁ and ψ₂ on a contactor.
pub type PsiRange = [[f64; 2]; 2];

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
    pub fn of(lambda: &[[f64; 3]; 4], pressure: &[f64; 3], slope: &[f64; 3]) -> Self {
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
    pub fn total(&self) -> f64 {
        self.pressure.iter().sum()
    }

    /// Adds the integrals over a polygon on which φ is linear, fanned into triangles:
    /// ∫ f g dA = A/12 [(Σf)(Σg) + Σ fᵢ gᵢ],  ∫ f dA = A/3 Σf.
    pub fn add(&mut self, polygon: &Polygon, phi: &Form, slope: f64, area_m2: f64) {
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
    pub fn add_region(&mut self, part: &RegionMoments) {
        for a in 0..3 {
            self.pressure[a] += part.pressure[a];
            self.slope[a] += part.slope[a];
        }
        self.area += part.area;
        self.depth = self.depth.max(part.depth);
    }

    /// Takes integrals of what is nowhere negative for zero where rounding made them so: where nothing is left but
    /// rounding, quotients of them would put the centre of pressure anywhere.
    pub fn drop_rounding(&mut self) {
        for a in 0..3 {
            self.pressure[a] = non_negative(self.pressure[a]);
            self.slope[a] = non_negative(self.slope[a]);
        }
        self.area = non_negative(self.area);
    }

    /// The same where ψ is not positive all over: what is left is what the total and the range of ψ on the contactor leave room for, and
    /// adds up to the total.
    #[inline]
    pub fn drop_rounding_within(&mut self, range: &PsiRange) {
        let within = |sums: &mut [f64; 3]| {
            let total = non_negative(sums.iter().sum());
            for (sum, [least, most]) in sums[1..].iter_mut().zip(range) {
                let [least, most] = [total * least, total * most];
                // What is not a number stays so.
                *sum = if *sum < least { least } else { *sum };
                *sum = if *sum > most { most } else { *sum };
            }
            sums[0] = total - sums[1] - sums[2];
        };
        within(&mut self.pressure);
        within(&mut self.slope);
        self.area = non_negative(self.area);
    }

    /// What the target's nodes feel; `lambda[b][a]` is λ_b at corner a.
    #[inline(always)]
    pub fn on_target(&self, lambda: &[[f64; 3]; 4]) -> OnTarget {
        OnTarget::of(lambda, &self.pressure, &self.slope)
    }
}

/// Zero for less, without a branch, since this is done for every hit; what is not a number stays so.
#[inline(always)]
fn non_negative(sum: f64) -> f64 {
    if sum < 0.0 { 0.0 } else { sum }
}

/// The corners' indices in the lexicographic order of their coordinates, by five comparisons.
fn lexicographic(corners: &[Vec3; 4]) -> [u8; 4] {
    let mut order = [0, 1, 2, 3];
    for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
        let (a, b) = (&corners[usize::from(order[i])], &corners[usize::from(order[j])]);
        let by_z = (a.y == b.y) & (b.z < a.z);
        let swap = (b.x < a.x) | ((a.x == b.x) & ((b.y < a.y) | by_z));
        (order[i], order[j]) = if swap { (order[j], order[i]) } else { (order[i], order[j]) };
    }
    order
}

/// Whether a face of the tetrahedron separates it from the triangle; φ = 0 on the faces themselves.
pub fn is_outside(lambda: &[[f64; 3]; 4]) -> bool {
    lambda.iter().any(|at| at.iter().all(|&l| l <= 0.0))
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
pub fn element_moments(lambda: &[[f64; 3]; 4], slopes: &[f64; 4], area_m2: f64) -> PairMoments {
    let mut moments = PairMoments::default();
    element_regions(lambda, slopes, |_, region| {
        moments.add(&region.polygon(&Outline::TRIANGLE), &Form::through(&region.phi), region.slope, area_m2);
    });
    moments
}

/// The pair's share of ∫ φ dV over the overlap of the triangle's block with the tetrahedron [m³].
pub fn pair_energy(triangle: &[Vec3; 3], area_vector: &Vec3, tet: &TetFrame) -> f64 {
    let lambda = tet.lambda(triangle);
    let area = area_vector.norm();
    if area == 0.0 || is_outside(&lambda) {
        return 0.0;
    }
    let mut mean = 0.0;
    element_regions(&lambda, &[0.0; 4], |_, region| {
        let (phi, part) = (Form::through(&region.phi), region.polygon(&Outline::TRIANGLE));
        mean += part.fan().map(|(x, twice)| twice * mean_of_a(&x.map(|c| phi.at(&c)))).sum::<f64>();
    });
    // |n| dA and the height of the centroid in one product.
    mean * tet.centroid_distance(&triangle[0], area_vector)
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
