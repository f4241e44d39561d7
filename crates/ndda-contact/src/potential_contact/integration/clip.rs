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

    /// Adds a corner, unless there are as many already as may be.
    fn push(&mut self, corner: [f64; 2], most: usize) {
        // Only a rim that rounding made wavy could have more corners; the excess has no area.
        if self.len < most.min(MOST) {
            self.corners[self.len] = corner;
            self.len += 1;
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
