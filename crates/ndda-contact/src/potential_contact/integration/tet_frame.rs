//! The frame of a tetrahedron: λ at any point, the same to the last bit on both sides of a shared face.

use ndda_mesh::Vec3;

/// One number for each face of a tetrahedron; face b is opposite to corner b.
pub(crate) type Faces = [f64; 4];

/// A target tetrahedron as the kernel needs it; made once per step.
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
    pub(crate) fn lambda_at(&self, x: &Vec3) -> [f64; 4] {
        let ([nx, ny, nz], [px, py, pz]) = (&self.normal, &self.point);
        let mut lambda = [0.0; 4];
        for b in 0..4 {
            let above = nx[b] * (x.x - px[b]) + ny[b] * (x.y - py[b]) + nz[b] * (x.z - pz[b]);
            lambda[b] = self.per_height[b] * above;
        }
        lambda
    }

    /// λ_b at the corners of a triangle, as `[b][a]`.
    pub fn lambda(&self, corners: &[Vec3; 3]) -> [[f64; 3]; 4] {
        let [x, y, z] = self.lambda_by_corner(corners);
        by_face([&x, &y, &z])
    }

    /// The same, or nothing if a face separates the triangle from the tetrahedron.
    #[inline(always)]
    pub fn lambda_inside(&self, corners: &[Vec3; 3]) -> Option<[[f64; 3]; 4]> {
        let [x, y, z] = self.lambda_by_corner(corners);
        let at = [&x, &y, &z];
        if some_face_separates(at) { None } else { Some(by_face(at)) }
    }

    /// λ_b at the corners of a triangle, as `[a][b]`.
    #[inline(always)]
    pub(crate) fn lambda_by_corner(&self, [x, y, z]: &[Vec3; 3]) -> [Faces; 3] {
        [self.lambda_at(x), self.lambda_at(y), self.lambda_at(z)]
    }

    /// Whether a triangle that lies in the plane of face b is to be counted in this tetrahedron: if the tetrahedron is
    /// on the inner side of the triangle, so that one of two that share the face has it, and touching is not overlap.
    pub(crate) fn owns_plane(&self, b: usize, outward: &Vec3) -> bool {
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
    pub(crate) fn origin(&self) -> &Vec3 {
        &self.origin
    }

    /// ∇λ_b [1/m].
    pub fn gradient(&self, b: usize) -> Vec3 {
        self.per_height[b] * Vec3::new(self.normal[0][b], self.normal[1][b], self.normal[2][b])
    }

    /// (x − g)·n [m] of a plane through x.
    pub(crate) fn centroid_distance(&self, x: &Vec3, normal: &Vec3) -> f64 {
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
pub(crate) fn is_outside(lambda: &[[f64; 3]; 4]) -> bool {
    lambda.iter().any(|at| at.iter().all(|&l| l <= 0.0))
}
