//! The part of a boundary triangle where some linear fields are positive, corner by corner, in order.
//!
//! Everything happens in the triangle's own barycentric coordinates (ψ₁, ψ₂). A corner is classified once for each
//! cut, by the sign of the field there, so the rim is closed whatever rounding does. [`kernel`](crate::kernel) does
//! the same for many pairs at a time and hands the few that it doubts to this one.

use crate::kernel::MOST_CUTS;

/// A triangle has 3 corners, and each cut adds at most one.
const MOST: usize = 3 + MOST_CUTS;

/// A linear form c₀ + c₁ ψ₁ + c₂ ψ₂.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Form(pub [f64; 3]);

impl Form {
    /// The form with these values at the triangle's corners.
    pub fn through(at: &[f64; 3]) -> Self {
        Self([at[0], at[1] - at[0], at[2] - at[0]])
    }

    /// Its value at (ψ₁, ψ₂).
    pub fn at(&self, psi: &[f64; 2]) -> f64 {
        self.0[0] + (self.0[1] * psi[0] + self.0[2] * psi[1])
    }
}

/// A convex polygon in the triangle; lives on the stack.
#[derive(Clone, Copy, Debug)]
pub struct Polygon {
    corners: [[f64; 2]; MOST],
    len: usize,
}

impl Polygon {
    /// The whole triangle, counter-clockwise.
    pub fn triangle() -> Self {
        let mut corners = [[0.0; 2]; MOST];
        (corners[1], corners[2]) = ([1.0, 0.0], [0.0, 1.0]);
        Self { corners, len: 3 }
    }

    /// Its corners (ψ₁, ψ₂) in order.
    pub fn corners(&self) -> &[[f64; 2]] {
        &self.corners[..self.len]
    }

    /// Leaves the part where the field is not below `bound`: 0, or the least positive number to leave the zeros out.
    pub fn cut(&mut self, field: &Form, bound: f64) {
        let inside = |d: f64| d >= bound;
        let whole = *self;
        self.len = 0;
        let Some(first) = whole.corners().first() else { return };
        let mut from = field.at(first);
        for (i, here) in whole.corners().iter().enumerate() {
            let next = whole.corners().get(i + 1).unwrap_or(first);
            let to = field.at(next);
            if inside(from) {
                self.push(*here);
            }
            if inside(from) != inside(to) {
                let t = from / (from - to);
                self.push([0, 1].map(|k| here[k] + t * (next[k] - here[k])));
            }
            from = to;
        }
    }

    fn push(&mut self, corner: [f64; 2]) {
        // Only a rim that rounding made wavy could have more corners; the excess has no area.
        if self.len < MOST {
            self.corners[self.len] = corner;
            self.len += 1;
        }
    }

    /// Triangles about the first corner that fill the polygon, each with twice its signed area.
    pub fn fan(&self) -> impl Iterator<Item = ([[f64; 2]; 3], f64)> {
        let apex = self.corners[0];
        self.corners().windows(2).skip(1).map(move |pair| {
            let [u, v] = [pair[0], pair[1]].map(|c| [c[0] - apex[0], c[1] - apex[1]]);
            ([apex, pair[0], pair[1]], u[0] * v[1] - u[1] * v[0])
        })
    }
}
