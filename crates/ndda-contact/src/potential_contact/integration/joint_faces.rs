//! Pairs of faces of a tetrahedron that together keep a triangle outside, though each alone leaves a part of it.
//!
//! Of the pairs of a triangle and a tetrahedron near it that no single face separates, about a quarter do not meet all the same.

use crate::integration::tet_frame::Faces;

/// By how much a product has to exceed another to be larger whatever rounding did to both: what is left out has no area to the last digit.
const CLEARLY: f64 = 1.0 + 1e-9;

/// The pairs of faces.
const PAIRS: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

/// Of which pairs one face or both are among these, for each set of faces.
const WITH_ONE_OF: [u8; 16] = pairs_with_one_of();

const fn pairs_with_one_of() -> [u8; 16] {
    let mut pairs = [0; 16];
    let mut set = 0;
    while set < 16 {
        let mut k = 0;
        while k < 6 {
            pairs[set] |= ((set >> PAIRS[k].0 | set >> PAIRS[k].1) as u8 & 1) << k;
            k += 1;
        }
        set += 1;
    }
    pairs
}

/// Whether two faces together separate a triangle from a tetrahedron, from λ as `[a][b]`.
///
/// λ is linear on the triangle, so the part inside two faces is empty where t x + (1 − t) y < 0 at all corners for some t in 0..1, x and y being λ of
/// the faces (Farkas 1902). A corner where x < 0 ≤ y asks for t > y/(y − x), one where y < 0 ≤ x for t < y/(y − x): there is such a t where
/// x_a y_b > y_a x_b for each corner a of the former kind and each corner b of the latter, and no corner is inside both.
#[inline(always)]
pub(crate) fn two_faces_separate([x, y, z]: [&Faces; 3]) -> bool {
    let mut pairs = WITH_ONE_OF[outside(x)] & WITH_ONE_OF[outside(y)] & WITH_ONE_OF[outside(z)];
    while pairs != 0 {
        let (b, c) = PAIRS[pairs.trailing_zeros() as usize];
        if are_opposed(&[x[b], y[b], z[b]], &[x[c], y[c], z[c]]) {
            return true;
        }
        pairs &= pairs - 1;
    }
    false
}

/// The faces that a point is outside of, a bit each.
#[inline(always)]
fn outside([a, b, c, d]: &Faces) -> usize {
    usize::from(*a < 0.0)
        | usize::from(*b < 0.0) << 1
        | usize::from(*c < 0.0) << 2
        | usize::from(*d < 0.0) << 3
}

/// Whether no point between two of the corners is inside both faces, where no corner is.
#[inline(always)]
fn are_opposed(x: &[f64; 3], y: &[f64; 3]) -> bool {
    let between = |a: usize, b: usize| {
        let (p, q) = (x[a] * y[b], y[a] * x[b]);
        let first = (y[a] >= 0.0) & (x[b] >= 0.0);
        let second = (x[a] >= 0.0) & (y[b] >= 0.0);
        (!first | (p > CLEARLY * q)) & (!second | (q > CLEARLY * p))
    };
    between(0, 1) & between(1, 2) & between(2, 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integration::clip::{Form, Outline, Polygon};
    use proptest::prelude::*;

    fn field() -> impl Strategy<Value = [f64; 3]> {
        [-1.0..1.0f64, -1.0..1.0, -1.0..1.0]
    }

    /// λ of two faces, and of two that leave all of the triangle.
    fn faces(x: &[f64; 3], y: &[f64; 3]) -> [Faces; 3] {
        [0, 1, 2].map(|a| [1.0, x[a], 1.0, y[a]])
    }

    /// What is left of the triangle by the ordered clipper.
    fn area_left(fields: [&[f64; 3]; 2]) -> f64 {
        let mut rest = Polygon::all_of(&Outline::TRIANGLE);
        fields.iter().for_each(|field| rest.cut(&Form::through(field), 0.0));
        rest.fan().map(|(_, part)| part).sum()
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(50_000) })]

        #[test]
        fn two_faces_separate_exactly_where_clipping_leaves_nothing(x in field(), y in field()) {
            let [u, v, w] = faces(&x, &y);
            prop_assert_eq!(two_faces_separate([&u, &v, &w]), area_left([&x, &y]) == 0.0);
        }
    }

    #[test]
    fn a_triangle_beyond_an_edge_of_a_tetrahedron_is_kept_outside_by_two_faces() {
        let at = |x: f64, y: f64| [x, y, 0.1, 0.9 - x - y];
        let [u, v, w] = [at(-0.5, 0.4), at(0.4, -0.5), at(-0.5, -0.5)];
        assert!(two_faces_separate([&u, &v, &w]));
        let [u, v, w] = [at(-0.5, 0.6), at(0.6, -0.5), at(-0.5, -0.5)];
        assert!(!two_faces_separate([&u, &v, &w]));
    }
}
