//! One boundary triangle in one tetrahedron: the exact integrals of the element potential.
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

use crate::clip::{Polygon, for_each_piece};

/// What the kernel needs of a target tetrahedron; made once per step.
#[derive(Clone, Copy, Debug, Default)]
pub struct TetFrame {
    origin: Vec3,
    centroid_arm: Vec3,
    gradients: [Vec3; 4],
    /// Volume [m³].
    pub volume_m3: f64,
}

impl TetFrame {
    /// The frame of a tetrahedron with these corners [m].
    pub fn new(corners: &[Vec3; 4]) -> Self {
        let [a, b, c] = [1, 2, 3].map(|i| corners[i] - corners[0]);
        let (bc, ca, ab) = (b.cross(&c), c.cross(&a), a.cross(&b));
        let six_volumes = a.dot(&bc);
        let [g1, g2, g3] = [bc, ca, ab].map(|normal| normal / six_volumes);
        let gradients = [-(g1 + g2 + g3), g1, g2, g3];
        let centroid_arm = (a + b + c) / 4.0;
        Self { origin: corners[0], centroid_arm, gradients, volume_m3: six_volumes / 6.0 }
    }

    /// λ_b at the corners of a triangle, as `[b][a]`.
    fn lambda(&self, triangle: &[Vec3; 3]) -> [[f64; 3]; 4] {
        let arms = triangle.map(|x| x - self.origin);
        let mut lambda = self.gradients.map(|gradient| arms.map(|arm| gradient.dot(&arm)));
        lambda[0] = std::array::from_fn(|a| 1.0 - lambda[1][a] - lambda[2][a] - lambda[3][a]);
        lambda
    }

    /// (x − g)·n [m] of a plane through x.
    fn centroid_distance(&self, x: &Vec3, normal: &Vec3) -> f64 {
        (x - self.origin - self.centroid_arm).dot(normal)
    }
}

/// Integrals over the part of a triangle inside a tetrahedron. ψ are the shape functions of the triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairMoments {
    /// ∫ φ ψ_a dA [m²]: everything about the normal force.
    pub pressure: [f64; 3],
    /// The same for the target's nodes, Σ_a λ_b(X_a) ∫ φ ψ_a dA [m²].
    pub target_pressure: [f64; 4],
    /// ∫ |∂φ/∂n| ψ_a dA [m]: stiffness over k_n.
    pub slope: [f64; 3],
    /// The same for the target's nodes [m].
    pub target_slope: [f64; 4],
    /// Area of the part [m²].
    pub area: f64,
    /// Its share of ∫ φ dV over the overlap of the triangle's block with the tetrahedron [m³].
    pub energy: f64,
    /// Largest φ on the part.
    pub depth: f64,
}

impl PairMoments {
    /// ∫ φ dA [m²].
    pub fn total(&self) -> f64 {
        self.pressure.iter().sum()
    }
}

/// The integrals of one pair; `None` when the triangle is outside. `area_vector` is the triangle's, outward [m²].
pub fn pair_moments(triangle: &[Vec3; 3], area_vector: &Vec3, tet: &TetFrame) -> Option<PairMoments> {
    let lambda = tet.lambda(triangle);
    if lambda.iter().any(|at| at.iter().all(|&l| l <= 0.0)) {
        return None;
    }
    let area = area_vector.norm();
    if area == 0.0 {
        return None;
    }
    let normal = area_vector / area;
    let mut moments = PairMoments::default();
    for_each_piece(&lambda, |polygon, smallest| {
        let slope = 4.0 * tet.gradients[smallest].dot(&normal).abs();
        add_piece(&mut moments, polygon, smallest, area, slope);
    });
    moments.energy *= tet.centroid_distance(&triangle[0], &normal);
    for (b, lambda) in lambda.iter().enumerate() {
        let at_target = |w: &[f64; 3]| (0..3).map(|a| lambda[a] * w[a]).sum::<f64>();
        moments.target_pressure[b] = at_target(&moments.pressure);
        moments.target_slope[b] = at_target(&moments.slope);
    }
    (moments.area > 0.0).then_some(moments)
}

/// Adds one piece, fanned into triangles on which φ is linear:
/// ∫ f g dA = A/12 [(Σf)(Σg) + Σ fᵢ gᵢ],  ∫ f dA = A/3 Σf.
fn add_piece(moments: &mut PairMoments, polygon: &Polygon, smallest: usize, area: f64, slope: f64) {
    let vertices = polygon.vertices();
    let apex = &vertices[0];
    for pair in vertices[1..].windows(2) {
        let corners = [apex, &pair[0], &pair[1]];
        let [u, v] = [1, 2].map(|k| [1, 2].map(|i| corners[k].psi[i] - apex.psi[i]));
        let part = area * (u[0] * v[1] - u[1] * v[0]).abs();
        let phi = corners.map(|corner| 4.0 * corner.lambda[smallest]);
        let phi_sum = phi[0] + phi[1] + phi[2];
        for a in 0..3 {
            let psi = corners.map(|corner| corner.psi[a]);
            let psi_sum = psi[0] + psi[1] + psi[2];
            let products = phi[0] * psi[0] + phi[1] * psi[1] + phi[2] * psi[2];
            moments.pressure[a] += part / 12.0 * (phi_sum * psi_sum + products);
            moments.slope[a] += part / 3.0 * slope * psi_sum;
        }
        moments.area += part;
        moments.energy += part * mean_of_a(&phi);
        moments.depth = phi.iter().copied().fold(moments.depth, f64::max);
    }
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
