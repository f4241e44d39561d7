//! Volume, area, boxes: the geometry that every other crate needs.

use crate::Vec3;

/// Signed volume of a tetrahedron [m³]: (b − a) · ((c − a) × (d − a)) / 6.
#[inline]
pub fn tet_volume(corners: &[Vec3; 4]) -> f64 {
    let [a, b, c, d] = corners;
    (b - a).dot(&(c - a).cross(&(d - a))) / 6.0
}

/// Area vector of a triangle [m²]: (b − a) × (c − a) / 2, along the right-hand normal.
#[inline]
pub fn triangle_area_vector(corners: &[Vec3; 3]) -> Vec3 {
    let [a, b, c] = corners;
    (b - a).cross(&(c - a)) * 0.5
}

/// How far points reach below a plane through `point` with an outward unit normal [m].
#[inline]
pub fn reach_below<'a>(normal: &Vec3, point: &Vec3, points: impl IntoIterator<Item = &'a Vec3>) -> f64 {
    points.into_iter().map(|x| normal.dot(&(point - x))).fold(0.0, f64::max)
}

/// Distance of a point to a triangle [m] (Ericson 2005, §5.1.5).
pub fn distance_to_triangle(p: &Vec3, [a, b, c]: &[Vec3; 3]) -> f64 {
    let normal = (b - a).cross(&(c - a));
    let inside = |u: &Vec3, v: &Vec3| (v - u).cross(&(p - u)).dot(&normal) >= 0.0;
    if inside(a, b) && inside(b, c) && inside(c, a) {
        return (p - a).dot(&normal).abs() / normal.norm();
    }
    let to_edge = |u: &Vec3, v: &Vec3| {
        let along = v - u;
        let t = ((p - u).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        (p - (u + along * t)).norm()
    };
    to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a))
}

/// Heights of a tetrahedron over its four faces [m]: 3 V / A, face `i` being opposite to corner `i`.
#[inline]
pub fn tet_heights(corners: &[Vec3; 4]) -> [f64; 4] {
    let volume = tet_volume(corners).abs();
    TET_FACES.map(|face| 3.0 * volume / triangle_area_vector(&face.map(|i| corners[i])).norm())
}

/// Barycentric coordinates of a point in a tetrahedron [1], one per corner, which sum to one; none in a tetrahedron without volume.
pub fn barycentric([a, b, c, d]: &[Vec3; 4], point: &Vec3) -> Option<[f64; 4]> {
    let (u, v, w, p) = (b - a, c - a, d - a, point - a);
    let volume6 = u.dot(&v.cross(&w));
    if volume6 == 0.0 {
        return None;
    }
    let second = p.dot(&v.cross(&w)) / volume6;
    let third = u.dot(&p.cross(&w)) / volume6;
    let fourth = u.dot(&v.cross(&p)) / volume6;
    Some([1.0 - second - third - fourth, second, third, fourth])
}

/// Local corners of the face opposite to each corner, outward for a tetrahedron of positive volume.
pub const TET_FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// An axis-aligned box [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// The box that holds nothing; growing it by a point gives that point.
    pub fn empty() -> Self {
        Self { min: Vec3::repeat(f64::INFINITY), max: Vec3::repeat(f64::NEG_INFINITY) }
    }

    /// The smallest box around `points`.
    pub fn around<'a>(points: impl IntoIterator<Item = &'a Vec3>) -> Self {
        let mut bounds = Self::empty();
        for point in points {
            bounds.grow(point);
        }
        bounds
    }

    /// Makes the box hold `point` too.
    pub fn grow(&mut self, point: &Vec3) {
        // NaN is left out.
        for i in 0..3 {
            self.min[i] = if point[i] < self.min[i] { point[i] } else { self.min[i] };
            self.max[i] = if point[i] > self.max[i] { point[i] } else { self.max[i] };
        }
    }

    /// The box with `margin_m` added on every side.
    pub fn inflated(&self, margin_m: f64) -> Self {
        Self { min: self.min.add_scalar(-margin_m), max: self.max.add_scalar(margin_m) }
    }

    /// Whether the two closed boxes share a point.
    pub fn touches(&self, other: &Self) -> bool {
        (0..3).all(|i| self.min[i] <= other.max[i] && other.min[i] <= self.max[i])
    }

    /// Length of the diagonal [m]; zero for an empty box.
    pub fn diagonal(&self) -> f64 {
        if self.min.x > self.max.x { 0.0 } else { (self.max - self.min).norm() }
    }

    /// Centre of the box [m].
    pub fn center(&self) -> Vec3 {
        (self.min + self.max) * 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: [Vec3; 4] = [
        Vec3::new(0.0, 0.0, 0.0),
        Vec3::new(1.0, 0.0, 0.0),
        Vec3::new(0.0, 1.0, 0.0),
        Vec3::new(0.0, 0.0, 1.0),
    ];

    #[test]
    fn the_unit_corner_tetrahedron_has_a_sixth_of_the_cube() {
        assert_eq!(tet_volume(&UNIT), 1.0 / 6.0);
        let heights = tet_heights(&UNIT);
        assert!((heights[0] - 1.0 / 3f64.sqrt()).abs() < 1e-15);
        assert_eq!(heights[1], 1.0);
    }

    #[test]
    fn face_normals_point_outward() {
        let centroid = UNIT.iter().sum::<Vec3>() / 4.0;
        for face in TET_FACES {
            let corners = face.map(|i| UNIT[i]);
            let to_face = corners.iter().sum::<Vec3>() / 3.0 - centroid;
            assert!(triangle_area_vector(&corners).dot(&to_face) > 0.0);
        }
    }

    #[test]
    fn boxes_that_share_a_face_touch() {
        let left = Aabb::around(&[Vec3::zeros(), Vec3::repeat(1.0)]);
        let right = Aabb::around(&[Vec3::new(1.0, 0.0, 0.0), Vec3::new(2.0, 1.0, 1.0)]);
        assert!(left.touches(&right));
        assert!(!left.touches(&right.inflated(-0.1)));
    }
}
