//! The part of a contactor where some linear fields are positive, corner by corner, in order.
//!
//! Everything happens in the barycentric coordinates (ψ₁, ψ₂) of its triangle. A corner is classified once for each
//! cut, by the sign of the field there, so the rim is closed whatever rounding does. [`kernel`](crate::integration::kernel) does
//! the same for many pairs at a time and hands the few that it doubts to this one.

use crate::integration::capacity::{MOST_CORNERS, MOST_CUTS};
use crate::integration::quadrature::Quadrature;

/// Each cut adds at most one corner.
const MOST: usize = MOST_CORNERS + MOST_CUTS;

/// The outline of a contactor, a convex polygon in the coordinates (ψ₁, ψ₂) of its triangle, counter-clockwise: that triangle, or a face
/// that it is part of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Outline {
    corners: [[f64; 2]; MOST_CORNERS],
    len: usize,
    is_triangle: bool,
}

impl Default for Outline {
    fn default() -> Self {
        Self::TRIANGLE
    }
}

impl Outline {
    /// The triangle itself.
    pub(crate) const TRIANGLE: Self = {
        let mut corners = [[0.0; 2]; MOST_CORNERS];
        corners[1] = [1.0, 0.0];
        corners[2] = [0.0, 1.0];
        Self { corners, len: 3, is_triangle: true }
    };

    /// A face with these corners; none if they are too many.
    pub(crate) fn of_face(face: &[[f64; 2]]) -> Option<Self> {
        let mut corners = [*face.last()?; MOST_CORNERS];
        corners.get_mut(..face.len())?.copy_from_slice(face);
        Some(Self { corners, len: face.len(), is_triangle: false })
    }

    /// Its corners in order.
    pub(crate) fn corners(&self) -> &[[f64; 2]] {
        &self.corners[..self.len]
    }

    /// Its corners, and the last one again until they are as many as there may be.
    pub(crate) fn padded(&self) -> &[[f64; 2]; MOST_CORNERS] {
        &self.corners
    }

    /// Whether it is the triangle itself.
    #[inline(always)]
    pub(crate) fn is_triangle(&self) -> bool {
        self.is_triangle
    }
}

/// A linear form c₀ + c₁ ψ₁ + c₂ ψ₂.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Form(pub [f64; 3]);

impl Form {
    /// The form with these values at the triangle's corners.
    #[inline(always)]
    pub(crate) fn through(at: &[f64; 3]) -> Self {
        Self([at[0], at[1] - at[0], at[2] - at[0]])
    }

    /// Its value at (ψ₁, ψ₂).
    #[inline(always)]
    pub(crate) fn at(&self, psi: &[f64; 2]) -> f64 {
        self.0[0] + (self.0[1] * psi[0] + self.0[2] * psi[1])
    }
}

/// A convex polygon in the contactor; lives on the stack.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Polygon {
    corners: [[f64; 2]; MOST],
    len: usize,
}

impl Polygon {
    /// All of a contactor, counter-clockwise.
    pub(crate) fn all_of(outline: &Outline) -> Self {
        let mut corners = [[0.0; 2]; MOST];
        corners[..outline.len].copy_from_slice(outline.corners());
        Self { corners, len: outline.len }
    }

    /// Its corners (ψ₁, ψ₂) in order.
    pub(crate) fn corners(&self) -> &[[f64; 2]] {
        &self.corners[..self.len]
    }

    /// Leaves the part where the field is not below `bound`: 0, or the least positive number to leave the zeros out.
    pub(crate) fn cut(&mut self, field: &Form, bound: f64) {
        let inside = |d: f64| d >= bound;
        let count = std::mem::take(&mut self.len);
        let first = self.corners[0];
        let (mut here, mut from) = (first, field.at(&first));
        // Corners that are kept take the place of those already examined.
        for seen in 2..count + 2 {
            let next = if seen > count { first } else { self.corners[seen - 1] };
            let to = field.at(&next);
            if inside(from) {
                self.push(here, seen);
            }
            if inside(from) != inside(to) {
                let t = from / (from - to);
                self.push([0, 1].map(|k| here[k] + t * (next[k] - here[k])), seen);
            }
            (here, from) = (next, to);
        }
    }

