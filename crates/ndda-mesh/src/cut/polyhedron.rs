//! A convex block by its vertices and faces.

use crate::Vec3;
use crate::geometry::{Aabb, reach_below};

/// Surface of faces of a box that planes are still to cut.
const NO_SURFACE: u32 = u32::MAX;

/// A flat face of a [`Polyhedron`].
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// Vertices, counter-clockwise seen from outside.
    pub vertices: Vec<u32>,
    /// Surface of the face: an index into the list of surfaces of its [`Blocks`](super::Blocks).
    pub surface: u32,
}

/// A convex polyhedron. Combinatorially exact: a closed surface of simple faces with V − E + F = 2.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyhedron {
    /// Positions [m].
    pub vertices: Vec<Vec3>,
    /// Faces, outward.
    pub faces: Vec<Face>,
}

impl Polyhedron {
    /// The box between two corners; its faces x_min, x_max, y_min, … carry the surfaces 0 to 5.
    pub fn cuboid(min_m: Vec3, max_m: Vec3) -> Self {
        let pick = |bit: usize, axis: usize| if bit == 1 { max_m[axis] } else { min_m[axis] };
        let vertices = (0..8usize).map(|i| Vec3::from_fn(|axis, _| pick(i >> axis & 1, axis))).collect();
        let rings = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let faces =
            (0..).zip(rings).map(|(surface, ring)| Face { vertices: ring.to_vec(), surface }).collect();
        Self { vertices, faces }
    }

    /// A box with room around bounds, to be cut down to a block by planes; its faces have no surface.
    pub(super) fn around(bounds: &Aabb) -> Self {
        let around = bounds.inflated(0.1 * bounds.diagonal());
        let mut cell = Self::cuboid(around.min, around.max);
        cell.faces.iter_mut().for_each(|face| face.surface = NO_SURFACE);
        cell
    }

    /// Whether planes have cut off all faces of the box that it was cut from.
    pub(super) fn is_within_surfaces(&self) -> bool {
        self.faces.iter().all(|face| face.surface != NO_SURFACE)
    }

    /// Positions around a face [m].
    pub fn ring(&self, face: &Face) -> impl Iterator<Item = Vec3> + '_ {
        let indices: Vec<u32> = face.vertices.clone();
        indices.into_iter().map(|i| self.vertices[i as usize])
    }

    /// Outward area vector of a face [m²]: half the sum of cross products about its first vertex.
    pub fn area_vector(&self, face: &Face) -> Vec3 {
        let at = |i: usize| self.vertices[face.vertices[i] as usize];
        let first = at(0);
        (1..face.vertices.len() - 1)
            .map(|i| (at(i) - first).cross(&(at(i + 1) - first)))
            .fold(Vec3::zeros(), |sum, area| sum + area)
            * 0.5
    }

    /// Volume [m³] and centroid [m]: tetrahedra between the mean vertex and fans of the faces.
    pub fn volume_and_centroid(&self) -> (f64, Vec3) {
        let mean = self.vertices.iter().sum::<Vec3>() / self.vertices.len() as f64;
        let (mut volume, mut moment) = (0.0, Vec3::zeros());
        for face in &self.faces {
            let at = |i: usize| self.vertices[face.vertices[i] as usize] - mean;
            let first = at(0);
            for i in 1..face.vertices.len() - 1 {
                let (b, c) = (at(i), at(i + 1));
                let part = first.dot(&b.cross(&c)) / 6.0;
                volume += part;
                moment += (first + b + c) * (part / 4.0);
            }
        }
        (volume, mean + moment / volume)
    }

    /// Volume [m³].
    pub fn volume_m3(&self) -> f64 {
        self.volume_and_centroid().0
    }

    /// Bounding box [m].
    pub fn bounds(&self) -> Aabb {
        Aabb::around(&self.vertices)
    }

    /// Smallest extent over the directions of the faces [m]: the thickness of a slab, plate or wedge.
    pub fn width_m(&self) -> f64 {
        let depth = |face: &Face| {
            let first = self.vertices[face.vertices[0] as usize];
            reach_below(&self.area_vector(face).normalize(), &first, &self.vertices)
        };
        self.faces.iter().map(depth).fold(f64::INFINITY, f64::min)
    }

    /// V − E + F, which is 2 for the surface of a solid without holes; `None` if an edge is not shared by two faces.
    pub fn euler(&self) -> Option<i64> {
        let mut edges: Vec<(u32, u32)> = Vec::new();
        for face in &self.faces {
            let n = face.vertices.len();
            edges.extend((0..n).map(|i| (face.vertices[i], face.vertices[(i + 1) % n])));
        }
        edges.sort_unstable();
        let paired = |w: &(u32, u32)| edges.binary_search(&(w.1, w.0)).is_ok();
        let is_closed = edges.windows(2).all(|w| w[0] != w[1]) && edges.iter().all(paired);
        is_closed.then(|| self.vertices.len() as i64 - edges.len() as i64 / 2 + self.faces.len() as i64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_has_the_numbers_of_a_box() {
        let block = Polyhedron::cuboid(Vec3::new(1.0, 2.0, 3.0), Vec3::new(2.0, 4.0, 6.0));
        let (volume, centroid) = block.volume_and_centroid();
        assert!((volume - 6.0).abs() < 1e-14);
        assert!((centroid - Vec3::new(1.5, 3.0, 4.5)).norm() < 1e-14);
        assert_eq!(block.euler(), Some(2));
        assert_eq!(block.width_m(), 1.0);
        assert_eq!(block.area_vector(&block.faces[0]), -Vec3::x() * 6.0);
        assert_eq!(block.area_vector(&block.faces[5]), Vec3::z() * 2.0);
    }

    #[test]
    fn a_surface_with_a_hole_has_no_euler_number() {
        let mut block = Polyhedron::cuboid(Vec3::zeros(), Vec3::repeat(1.0));
        block.faces.pop();
        assert_eq!(block.euler(), None);
    }
}
