//! Faces, and the parts of those of elastic blocks, as friction of whole faces sees them.
//!
//! Friction that stops the mean slip of a face leaves its points free to slip against each other. Where vibrations open one end of a face and then the
//! other, the mean is one of other points each time, and the block walks down a slope without any work of friction. So a face of
//! an elastic block that has enough triangles has parts, cells of a grid along its principal axes at rest, whose friction is found for
//! each; the facets of the face that lies on it are left without, since they do not tell the parts apart. A face that has touched all over since contact began needs no parts:
//! the weights of its points do not change.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, BlockSet, Mat3, TriangleId, Vec3};

use crate::affine::surface::BlockFaces;
use crate::friction::patches::moments::{of_triangle, principal};
use crate::friction::patches::patch::tangents;
use crate::model::{ContactHistory, FaceMemory};

/// Numbers for each face and its parts, sixteen at most.
const NUMBERS: u32 = 17;
/// Triangles from which on a face has two by two or four by four parts: then each part of a square has two at least.
const LEAST_TRIANGLES: usize = 8;
const MANY_TRIANGLES: usize = 32;
/// Part of a facet that touches where all of it does, but for rounding.
const WHOLE: f64 = 1.0 - 1e-9;

/// The faces of all blocks.
#[derive(Default)]
pub(super) struct FaceParts {
    /// Face of each boundary triangle, numbered over all blocks.
    face_of: Vec<u32>,
    /// Its part of that.
    part_of: Vec<u8>,
    /// Area of each face at rest, where it has parts [m²]; infinite where not.
    area_m2: Vec<f64>,
    /// How many triangles it has.
    triangles: Vec<u32>,
}

impl FaceParts {
    /// Takes the faces of all blocks, those of a surface with a name apart; `affine` are blocks that move by affine maps.
    pub(super) fn fit(&mut self, blocks: &BlockSet, surfaces: &[BlockFaces], affine: &[bool]) {
        self.face_of.clear();
        self.part_of.clear();
        self.area_m2.clear();
        self.triangles.clear();
        for (block, BlockFaces { of_triangle, .. }) in blocks.ids().zip(surfaces) {
            let triangles = blocks.triangles_of(block);
            let named = &blocks.triangle_surface[triangles.clone()];
            let keys: Vec<_> = of_triangle.iter().zip(named).collect();
            let mut distinct = keys.clone();
            distinct.sort_unstable();
            distinct.dedup();
            let next = self.area_m2.len() as u32;
            let face = |key| next + distinct.partition_point(|other| other < key) as u32;
            self.face_of.extend(keys.iter().map(face));
            self.part_of.resize(self.face_of.len(), 0);
            self.area_m2.resize(self.area_m2.len() + distinct.len(), f64::INFINITY);
            self.triangles.resize(self.area_m2.len(), 0);
            self.face_of[triangles.clone()].iter().for_each(|face| self.triangles[*face as usize] += 1);
            let deforms = !affine.get(block.index()).copied().unwrap_or(false);
            if deforms && triangles.len() >= LEAST_TRIANGLES {
                self.divide(blocks, block);
            }
        }
    }

    /// Divides the faces of one block.
    fn divide(&mut self, blocks: &BlockSet, block: BlockId) {
        let mut by_face: Vec<usize> = blocks.triangles_of(block).collect();
        by_face.sort_by_key(|&t| self.face_of[t]);
        for triangles in by_face.chunk_by(|&a, &b| self.face_of[a] == self.face_of[b]) {
            if triangles.len() < LEAST_TRIANGLES {
                continue;
            }
            let face = RestFace::new(blocks, triangles);
            let [along, across] = face.axes(blocks, triangles);
            let n = if triangles.len() < MANY_TRIANGLES { 2 } else { 4 };
            let extent = |axis: &Vec3| {
                let places =
                    triangles.iter().flat_map(|t| corners(blocks, *t)).map(|x| axis.dot(&(x - face.center)));
                places.fold((0.0, 0.0), |(least, most): (f64, f64), x| (least.min(x), most.max(x)))
            };
            let extents = [extent(&along), extent(&across)];
            for &t in triangles {
                let arm = middle(&corners(blocks, t)) - face.center;
                let cell = |axis: &Vec3, (least, most): (f64, f64)| {
                    (((axis.dot(&arm) - least) / (most - least) * f64::from(n)) as u8).min(n - 1)
                };
                self.part_of[t] = cell(&along, extents[0]) + n * cell(&across, extents[1]);
            }
            self.area_m2[self.face_of[triangles[0]] as usize] = face.area_m2;
        }
    }

    /// The face of a boundary triangle.
    pub(super) fn face_of(&self, triangle: TriangleId) -> u32 {
        self.face_of[triangle.index()]
    }

    /// Its part of that.
    pub(super) fn part_of(&self, triangle: TriangleId) -> u8 {
        self.part_of[triangle.index()]
    }

    /// Whether a face touches all over; `areas_m2` are those of its facets that touch, of each the part that does and the whole [m²].
    pub(super) fn is_closed(&self, face: u32, mut areas_m2: impl ExactSizeIterator<Item = [f64; 2]>) -> bool {
        areas_m2.len() == self.triangles[face as usize] as usize
            && areas_m2.all(|[part, whole]| part >= WHOLE * whole)
    }

