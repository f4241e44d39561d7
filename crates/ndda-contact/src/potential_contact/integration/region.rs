//! The part of a contactor where φ is one linear function, as the cuts that make it.
//!
//! A region is where some linear fields are positive: λ_i and λ_j − λ_i for the element potential, the four λ and the
//! rivals' lead over a piece for any other. Most pairs of a shallow contact see one region and one or two cuts of it,
//! so a field is looked at by its signs at the corners first: none outside, and it cuts nothing; all outside, and there
//! is no region. The sign of a field is taken the same way from both of its sides, so no point is in two regions or
//! in none.

use crate::integration::capacity::MOST_CUTS;
use crate::integration::clip::{Form, Outline, Polygon};
use crate::integration::tet_frame::TetFrame;
use crate::potential::piece_table::MOST_PIECES;
use ndda_mesh::Vec3;

/// A field by its values at the triangle's corners, that is positive in the region.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cut {
    /// The values.
    pub field: [f64; 3],
    /// Below this is outside: 0 where a zero of the field belongs to the region, the least positive number where not.
    pub bound: f64,
}

impl Cut {
    /// Leaves everything.
    pub const NOTHING: Self = Self { field: [1.0; 3], bound: 0.0 };

    /// A cut that keeps the zeros of its field, or leaves them to another region.
    #[inline(always)]
    pub(crate) fn new(field: [f64; 3], tie_is_inside: bool) -> Self {
        Self { field, bound: if tie_is_inside { 0.0 } else { f64::from_bits(1) } }
    }

    /// How many corners of a triangle are outside.
    #[inline(always)]
    fn outside(&self) -> u8 {
        let [x, y, z] = self.field;
        u8::from(x < self.bound) + u8::from(y < self.bound) + u8::from(z < self.bound)
    }
}

/// A region; one is used again and again.
#[derive(Clone, Copy, Debug, Default)]
pub struct Region {
    /// φ at the triangle's corners.
    pub phi: [f64; 3],
    /// |∂φ/∂n| [1/m].
    pub slope: f64,
    cuts: [Cut; MOST_CUTS],
    len: usize,
}

impl Region {
    /// The cuts, at most `MOST_CUTS`.
    #[inline(always)]
    pub fn cuts(&self) -> &[Cut] {
        &self.cuts[..self.len]
    }

    /// Begins anew.
    #[inline(always)]
    pub(crate) fn begin(&mut self, phi: [f64; 3], slope: f64) {
        (self.phi, self.slope, self.len) = (phi, slope, 0);
    }

    /// Branch-free append of a cut; `len` advances only if the cut is active.
    #[inline(always)]
    pub(crate) fn put(&mut self, cut: Cut, cuts: bool) {
        self.cuts[self.len] = cut;
        self.len += usize::from(cuts);
    }

    /// Where λ_i ≥ 0 is the smallest of four and φ = 4 λ_i; `lambda[b][a]` is λ_b at corner a. `outside` is from
    /// [`element_outside`]. False if that is nowhere.
    #[inline(always)]
    pub(crate) fn set_element(
        &mut self,
        lambda: &[[f64; 3]; 4],
        outside: &[[u8; 4]; 4],
        i: usize,
        slope: f64,
    ) -> bool {
        self.begin(lambda[i].map(|l| 4.0 * l), slope);
        self.len = element_cuts(lambda, outside, i, |k, cut| self.cuts[k] = cut);
        is_somewhere(&outside[i])
    }

    /// Restricts the region to where the k-th of the functions is the smallest. False if that is nowhere.
    pub(crate) fn set_piece(&mut self, pieces: &Pieces, k: usize) -> bool {
        self.begin(pieces.at[k], pieces.slope[k].abs());
        self.len = pieces.cuts(k, |n, cut| self.cuts[n] = cut);
        pieces.is_somewhere(k)
    }

    /// The region on this contactor corner by corner.
    pub(crate) fn polygon(&self, outline: &Outline) -> Polygon {
        let mut part = Polygon::all_of(outline);
        for cut in self.cuts() {
            part.cut(&Form::through(&cut.field), cut.bound);
        }
        part
    }
}