    /// Adds a corner. Where there are as many already as there is room for, the rim is one that rounding made wavy, and its flattest corner gives way.
    #[inline(always)]
    fn push(&mut self, corner: [f64; 2], most: usize) {
        if self.len == most.min(MOST) {
            self.drop_flattest(corner);
        }
        self.corners[self.len] = corner;
        self.len += 1;
    }

    /// Drops the corner that takes the least area with it: those that a wavy rim has too many lie on the cut.
    #[cold]
    #[inline(never)]
    fn drop_flattest(&mut self, next: [f64; 2]) {
        let corner = |k: usize| if k == self.len { next } else { self.corners[k] };
        let area = |k: usize| {
            let ([x, y], [from_x, from_y], [to_x, to_y]) = (corner(k), corner(k - 1), corner(k + 1));
            ((x - from_x) * (to_y - y) - (y - from_y) * (to_x - x)).abs()
        };
        if let Some(flattest) = (1..self.len).min_by(|j, k| area(*j).total_cmp(&area(*k))) {
            self.corners.copy_within(flattest + 1..self.len, flattest);
            self.len -= 1;
        }
    }

    /// Points of a rule over the polygon as (ψ₀, ψ₁, ψ₂), with weights that add up to its area, over that of the triangle.
    pub(crate) fn points(&self, rule: &Quadrature) -> impl Iterator<Item = ([f64; 3], f64)> {
        self.fan().flat_map(|([a, b, c], twice)| {
            rule.triangle().iter().map(move |(l, weight)| {
                let [x, y] = [0, 1].map(|k| l[0] * a[k] + l[1] * b[k] + l[2] * c[k]);
                ([1.0 - x - y, x, y], twice * weight)
            })
        })
    }

    /// Triangles about the first corner that fill the polygon, each with twice its signed area.
    pub(crate) fn fan(&self) -> impl Iterator<Item = ([[f64; 2]; 3], f64)> {
        let apex = self.corners[0];
        self.corners().windows(2).skip(1).map(move |pair| {
            let [u, v] = [pair[0], pair[1]].map(|c| [c[0] - apex[0], c[1] - apex[1]]);
            ([apex, pair[0], pair[1]], u[0] * v[1] - u[1] * v[0])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two blocks that share a corner up to rounding: two of the cuts meet there within ε, and the rim crosses one of them three times.
    #[test]
    fn a_rim_that_runs_along_a_cut_loses_no_area() {
        let lambda = [
            [1.5700307444318162, -0.06392034520699282, 0.0],
            [-2.457449072459961, 0.9659139789814942, 1.0],
            [-0.3379895224425295, 0.5063458499544944, -1.5341117345099233e-16],
            [2.2254078504706754, -0.40833948372899637, -0.0],
        ];
        let ahead = |j: usize| [0, 1, 2].map(|a| lambda[j][a] - if j == 2 { 0.0 } else { lambda[2][a] });
        // Corners of the region by hand: where two of λ₀ = λ₂, λ₁ = λ₂, λ₂ = 0 and λ₃ = λ₂ meet inside.
        let meet = |[a, b]: [[f64; 3]; 2]| {
            let ([a0, a1, a2], [b0, b1, b2]) = (Form::through(&a).0, Form::through(&b).0);
            let determinant = a1 * b2 - a2 * b1;
            [(a2 * b0 - a0 * b2) / determinant, (a0 * b1 - a1 * b0) / determinant]
        };
        let ([x, y], [u, v]) = (meet([ahead(1), ahead(2)]), meet([ahead(1), ahead(3)]));
        let expected = x * (v - 1.0) - u * (y - 1.0);
        for order in [[0, 1, 2, 3], [0, 2, 1, 3], [1, 0, 3, 2], [2, 0, 1, 3], [3, 2, 1, 0], [2, 3, 0, 1]] {
            let mut part = Polygon::all_of(&Outline::TRIANGLE);
            for j in order {
                let bound = if j < 2 { f64::from_bits(1) } else { 0.0 };
                part.cut(&Form::through(&ahead(j)), bound);
            }
            let area: f64 = part.fan().map(|(_, twice)| twice).sum();
            assert!((area.abs() - expected.abs()).abs() < 1e-15, "{order:?}: {area} of {expected}");
        }
    }
}
