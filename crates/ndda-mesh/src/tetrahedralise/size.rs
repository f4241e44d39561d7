//! How long edges should be, and where.

use super::{FillError, MOST_TETS};
use crate::Vec3;
use crate::cut::{Face, Polyhedron};

/// How fast edges grow away from features of the block that are smaller than the size.
const FEATURE_GROWTH: f64 = 1.0;
/// Edges are at most this many times as long as the block is wide, or tetrahedra would be flat.
const LENGTH_PER_WIDTH: f64 = 2.0;
/// Small features and thin blocks refine the mesh down to this fraction of the size, not further.
const FINEST: f64 = 0.25;
/// Volume of a tetrahedron over its edge cubed, for a good mixture.
const TET_VOLUME: f64 = 0.1;

/// Places towards which the mesh is finer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Towards {
    /// A point [m].
    Point(Vec3),
    /// The plane through a point with a normal of any length, that of a face for instance.
    Plane {
        /// The point [m].
        point_m: Vec3,
        /// The normal.
        normal: Vec3,
    },
}

/// Edges of `size_m` at a place, growing by `growth` metres per metre away from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grading {
    /// The place.
    pub towards: Towards,
    /// Length of edges there [m].
    pub size_m: f64,
    /// Growth of the length with distance; 0.3 is gentle, 1 is steep.
    pub growth: f64,
}

/// Target length of edges: h(x) = min over all places of (size + growth · distance).
pub(super) struct SizeField {
    largest_m: f64,
    points: Vec<(Vec3, f64, f64)>,
    /// Point, unit normal, size, growth.
    planes: Vec<(Vec3, Vec3, f64, f64)>,
    /// Tetrahedra to expect.
    pub tets: f64,
}

fn positive(what: &'static str, value: f64) -> Result<(), FillError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(FillError::Number { what, value }) }
}

impl SizeField {
    pub(crate) fn new(block: &Polyhedron, size_m: f64, finer: &[Grading]) -> Result<Self, FillError> {
        positive("size_m", size_m)?;
        let largest_m = size_m.min((LENGTH_PER_WIDTH * block.width_m()).max(FINEST * size_m));
        let mut size = Self { largest_m, points: Vec::new(), planes: Vec::new(), tets: 0.0 };
        for grading in finer {
            positive("size_m of a grading", grading.size_m)?;
            positive("growth of a grading", grading.growth)?;
            match grading.towards {
                Towards::Point(at) => size.points.push((at, grading.size_m, grading.growth)),
                Towards::Plane { point_m, normal } => {
                    let length = normal.norm();
                    positive("length of the normal of a grading", length)?;
                    size.planes.push((point_m, normal / length, grading.size_m, grading.growth));
                }
            }
        }
        for vertex in 0..block.vertices.len() as u32 {
            let feature_m = feature_size(block, vertex).max(FINEST * size_m);
            if feature_m < largest_m {
                size.points.push((block.vertices[vertex as usize], feature_m, FEATURE_GROWTH));
            }
        }
        size.tets = size.count(block);
        let tets = size.tets;
        if tets <= MOST_TETS as f64 { Ok(size) } else { Err(FillError::TooFine { size_m, tets }) }
    }

    /// The field of a concave block in parts.
    pub(crate) fn of_parts(parts: &[&Polyhedron], size_m: f64, finer: &[Grading]) -> Result<Self, FillError> {
        let mut size = Self { largest_m: 0.0, points: Vec::new(), planes: Vec::new(), tets: 0.0 };
        for part in parts {
            let own = Self::new(part, size_m, finer)?;
            size.largest_m = size.largest_m.max(own.largest_m);
            size.tets += own.tets;
            size.points.extend(own.points);
            // Settings that are equal in all parts.
            size.planes = own.planes;
        }
        let tets = size.tets;
        if tets <= MOST_TETS as f64 { Ok(size) } else { Err(FillError::TooFine { size_m, tets }) }
    }

    /// Target length of edges at a point [m].
    pub(crate) fn at(&self, x: &Vec3) -> f64 {
        let mut least = self.largest_m;
        for (at, size, growth) in &self.points {
            // Most points are too far to matter, which takes no root.
            let reach = (least - size) / growth;
            let squared = (x - at).norm_squared();
            if reach > 0.0 && squared < reach * reach {
                least = least.min(size + growth * squared.sqrt());
            }
        }
        let near_planes =
            self.planes.iter().map(|(at, n, size, growth)| size + growth * n.dot(&(x - at)).abs());
        near_planes.fold(least, f64::min)
    }

    /// Tetrahedra to expect, from the size sampled between the centroid and the vertices.
    fn count(&self, block: &Polyhedron) -> f64 {
        let (volume, centroid) = block.volume_and_centroid();
        let fine = |size: f64| 1.0 / (TET_VOLUME * size.powi(3));
        let mut sum = 0.0;
        for i in 0..10 {
            let t = (f64::from(i) + 0.5) / 10.0;
            // The shell between t − 0.05 and t + 0.05 holds this share of the volume.
            let share = (t + 0.05).powi(3) - (t - 0.05).powi(3);
            let mean =
                block.vertices.iter().map(|x| fine(self.at(&(centroid + (x - centroid) * t)))).sum::<f64>();
            sum += volume * share * mean / block.vertices.len() as f64;
        }
        sum
    }
}

/// Distance from a vertex to the nearest other vertex or face that it is not part of [m].
fn feature_size(block: &Polyhedron, vertex: u32) -> f64 {
    let at = block.vertices[vertex as usize];
    let others = (0..block.vertices.len()).filter(|&v| v != vertex as usize);
    let nearest = others.map(|v| (block.vertices[v] - at).norm()).fold(f64::INFINITY, f64::min);
    let faces = block.faces.iter().filter(|face| !face.vertices.contains(&vertex));
    faces.map(|face| distance(block, face, &at)).fold(nearest, f64::min)
}

/// Distance of a point from a convex face [m].
fn distance(block: &Polyhedron, face: &Face, point: &Vec3) -> f64 {
    let ring: Vec<Vec3> = block.ring(face).collect();
    let normal = block.area_vector(face).normalize();
    let mut is_above = true;
    let mut nearest = f64::INFINITY;
    for (i, a) in ring.iter().enumerate() {
        let edge = ring[(i + 1) % ring.len()] - a;
        let to_point = point - a;
        is_above &= normal.dot(&edge.cross(&to_point)) >= 0.0;
        let along = (edge.dot(&to_point) / edge.norm_squared()).clamp(0.0, 1.0);
        nearest = nearest.min((to_point - edge * along).norm());
    }
    if is_above { normal.dot(&(point - ring[0])).abs() } else { nearest }
}