/// The functions of a tetrahedron, of which the smallest is φ, as a contactor sees them; used again and again.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pieces {
    /// Their values at the triangle's corners.
    at: [[f64; 3]; MOST_PIECES],
    /// ∂φ/∂n [1/m].
    slope: [f64; MOST_PIECES],
    /// At how many corners each is above another, as `[own][other]`: there it is not the smallest. Above itself it is nowhere.
    outside: [[u8; MOST_PIECES]; MOST_PIECES],
    len: usize,
    /// The cuts by the tetrahedron's faces that cut something.
    faces: [Cut; 4],
    faces_len: usize,
}

impl Pieces {
    /// The functions with these nodal values on a triangle with this outward unit normal; false if the triangle is
    /// outside. `lambda[b][a]` is λ_b at corner a.
    #[inline]
    pub(crate) fn set(
        &mut self,
        lambda: &[[f64; 3]; 4],
        values: &[[f64; 4]],
        frame: &TetFrame,
        normal: &Vec3,
    ) -> bool {
        let rise = [0, 1, 2, 3].map(|b| frame.gradient(b).dot(normal));
        self.len = values.len();
        for (k, [v0, v1, v2, v3]) in values.iter().enumerate() {
            for (a, at) in self.at[k].iter_mut().enumerate() {
                *at = v0 * lambda[0][a] + v1 * lambda[1][a] + v2 * lambda[2][a] + v3 * lambda[3][a];
            }
            self.slope[k] = v0 * rise[0] + v1 * rise[1] + v2 * rise[2] + v3 * rise[3];
        }
        self.compare();
        self.cut_by_faces(lambda, &rise)
    }

    /// Which is above which.
    #[inline(always)]
    fn compare(&mut self) {
        for k in 0..self.len {
            let [x, y, z] = self.at[k];
            for j in k + 1..self.len {
                let [u, v, w] = self.at[j];
                let below = u8::from(u < x) + u8::from(v < y) + u8::from(w < z);
                // Where two are the same, the former has the point.
                (self.outside[k][j], self.outside[j][k]) = (below, 3 - below);
            }
        }
    }