    /// Area of a face with parts [m²]; infinite of one without.
    pub(super) fn area_m2(&self, face: u32) -> f64 {
        self.area_m2[face as usize]
    }
}

/// The number under which the friction of a face as a whole, or of a part of it, is remembered.
pub(super) fn number_of(face: u32, part: Option<u8>) -> u32 {
    NUMBERS * face + part.map_or(0, |part| 1 + u32::from(part))
}

/// Order in which faces, the blocks that they touch and their parts are remembered.
pub(super) fn order_of(number: u32, target: BlockId) -> (u32, BlockId, u32) {
    (number / NUMBERS, target, number % NUMBERS)
}

/// Whether the friction of the parts of a face on a block is remembered.
pub(super) fn was_divided(history: &ContactHistory, face: u32, target: BlockId) -> bool {
    let first = order_of(number_of(face, Some(0)), target);
    let after = |memory: &FaceMemory| order_of(memory.face, memory.target) >= first;
    let place = history.faces.partition_point(|memory| !after(memory));
    history.faces.get(place).is_some_and(|memory| memory.face / NUMBERS == face && memory.target == target)
}

/// A face at rest.
struct RestFace {
    area_m2: f64,
    center: Vec3,
    normal: Vec3,
    second_moment_m2: Mat3,
}

impl RestFace {
    fn new(blocks: &BlockSet, triangles: &[usize]) -> Self {
        let vector = |t: &usize| triangle_area_vector(&corners(blocks, *t));
        let whole: Vec3 = triangles.iter().map(vector).sum();
        let area_m2 = whole.norm();
        let share = |t: &usize| vector(t).norm() / area_m2;
        let center: Vec3 = triangles.iter().map(|t| share(t) * middle(&corners(blocks, *t))).sum();
        let moment = |t: &usize| {
            let corners = corners(blocks, *t);
            let arm = middle(&corners) - center;
            share(t) * (arm * arm.transpose() + of_triangle(&corners))
        };
        let second_moment_m2 = triangles.iter().map(moment).sum();
        Self { area_m2, center, normal: whole / area_m2, second_moment_m2 }
    }

    /// Its principal axes; where all are the same, as those of a square, halfway between the direction of its first node and across it.
    fn axes(&self, blocks: &BlockSet, triangles: &[usize]) -> [Vec3; 2] {
        let [s, t] = tangents(&self.normal);
        let along = match principal(&self.second_moment_m2, &[s, t]).2 {
            Some(angle) => s * angle.cos() + t * angle.sin(),
            None => {
                let nodes = triangles.iter().flat_map(|t| blocks.triangles[*t]);
                let first = nodes.min().map_or(s, |node| blocks.rest_position[node.index()] - self.center);
                first + self.normal.cross(&first)
            }
        };
        [along, self.normal.cross(&along)]
    }
}

fn corners(blocks: &BlockSet, triangle: usize) -> [Vec3; 3] {
    blocks.triangles[triangle].map(|node| blocks.rest_position[node.index()])
}

fn middle(corners: &[Vec3; 3]) -> Vec3 {
    corners.iter().sum::<Vec3>() / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{test_box, test_set};

    fn parts(size: [f64; 3], cells: [usize; 3], affine: bool) -> (BlockSet, FaceParts) {
        let blocks = test_set(vec![test_box([0.3, -0.2, 0.1], size, cells)]);
        let mut parts = FaceParts::default();
        parts.fit(&blocks, &BlockFaces::of_all(&blocks), &[affine]);
        (blocks, parts)
    }

    #[test]
    fn a_face_of_an_elastic_block_has_parts_of_the_same_area_even_where_it_is_square() {
        for size in [[1.0, 2.0, 3.0], [1.0, 1.0, 1.0]] {
            let (blocks, parts) = parts(size, [4, 4, 4], false);
            let mut areas = std::collections::BTreeMap::<u32, f64>::new();
            for (t, corners) in blocks.triangles.iter().enumerate() {
                let corners = corners.map(|node| blocks.rest_position[node.index()]);
                let number = number_of(parts.face_of[t], Some(parts.part_of[t]));
                *areas.entry(number).or_default() += triangle_area_vector(&corners).norm();
            }
            assert_eq!(areas.len(), 6 * 16);
            for (number, area_m2) in areas {
                let whole_m2 = parts.area_m2(number / NUMBERS);
                assert!(
                    (area_m2 / whole_m2 - 1.0 / 16.0).abs() < 1e-12,
                    "part {number}: {area_m2} of {whole_m2}"
                );
            }
        }
    }

    #[test]
    fn affine_blocks_and_faces_of_few_triangles_have_no_parts() {
        for (cells, affine) in [([4, 4, 4], true), ([1, 1, 1], false)] {
            let (_, parts) = parts([1.0, 2.0, 3.0], cells, affine);
            assert!(parts.part_of.iter().all(|part| *part == 0));
            assert!((0..6).all(|face| parts.area_m2(face) == f64::INFINITY));
        }
    }
}
