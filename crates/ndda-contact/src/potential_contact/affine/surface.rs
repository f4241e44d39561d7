//! The flat faces of a block's surface in its rest shape, and whether the block is convex.

use ndda_mesh::geometry::{Aabb, reach_below, triangle_area_vector};
use ndda_mesh::{BlockId, BlockSet, NodeId, Vec3};

/// Triangles whose normals and offsets differ by less than this part are in one plane.
const SAME_PLANE: f64 = 1e-9;
/// Corners that are drawn far from the origin of the scene are off by their last digit: so many of these leave triangles in one plane.
const DIGITS: f64 = 16.0;

/// A plane of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Outward unit normal.
    pub normal: Vec3,
    /// A point of it [m].
    pub point: Vec3,
}

impl Plane {
    /// Distance below it [m].
    pub(crate) fn depth_m(&self, x: &Vec3) -> f64 {
        self.normal.dot(&(self.point - x))
    }
}

/// The faces of one block.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockFaces {
    /// The plane of each face: triangles of one plane that hang together are one face.
    pub planes: Vec<Plane>,
    /// Face of each boundary triangle of the block.
    pub of_triangle: Vec<usize>,
    /// Whether the surface is one piece and bends outward over every edge: then the block is convex.
    pub convex: bool,
}

impl BlockFaces {
    /// The faces of all blocks.
    pub fn of_all(blocks: &BlockSet) -> Vec<Self> {
        blocks.ids().map(|block| Self::new(blocks, block)).collect()
    }

    /// The faces of a block.
    pub fn new(blocks: &BlockSet, block: BlockId) -> Self {
        let triangles = &blocks.triangles[blocks.triangles_of(block)];
        let rest = |n: &NodeId| blocks.rest_position[n.index()];
        let all = |t: &[NodeId; 3]| {
            let corners = [rest(&t[0]), rest(&t[1]), rest(&t[2])];
            Plane { normal: triangle_area_vector(&corners).normalize(), point: corners[0] }
        };
        let own: Vec<Plane> = triangles.iter().map(all).collect();
        let size = Aabb::around(blocks.rest_position[blocks.nodes_of(block)].iter()).diagonal();
        let neighbours = neighbours(triangles);
        let off = SAME_PLANE + DIGITS * f64::EPSILON * blocks.origin_m.amax() / size;
        let same = |seed: &Plane, t: usize| {
            (own[t].normal - seed.normal).norm() <= off && seed.depth_m(&own[t].point).abs() <= off * size
        };
        let (seeds, of_triangle) = pieces(&neighbours, |seed, t| same(&own[seed], t));
        let planes = seeds.iter().map(|&seed| own[seed]).collect();
        let bends_outward = |(t, around): (usize, &[usize; 3])| {
            around
                .iter()
                .all(|&other| triangles[other].iter().all(|n| own[t].depth_m(&rest(n)) >= -off * size))
        };
        let one_piece = pieces(&neighbours, |_, _| true).0.len() == 1;
        Self { planes, of_triangle, convex: one_piece && neighbours.iter().enumerate().all(bends_outward) }
    }

    /// Width of a convex block at rest: how far it reaches below a face, where that is least [m].
    pub(crate) fn width_m(&self, blocks: &BlockSet, block: BlockId) -> Option<f64> {
        let nodes = &blocks.rest_position[blocks.nodes_of(block)];
        let reach = |plane: &Plane| reach_below(&plane.normal, &plane.point, nodes);
        self.convex.then(|| self.planes.iter().map(reach).fold(f64::INFINITY, f64::min))
    }

    /// The boundary triangles of a face, among those of all blocks.
    pub(crate) fn triangles_of(
        &self,
        blocks: &BlockSet,
        block: BlockId,
        face: usize,
    ) -> impl Iterator<Item = usize> {
        let all = blocks.triangles_of(block).zip(&self.of_triangle);
        all.filter(move |(_, of)| **of == face).map(|(triangle, _)| triangle)
    }

    /// The largest of them at rest.
    pub(crate) fn largest_triangle(&self, blocks: &BlockSet, block: BlockId, face: usize) -> usize {
        let area = |t: &usize| {
            let corners = blocks.triangles[*t].map(|n| blocks.rest_position[n.index()]);
            triangle_area_vector(&corners).norm()
        };
        let own = self.triangles_of(blocks, block, face);
        own.max_by(|a, b| area(a).total_cmp(&area(b))).expect("a face has triangles")
    }
}

/// The triangles across the three edges of each; a triangle without a neighbour is its own.
fn neighbours(triangles: &[[NodeId; 3]]) -> Vec<[usize; 3]> {
    let edge = |t: usize, k: usize| {
        let (a, b) = (triangles[t][k], triangles[t][(k + 1) % 3]);
        (a.min(b), a.max(b), t, k)
    };
    let mut edges: Vec<_> = (0..triangles.len()).flat_map(|t| (0..3).map(move |k| edge(t, k))).collect();
    edges.sort_unstable();
    let mut around: Vec<[usize; 3]> = (0..triangles.len()).map(|t| [t; 3]).collect();
    for pair in edges.windows(2).filter(|pair| (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1)) {
        let ((_, _, t, k), (_, _, other, l)) = (pair[0], pair[1]);
        (around[t][k], around[other][l]) = (other, t);
    }
    around
}

/// Connected pieces of triangles that belong to the first of their piece; the firsts, and the piece of each triangle.
fn pieces(neighbours: &[[usize; 3]], belongs: impl Fn(usize, usize) -> bool) -> (Vec<usize>, Vec<usize>) {
    let mut piece_of = vec![usize::MAX; neighbours.len()];
    let (mut seeds, mut front) = (Vec::new(), Vec::new());
    for seed in 0..neighbours.len() {
        if piece_of[seed] != usize::MAX {
            continue;
        }
        piece_of[seed] = seeds.len();
        front.push(seed);
        while let Some(t) = front.pop() {
            for &other in &neighbours[t] {
                if piece_of[other] == usize::MAX && belongs(seed, other) {
                    piece_of[other] = seeds.len();
                    front.push(other);
                }
            }
        }
        seeds.push(seed);
    }
    (seeds, piece_of)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{test_box, test_set};

    #[test]
    fn a_box_has_six_faces_whatever_its_mesh_and_is_convex() {
        for cells in [[1, 1, 1], [3, 2, 4]] {
            let blocks = test_set(vec![test_box([0.0; 3], [1.0, 2.0, 3.0], cells)]);
            let faces = BlockFaces::new(&blocks, BlockId(0));
            assert_eq!(faces.planes.len(), 6);
            assert!(faces.convex);
            for (t, &face) in blocks.triangles.iter().zip(&faces.of_triangle) {
                let on =
                    |n: &NodeId| faces.planes[face].depth_m(&blocks.rest_position[n.index()]).abs() < 1e-12;
                assert!(t.iter().all(on));
            }
        }
    }

    #[test]
    fn a_turned_box_has_six_faces_far_from_the_origin_of_the_scene_too() {
        for away_m in [0.0, 4.5e6, 1e7] {
            let mut mesh = test_box([0.0; 3], [1.0, 2.0, 3.0], [2, 1, 2]);
            let turn = ndda_mesh::Mat3::from(nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.1));
            mesh = mesh.placed(&turn, &(away_m * Vec3::new(1.0, -0.7, 0.3)));
            let blocks = test_set(vec![mesh]);
            let faces = BlockFaces::new(&blocks, BlockId(0));
            assert!(faces.planes.len() == 6 && faces.convex, "{away_m}: {}", faces.planes.len());
        }
    }
}