    /// Lists the faces that cut something; false if one leaves nothing.
    #[inline(always)]
    fn cut_by_faces(&mut self, lambda: &[[f64; 3]; 4], rise: &[f64; 4]) -> bool {
        self.faces_len = 0;
        let mut is_somewhere = true;
        for b in 0..4 {
            // The faces inside a block belong to the tetrahedron on the triangle's inner side.
            let cut = Cut::new(lambda[b], rise[b] < 0.0);
            let outside = cut.outside();
            self.faces[self.faces_len] = cut;
            self.faces_len += usize::from(outside > 0);
            is_somewhere &= outside < 3;
        }
        is_somewhere
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// φ at the triangle's corners where the k-th is the smallest.
    #[inline(always)]
    pub(crate) fn phi(&self, k: usize) -> &[f64; 3] {
        &self.at[k]
    }

    /// |∂φ/∂n| there [1/m].
    #[inline(always)]
    pub(crate) fn slope(&self, k: usize) -> f64 {
        self.slope[k].abs()
    }

    /// Whether no other is below the k-th at all corners.
    #[inline(always)]
    pub(crate) fn is_somewhere(&self, k: usize) -> bool {
        let mut is_somewhere = true;
        for j in 0..self.len {
            is_somewhere &= self.outside[k][j] < 3;
        }
        is_somewhere
    }

    /// How many cuts the region of the k-th has.
    #[inline(always)]
    pub(crate) fn count_cuts(&self, k: usize) -> usize {
        let mut count = self.faces_len;
        for j in 0..self.len {
            count += usize::from(self.outside[k][j] > 0);
        }
        count
    }

    /// Gives each cut of the region of the k-th its place and returns how many there are; a place may be given again, and the one after
    /// the last too: branch-free append, `len` advances only if it is active.
    #[inline(always)]
    pub(crate) fn cuts(&self, k: usize, mut put: impl FnMut(usize, Cut)) -> usize {
        for (n, cut) in self.faces[..self.faces_len].iter().enumerate() {
            put(n, *cut);
        }
        let (mut len, own) = (self.faces_len, &self.at[k]);
        for j in 0..self.len {
            let other = &self.at[j];
            put(len, Cut::new([other[0] - own[0], other[1] - own[1], other[2] - own[2]], k < j));
            len += usize::from(self.outside[k][j] > 0);
        }
        len
    }
}

/// For region i of the element potential, how many corners are outside of λ_i ≥ 0 (at [i][i]) and of λ_j ≥ λ_i (at
/// [i][j]).
#[inline(always)]
pub(crate) fn element_outside(lambda: &[[f64; 3]; 4]) -> [[u8; 4]; 4] {
    let mut outside = [[0; 4]; 4];
    for i in 0..4 {
        let [x, y, z] = &lambda[i];
        outside[i][i] = u8::from(*x < 0.0) + u8::from(*y < 0.0) + u8::from(*z < 0.0);
        for j in i + 1..4 {
            let [u, v, w] = &lambda[j];
            let below = u8::from(u < x) + u8::from(v < y) + u8::from(w < z);
            (outside[i][j], outside[j][i]) = (below, 3 - below);
        }
    }
    outside
}

/// Whether no cut of a region has all corners outside.
#[inline(always)]
pub(crate) fn is_somewhere([a, b, c, d]: &[u8; 4]) -> bool {
    (*a != 3) & (*b != 3) & (*c != 3) & (*d != 3)
}

/// How many of the cuts of a region cut something, where one has not all corners outside.
#[inline(always)]
pub(crate) fn count_cuts(outside: &[u8; 4]) -> usize {
    outside.iter().map(|n| usize::from(*n > 0)).sum()
}

/// The cuts of region i of the element potential that cut something: λ_i ≥ 0, and λ_j − λ_i; where λ_i = λ_j the
/// smaller index has the point. Gives each its place and returns how many there are; a place may be given again, and
/// the one after the last too: branch-free append, `len` advances only if it is active.
#[inline(always)]
pub(crate) fn element_cuts(
    lambda: &[[f64; 3]; 4],
    outside: &[[u8; 4]; 4],
    i: usize,
    mut put: impl FnMut(usize, Cut),
) -> usize {
    let own = &lambda[i];
    let mut len = 0;
    for j in 0..4 {
        let base = if j == i { [0.0; 3] } else { *own };
        let ahead = [lambda[j][0] - base[0], lambda[j][1] - base[1], lambda[j][2] - base[2]];
        put(len, Cut::new(ahead, i <= j));
        len += usize::from(outside[i][j] > 0);
    }
    len
}

/// The regions of the element potential that are somewhere.
pub fn element_regions(lambda: &[[f64; 3]; 4], slopes: &[f64; 4], mut visit: impl FnMut(usize, &Region)) {
    let (mut region, outside) = (Region::default(), element_outside(lambda));
    // One by one: a loop would look up the region for each of its cuts.
    visit_element(&mut region, lambda, &outside, slopes, 0, &mut visit);
    visit_element(&mut region, lambda, &outside, slopes, 1, &mut visit);
    visit_element(&mut region, lambda, &outside, slopes, 2, &mut visit);
    visit_element(&mut region, lambda, &outside, slopes, 3, &mut visit);
}

/// Region i if it is somewhere.
#[inline(always)]
fn visit_element(
    region: &mut Region,
    lambda: &[[f64; 3]; 4],
    outside: &[[u8; 4]; 4],
    slopes: &[f64; 4],
    i: usize,
    visit: &mut impl FnMut(usize, &Region),
) {
    if region.set_element(lambda, outside, i, slopes[i]) {
        visit(i, region);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let mut total = 0.0;
        element_regions(lambda, &[0.0; 4], |_, r| {
            total += r.polygon(&Outline::TRIANGLE).fan().map(|(_, part)| part).sum::<f64>()
        });
        total
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

    #[test]
    fn a_shallow_triangle_far_from_the_kinks_needs_no_cut() {
        let lambda = lambda_of([[0.3, 0.3, 0.01], [0.35, 0.3, 0.01], [0.3, 0.35, 0.01]]);
        let mut seen = Vec::new();
        element_regions(&lambda, &[0.0; 4], |i, region| seen.push((i, region.cuts().len())));
        assert_eq!(seen, [(3, 0)]);
    }
}
