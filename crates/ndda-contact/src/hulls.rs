//! Planes that hold a convex block back: what is beyond one of them is not in the block.
//!
//! Blocks that lie side by side have many boundary triangles that touch each other's edges and are in nothing. One
//! comparison with the faces of the whole block says so, where its tetrahedra would be asked one by one.

use std::ops::Range;

use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockId, BlockSet, NodeId, Vec3};
use rayon::prelude::*;

use crate::block_faces::BlockFaces;

/// Faces below which a second thread costs more than it brings.
const GRAIN_FACES: usize = 1024;

/// A block of more faces is asked by its tetrahedra.
const MOST_FACES: usize = 32;

/// A face of a convex block, and where all of the block is behind it.
#[derive(Clone, Debug)]
struct Face {
    block: BlockId,
    /// Its largest triangle, which carries the plane along.
    corners: [NodeId; 3],
    normal: Vec3,
    point: Vec3,
    /// Largest n·(x − p) of the block's nodes.
    reach: f64,
}

/// The faces of all convex blocks, where they are now.
#[derive(Clone, Debug, Default)]
pub struct Hulls {
    faces: Vec<Face>,
    /// First face of each block; one that is concave or round has none.
    start: Vec<u32>,
}

impl Hulls {
    /// Takes the faces of all blocks; once per set of blocks.
    pub fn fit(&mut self, blocks: &BlockSet, surfaces: &[BlockFaces]) {
        self.faces.clear();
        self.start.clear();
        self.start.push(0);
        for (block, surface) in blocks.ids().zip(surfaces) {
            if surface.convex && surface.planes.len() <= MOST_FACES {
                let faces = 0..surface.planes.len();
                self.faces.extend(faces.map(|face| largest_of(blocks, block, surface, face)));
            }
            self.start.push(self.faces.len() as u32);
        }
    }

    /// Takes the faces to where the nodes are [m].
    pub fn place(&mut self, blocks: &BlockSet, position: &[Vec3]) {
        let place = |face: &mut Face| face.place(&position[blocks.nodes_of(face.block)], position);
        self.faces.par_iter_mut().with_min_len(GRAIN_FACES).for_each(place);
    }

    /// Whether a face of the block keeps it from the triangle; touching is not overlap.
    #[inline]
    pub fn keep_apart(&self, block: BlockId, triangle: &[Vec3; 3]) -> bool {
        self.faces[self.of(block)].iter().any(|face| triangle.iter().all(|x| face.is_beyond(x)))
    }

    fn of(&self, block: BlockId) -> Range<usize> {
        self.start[block.index()] as usize..self.start[block.index() + 1] as usize
    }
}

impl Face {
    fn place(&mut self, nodes: &[Vec3], position: &[Vec3]) {
        let corners = self.corners.map(|n| position[n.index()]);
        (self.normal, self.point) = (triangle_area_vector(&corners), corners[0]);
        let above = |x: &Vec3| self.normal.dot(&(x - self.point));
        self.reach = nodes.iter().map(above).fold(0.0, f64::max);
    }

    #[inline]
    fn is_beyond(&self, x: &Vec3) -> bool {
        self.normal.dot(&(x - self.point)) >= self.reach
    }
}

/// A face by its largest triangle.
fn largest_of(blocks: &BlockSet, block: BlockId, surface: &BlockFaces, face: usize) -> Face {
    let triangles = &blocks.triangles[blocks.triangles_of(block)];
    let area = |t: &[NodeId; 3]| triangle_area_vector(&t.map(|n| blocks.rest_position[n.index()])).norm();
    let own = triangles.iter().zip(&surface.of_triangle).filter(|(_, of)| **of == face).map(|(t, _)| t);
    let corners = *own.max_by(|a, b| area(a).total_cmp(&area(b))).expect("a face has triangles");
    Face { block, corners, normal: Vec3::zeros(), point: Vec3::zeros(), reach: f64::INFINITY }
}
