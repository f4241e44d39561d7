//! Faces, and the parts of those of elastic blocks, as friction of whole faces sees them.
//!
//! Friction that stops the mean slip of a face leaves its points free to slip against each other. Where vibrations open one end of a face and then the
//! other, the mean is one of other points each time, and the block walks down a slope without any work of friction. So a face of
//! an elastic block that has enough triangles has parts, the cells of a grid of three by three along its principal axes at rest, whose friction is found for each; the facets of the face that lies on it are left without, since they do not tell the parts apart. A face that has touched all over since contact began needs no parts:
//! the weights of its points do not change.

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, BlockSet, Mat3, TriangleId, Vec3};

use crate::affine::surface::BlockFaces;
use crate::friction::patches::moments::{edge_angle, fourfold_angle, of_triangle, principal, tangents};
use crate::model::{ContactHistory, FaceMemory};

/// Numbers for each face and its nine parts.
const NUMBERS: u32 = 10;
/// Triangles from which on a face has parts.
const LEAST_TRIANGLES: usize = 8;
/// Distance from a line between two cells, over the size of a cell, within which a triangle lies on it.
const ON_THE_LINE: f64 = 1e-6;
/// Part of a facet that touches, from which on all of it counts as touching.
const WHOLE: f64 = 0.99;

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
            let face = self.face_of[triangles[0]] as usize;
            self.triangles[face] = triangles.len() as u32;
            if triangles.len() < LEAST_TRIANGLES {
                continue;
            }
            let face_at_rest = RestFace::new(blocks, triangles);
            for (&t, part) in triangles.iter().zip(face_at_rest.parts(blocks, triangles)) {
                self.part_of[t] = part;
            }
            self.area_m2[face] = face_at_rest.area_m2;
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
    /// Its principal axes.
    axes: [Vec3; 2],
}

impl RestFace {
    fn new(blocks: &BlockSet, triangles: &[usize]) -> Self {
        let vectors =
            || triangles.iter().map(|t| (triangle_area_vector(&corners(blocks, *t)), corners(blocks, *t)));
        let whole: Vec3 = vectors().map(|(vector, _)| vector).sum();
        let area_m2 = whole.norm();
        let share = |vector: &Vec3| vector.norm() / area_m2;
        let center: Vec3 = vectors().map(|(vector, corners)| share(&vector) * middle(&corners)).sum();
        let moment = |(vector, corners): (Vec3, [Vec3; 3])| {
            let arm = middle(&corners) - center;
            share(&vector) * (arm * arm.transpose() + of_triangle(&corners))
        };
        let second_moment_m2: Mat3 = vectors().map(moment).sum();
        let normal = whole / area_m2;
        let [s, t] = tangents(&normal);
        let angle = principal(&second_moment_m2, &[s, t]).2.or_else(|| {
            fourfold_angle(vectors().map(|(vector, corners)| {
                let arm = middle(&corners) - center;
                (share(&vector), [s.dot(&arm), t.dot(&arm)])
            }))
        });
        let angle = angle.unwrap_or_else(|| edge_angle(&corners(blocks, triangles[0]), &[s, t]));
        let along = s * angle.cos() + t * angle.sin();
        Self { area_m2, center, axes: [along, normal.cross(&along)] }
    }

    /// The cell of each triangle in a grid of three by three over the face; what lies on a line between two cells is of the middle one, so that a face and its mirror
    /// image have the same parts.
    fn parts(&self, blocks: &BlockSet, triangles: &[usize]) -> impl Iterator<Item = u8> {
        let along = |axis: &Vec3, x: &Vec3| axis.dot(&(x - self.center));
        let extents = self.axes.map(|axis| {
            let places = triangles.iter().flat_map(|t| corners(blocks, *t)).map(|x| along(&axis, &x));
            places.fold((0.0, 0.0), |(least, most): (f64, f64), x| (least.min(x), most.max(x)))
        });
        triangles.iter().map(move |t| {
            let middle = middle(&corners(blocks, *t));
            let [first, second] = [0, 1].map(|k| {
                let (least, most) = extents[k];
                let thirds = 3.0 * (along(&self.axes[k], &middle) - least) / (most - least);
                u8::from(thirds > 1.0 - ON_THE_LINE) + u8::from(thirds > 2.0 + ON_THE_LINE)
            });
            first + 3 * second
        })
    }
}

fn corners(blocks: &BlockSet, triangle: usize) -> [Vec3; 3] {
    blocks.triangle_corners(TriangleId(triangle as u32), &blocks.rest_position)
}

fn middle(corners: &[Vec3; 3]) -> Vec3 {
    corners.iter().sum::<Vec3>() / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{test_box, test_set};

    fn parts(size: [f64; 3], cells: [u32; 3], affine: bool) -> (BlockSet, FaceParts) {
        let blocks = test_set(vec![test_box([0.3, -0.2, 0.1], size, cells)]);
        let mut parts = FaceParts::default();
        parts.fit(&blocks, &BlockFaces::of_all(&blocks), &[affine]);
        (blocks, parts)
    }

    #[test]
    fn a_face_of_an_elastic_block_has_parts_of_like_size_that_are_the_same_wherever_the_block_is() {
        for size in [[1.0, 2.0, 3.0], [1.0, 1.0, 1.0]] {
            let (blocks, parts) = parts(size, [4, 4, 4], false);
            for face in 0..6 {
                let of_face = parts.face_of.iter().zip(&parts.part_of).filter(|(of, _)| **of == face);
                let mut sizes = [0; 9];
                of_face.for_each(|(_, part)| sizes[usize::from(*part)] += 1);
                assert!(sizes.iter().all(|count| (2..=8).contains(count)), "{size:?}: {sizes:?}");
            }
            let turn = nalgebra::Rotation3::new(Vec3::new(0.3, -0.7, 0.4));
            let mut turned = blocks.clone();
            turned.rest_position.iter_mut().for_each(|x| *x = turn * *x);
            let mut elsewhere = FaceParts::default();
            elsewhere.fit(&turned, &BlockFaces::of_all(&turned), &[false]);
            let (mut here, mut there) = (pairs_of(&parts), pairs_of(&elsewhere));
            here.sort_unstable();
            there.sort_unstable();
            assert_eq!(here, there);
        }
    }

    /// Pairs of triangles that are of the same part of a face.
    fn pairs_of(parts: &FaceParts) -> Vec<(usize, usize)> {
        let number = |t: usize| number_of(parts.face_of[t], Some(parts.part_of[t]));
        let count = parts.face_of.len();
        let pairs = (0..count).flat_map(|a| (0..a).map(move |b| (a, b)));
        pairs.filter(|(a, b)| number(*a) == number(*b)).collect()
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
