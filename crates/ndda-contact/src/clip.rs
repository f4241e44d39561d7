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

    /// The part where the field is positive, or zero if `tie_is_inside`.
    pub fn cut(&self, field: &Form, tie_is_inside: bool) -> Self {
        let inside = |d: f64| d > 0.0 || (d == 0.0 && tie_is_inside);
        let mut kept = Self { corners: [[0.0; 2]; MOST], len: 0 };
        for (i, here) in self.corners().iter().enumerate() {
            let next = &self.corners[(i + 1) % self.len];
            let (from, to) = (field.at(here), field.at(next));
            if inside(from) {
                kept.push(*here);
            }
            if inside(from) != inside(to) {
                let t = from / (from - to);
                kept.push([0, 1].map(|k| here[k] + t * (next[k] - here[k])));
            }
        }
        kept
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

/// The region of a triangle where λ_i ≥ 0 is the smallest of four; `lambda[b][a]` is λ_b at corner a. Where λ_i = λ_j
/// the smaller index has the point.
pub fn region(lambda: &[[f64; 3]; 4], i: usize) -> Polygon {
    let inside = Polygon::triangle().cut(&Form::through(&lambda[i]), true);
    let rivals = (0..4).filter(|&j| j != i);
    rivals.fold(inside, |part, j| {
        let ahead = [0, 1, 2].map(|a| lambda[j][a] - lambda[i][a]);
        part.cut(&Form::through(&ahead), i < j)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// λ of a triangle given by three points in the coordinates (λ₁, λ₂, λ₃).
    fn lambda_of(points: [[f64; 3]; 3]) -> [[f64; 3]; 4] {
        let mut lambda = [[0.0; 3]; 4];
        for (a, p) in points.iter().enumerate() {
            lambda[0][a] = 1.0 - p[0] - p[1] - p[2];
            for b in 0..3 {
                lambda[b + 1][a] = p[b];
            }
        }
        lambda
    }

    fn total(lambda: &[[f64; 3]; 4]) -> f64 {
        (0..4).flat_map(|i| region(lambda, i).fan().map(|(_, part)| part).collect::<Vec<_>>()).sum()
    }

    #[test]
    fn a_triangle_inside_is_split_into_regions_that_fill_it() {
        let area = total(&lambda_of([[0.1, 0.1, 0.1], [0.6, 0.1, 0.2], [0.1, 0.7, 0.05]]));
        assert!((area - 1.0).abs() < 1e-14, "{area}");
    }

    #[test]
    fn a_triangle_in_a_kink_plane_is_counted_once() {
        // λ₁ = λ₂ everywhere: the plane between two regions.
        let area = total(&lambda_of([[0.1, 0.1, 0.1], [0.2, 0.2, 0.1], [0.1, 0.1, 0.6]]));
        assert!((area - 1.0).abs() < 1e-14, "{area}");
    }

    #[test]
    fn a_triangle_outside_leaves_nothing() {
        assert_eq!(total(&lambda_of([[-0.1, 0.1, 0.1], [-0.2, 0.2, 0.1], [-0.1, 0.1, 0.6]])), 0.0);
    }

    #[test]
    fn a_large_triangle_is_clipped_to_the_section() {
        // The section λ₃ = 1/4 of the tetrahedron is a triangle of (3/4)² of the face.
        let area = total(&lambda_of([[-4.0, -4.0, 0.25], [8.0, -4.0, 0.25], [-4.0, 8.0, 0.25]]));
        assert!((area * 144.0 - 0.5625).abs() < 1e-13, "{area}");
    }
}
