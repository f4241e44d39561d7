//! Numbers of twice the precision of f64, each an unevaluated sum of two (Dekker 1971; Hida, Li & Bailey 2001).
//!
//! In a flat tetrahedron λ = n·(x − p)/h divides by a small height: rounding of f64 is then as large as ε L/h, and a
//! face that lies along the tetrahedron feels it over its whole area.

use std::ops::{Add, Mul, Sub};

use ndda_mesh::Vec3;
use ndda_mesh::geometry::TET_FACES;

/// Determinants below this part of the product of their lengths are rounding of this arithmetic: 2⁻⁹⁵.
const ROUNDING: f64 = 1.0 / (1u128 << 95) as f64;

/// high + low, |low| at most half an ulp of high.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct DoubleDouble {
    high: f64,
    low: f64,
}

impl DoubleDouble {
    /// a + b without rounding.
    fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let of_b = high - a;
        Self { high, low: (a - (high - of_b)) + (b - of_b) }
    }

    /// a − b without rounding.
    pub(crate) fn difference(a: f64, b: f64) -> Self {
        Self::sum(a, -b)
    }

    /// The nearest f64.
    pub(crate) fn value(self) -> f64 {
        self.high
    }
}

impl Add for DoubleDouble {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let sum = Self::sum(self.high, other.high);
        Self::sum(sum.high, sum.low + (self.low + other.low))
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + Self { high: -other.high, low: -other.low }
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        let missing = self.high.mul_add(other.high, -high);
        Self::sum(high, missing + (self.high * other.low + self.low * other.high))
    }
}

type Arm = [DoubleDouble; 3];

fn arm(to: &Vec3, from: &Vec3) -> Arm {
    [0, 1, 2].map(|k| DoubleDouble::difference(to[k], from[k]))
}

fn cross(a: &Arm, b: &Arm) -> Arm {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: &Arm, b: &Arm) -> DoubleDouble {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: &Arm) -> f64 {
    Vec3::from(a.map(DoubleDouble::value)).norm()
}

/// λ₀ … λ₃ of a tetrahedron, right to an ulp or two whatever its shape; zero on its faces to the last bit.
pub(crate) struct Barycentric {
    point: [Vec3; 4],
    normal: [Arm; 4],
    /// |q − p| |r − p| of each face.
    size: [f64; 4],
    height: [f64; 4],
}

impl Barycentric {
    /// Coordinates of a tetrahedron that is not flat [m].
    pub(crate) fn new(corners: &[Vec3; 4]) -> Self {
        let faces = TET_FACES.map(|face| face.map(|i| corners[i]));
        let edges = faces.map(|[p, q, r]| [arm(&q, &p), arm(&r, &p)]);
        let normal = edges.map(|[u, v]| cross(&u, &v));
        Self {
            point: faces.map(|[p, _, _]| p),
            size: edges.map(|[u, v]| length(&u) * length(&v)),
            height: [0, 1, 2, 3].map(|b| dot(&normal[b], &arm(&corners[b], &faces[b][0])).value()),
            normal,
        }
    }

    /// λ_b(x) = n·(x − p) / n·(x_b − p), p a corner of the face opposite to corner b and n its normal.
    pub(crate) fn at(&self, b: usize, x: &Vec3) -> f64 {
        let arm = arm(x, &self.point[b]);
        let distance = dot(&self.normal[b], &arm).value();
        let is_rounding = distance.abs() <= ROUNDING * self.size[b] * length(&arm);
        if is_rounding { 0.0 } else { distance / self.height[b] }
    }

    /// ∇λ_b [1/m].
    pub(crate) fn gradient(&self, b: usize) -> Vec3 {
        Vec3::from(self.normal[b].map(|n| n.value() / self.height[b]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_keeps_what_f64_drops() {
        let near_one = DoubleDouble::difference(1.0, -1e-20);
        let square = near_one * near_one - DoubleDouble::difference(1.0, 0.0);
        assert!((square.value() - 2e-20).abs() < 1e-31, "{}", square.value());
    }

    #[test]
    fn coordinates_of_a_sliver_are_right_at_its_corners_and_zero_on_its_faces() {
        let thin = (-20f64).exp2();
        let slanted = |u: f64, v: f64, w: f64| Vec3::new(u + v / 8.0, v - w / 16.0 + 0.1, w + u / 32.0);
        let flat = |u: f64, v: f64, w: f64| slanted(u, v, (u + v) / 2.0 + w);
        let tet = [flat(0.0, 0.0, 0.0), flat(1.0, 0.0, 0.0), flat(0.0, 1.0, 0.0), flat(0.25, 0.25, thin)];
        let of_tet = Barycentric::new(&tet);
        for (i, x) in tet.iter().enumerate() {
            for b in 0..4 {
                assert!((of_tet.at(b, x) - f64::from(i == b)).abs() < 1e-15);
            }
        }
        assert_eq!(of_tet.at(3, &tet[1]), 0.0);
        assert!((0..4).map(|b| of_tet.gradient(b)).sum::<Vec3>().norm() < 1e-15 / thin);
    }
}
