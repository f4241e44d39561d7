//! Faces as contactors: what a block that is an affine convex target puts into others that are, too.
//!
//! A convex block that moves by an affine map keeps its faces plane, and what presses on a face moves all of the block, so that it
//! does not matter which of the face's nodes take the force. Integrals over a face then are those over one of its
//! triangles, the largest, continued to the outline of the face: its ψ are coordinates of the whole plane. They cost
//! no more than those over a triangle, however many the face is made of. What they come to is shared by three corners of the face
//! around its centre.

use ndda_mesh::geometry::{Aabb, triangle_area_vector};
use ndda_mesh::planar::{hull_of_sorted, turn};
use ndda_mesh::{BlockId, BlockSet, NodeId, TriangleId, Vec3};

use crate::affine::surface::BlockFaces;
use crate::integration::capacity::MOST_CORNERS;
use crate::integration::clip::Outline;
use crate::integration::pair_moments::PsiRange;
use crate::integration::tet_frame::TetFrame;

/// A face more times as large as its largest triangle is left to its triangles: most of it is far from what it touches, and
/// coordinates would lose digits.
const MOST_TIMES: f64 = 16.0;

/// Corners of an outline that turn by less than this are none.
const STRAIGHT: f64 = 1e-9;

/// A face, put into blocks that are affine convex targets.
#[derive(Clone, Debug)]
pub(crate) struct FaceContactor {
    /// Its largest triangle, which stands for it.
    pub triangle: TriangleId,
    /// Its corners, counter-clockwise.
    nodes: Vec<NodeId>,
    /// Outline of the face in coordinates of the triangle.
    pub outline: Outline,
    /// Least and largest ψ₁ and ψ₂.
    pub range: PsiRange,
    /// λ_b of the host of its block at the corners of the triangle, as `[b][a]`.
    pub on_host: [[f64; 3]; 4],
}

/// The faces of blocks that are affine convex targets.
#[derive(Clone, Debug, Default)]
pub(crate) struct FaceContactors {
    all: Vec<FaceContactor>,
    /// First of each block.
    start: Vec<u32>,
    /// Place of the face that each triangle stands for, if any, from one; empty where no block has any.
    place_of: Vec<u32>,
}

impl FaceContactors {
    /// Begins anew.
    pub(crate) fn clear(&mut self) {
        self.all.clear();
        self.start.clear();
        self.start.push(0);
        self.place_of.clear();
    }

    /// Takes the faces of the next block, which is an affine convex target with this host; none of them unless each is a convex polygon of one surface,
    /// neither too large nor with too many corners.
    pub(crate) fn take(&mut self, blocks: &BlockSet, block: BlockId, surface: &BlockFaces, host: &TetFrame) {
        let faces =
            (0..surface.planes.len()).map(|face| FaceContactor::new(blocks, block, surface, face, host));
        if let Some(faces) = faces.collect::<Option<Vec<_>>>() {
            self.place_of.resize(blocks.triangles.len(), 0);
            for face in faces {
                self.place_of[face.triangle.index()] = self.all.len() as u32 + 1;
                self.all.push(face);
            }
        }
        self.skip();
    }

    /// The next block has none.
    pub(crate) fn skip(&mut self) {
        self.start.push(self.all.len() as u32);
    }

    /// The faces of a block; none of one that is put into others triangle by triangle.
    #[inline]
    pub(crate) fn of_block(&self, block: BlockId) -> &[FaceContactor] {
        let start = |block: usize| self.start.get(block).map_or(0, |&start| start as usize);
        &self.all[start(block.index())..start(block.index() + 1)]
    }

    /// The face that a triangle stands for.
    #[inline]
    pub(crate) fn of_triangle(&self, triangle: TriangleId) -> Option<&FaceContactor> {
        let place = *self.place_of.get(triangle.index())?;
        Some(&self.all[place.checked_sub(1)? as usize])
    }
}

impl FaceContactor {
    fn new(
        blocks: &BlockSet,
        block: BlockId,
        surface: &BlockFaces,
        face: usize,
        host: &TetFrame,
    ) -> Option<Self> {
        let rest = |n: &NodeId| blocks.rest_position[n.index()];
        let own: Vec<usize> = surface.triangles_of(blocks, block, face).collect();
        let largest = surface.largest_triangle(blocks, block, face);
        let area = |t: &usize| triangle_area_vector(&blocks.triangles[*t].each_ref().map(rest)).norm();
        let times = own.iter().map(area).sum::<f64>() / area(&largest);
        let is_one_surface =
            own.iter().all(|&t| blocks.triangle_surface[t] == blocks.triangle_surface[largest]);
        // Meshes of equal triangles reach it exactly, but for rounding.
        if times > MOST_TIMES * (1.0 + STRAIGHT) || !is_one_surface {
            return None;
        }
        let corners = blocks.triangles[largest].each_ref().map(rest);
        let mut points: Vec<(NodeId, [f64; 2])> = Vec::new();
        for n in own.iter().flat_map(|&t| blocks.triangles[t]) {
            let at = match blocks.triangles[largest].iter().position(|m| *m == n) {
                Some(a) => [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]][a],
                None => psi_of(&rest(&n), &corners),
            };
            points.push((n, at));
        }
        let hull = hull_of(points);
        let fills = hull.windows(3).map(|w| turn(&hull[0].1, &w[1].1, &w[2].1)).sum::<f64>();
        // A face that does not fill its hull would be another one.
        if hull.len() > MOST_CORNERS || (fills - times).abs() > STRAIGHT * times {
            return None;
        }
        let (nodes, outline): (Vec<_>, Vec<_>) = hull.into_iter().unzip();
        let triangle = TriangleId(largest as u32);
        let outline =
            if nodes == blocks.triangles[largest] { Outline::TRIANGLE } else { Outline::of_face(&outline)? };
        let range = range_of(&outline);
        Some(Self { triangle, nodes, outline, range, on_host: host.lambda(&corners) })
    }

    /// Three corners around the centre of weights ∫ f ψ_a dA, and what each gets of them: the same sum and centre, and none of another
    /// sign than the sum.
    pub(crate) fn shares(&self, [w, x, y]: &[f64; 3]) -> [(NodeId, f64); 3] {
        let total = w + x + y;
        let at = [x / total, y / total];
        let corners = self.outline.corners();
        let last = corners.len() - 1;
        // The triangle of the fan about the first corner that the centre is in: before the first edge that has it on its right.
        let k = (2..last).find(|&k| turn(&corners[0], &corners[k], &at) < 0.0).unwrap_or(last);
        let (a, b, c) = (&corners[0], &corners[k - 1], &corners[k]);
        let twice = turn(a, b, c);
        // A centre that is outside by rounding stays so by rounding.
        let (second, third) = (turn(a, &at, c) / twice, turn(a, b, &at) / twice);
        let nodes = [self.nodes[0], self.nodes[k - 1], self.nodes[k]];
        let first = 1.0 - second - third;
        [(nodes[0], total * first), (nodes[1], total * second), (nodes[2], total * third)]
    }

    /// Its corners [m], in the room of an array.
    pub(crate) fn place<'a>(&self, position: &[Vec3], room: &'a mut [Vec3; MOST_CORNERS]) -> &'a [Vec3] {
        let room = &mut room[..self.nodes.len()];
        room.iter_mut().zip(&self.nodes).for_each(|(x, n)| *x = position[n.index()]);
        room
    }

    /// Box around it.
    pub(crate) fn bounds(&self, position: &[Vec3]) -> Aabb {
        Aabb::around(self.nodes.iter().map(|n| &position[n.index()]))
    }
}

/// (ψ₁, ψ₂) of a point in the plane of a triangle.
fn psi_of(x: &Vec3, [a, b, c]: &[Vec3; 3]) -> [f64; 2] {
    let (along, across, arm) = (b - a, c - a, x - a);
    let normal = along.cross(&across);
    [arm.cross(&across), along.cross(&arm)].map(|part| normal.dot(&part) / normal.norm_squared())
}

/// Least and largest ψ at the corners.
fn range_of(outline: &Outline) -> PsiRange {
    [0, 1].map(|k| {
        let wider = |[least, most]: [f64; 2], v: f64| [least.min(v), most.max(v)];
        outline.corners().iter().map(|c| c[k]).fold([f64::INFINITY, f64::NEG_INFINITY], wider)
    })
}

/// The convex hull of points, counter-clockwise, without corners that hardly turn.
fn hull_of(mut points: Vec<(NodeId, [f64; 2])>) -> Vec<(NodeId, [f64; 2])> {
    points.sort_by_key(|(n, _)| *n);
    points.dedup_by_key(|(n, _)| *n);
    points.sort_by(|(_, p), (_, q)| p[0].total_cmp(&q[0]));
    // Corners along an edge across the first axis are in the order of rounding: what would be straight is one column.
    let is_one_column = |(_, p): &(NodeId, [f64; 2]), (_, q): &(NodeId, [f64; 2])| q[0] - p[0] <= STRAIGHT;
    for column in points.chunk_by_mut(is_one_column) {
        column.sort_by(|(_, p), (_, q)| p[1].total_cmp(&q[1]));
    }
    hull_of_sorted(&points, |(_, at)| *at, STRAIGHT)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{test_box, test_set};

    fn contactors(cells: [u32; 3]) -> FaceContactors {
        let blocks = test_set(vec![test_box([0.0; 3], [1.0, 2.0, 3.0], cells)]);
        let host = TetFrame::new(&blocks.tet_corners(ndda_mesh::TetId(0), &blocks.rest_position));
        let mut contactors = FaceContactors::default();
        contactors.clear();
        contactors.take(&blocks, BlockId(0), &BlockFaces::new(&blocks, BlockId(0)), &host);
        contactors
    }

    #[test]
    fn a_box_has_six_faces_of_four_corners_whatever_its_mesh() {
        for cells in [[1, 1, 1], [2, 1, 2]] {
            let found = contactors(cells);
            let faces = found.of_block(BlockId(0));
            assert_eq!(faces.len(), 6);
            for face in faces {
                assert_eq!(face.outline.corners().len(), 4);
                assert_eq!(found.of_triangle(face.triangle).map(|f| f.triangle), Some(face.triangle));
            }
        }
    }

    #[test]
    fn what_presses_on_a_face_is_shared_by_corners_around_it() {
        let blocks = test_set(vec![test_box([0.0; 3], [1.0, 2.0, 3.0], [1, 1, 1])]);
        let found = contactors([1, 1, 1]);
        for face in found.of_block(BlockId(0)) {
            let corners = blocks.triangle_corners(face.triangle, &blocks.rest_position);
            let [a, b, c] = blocks.triangles[face.triangle.index()].map(|n| blocks.rest_position[n.index()]);
            assert_eq!([a, b, c], corners);
            // All over the parallelogram, which ends at a corner of ψ₀ = −1, 0 or 1.
            let inside = |x: &Vec3| (0..3).all(|i| x[i] >= -1e-12 && x[i] <= [1.0, 2.0, 3.0][i] + 1e-12);
            for (i, j) in (0..9).flat_map(|i| (0..9).map(move |j| (i, j))) {
                let (x, y) = (f64::from(i) / 4.0 - 1.0, f64::from(j) / 4.0 - 1.0);
                let weights = [1.0 - x - y, x, y].map(|w| 7.0 * w);
                let at = a * (1.0 - x - y) + b * x + c * y;
                if inside(&at) {
                    let shares = face.shares(&weights);
                    assert!(shares.iter().all(|(_, share)| *share >= -1e-12));
                    let center: Vec3 =
                        shares.iter().map(|(n, share)| blocks.rest_position[n.index()] * (share / 7.0)).sum();
                    assert!((center - at).norm() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn faces_much_larger_than_their_triangles_stay_triangles() {
        assert!(contactors([5, 5, 1]).of_block(BlockId(0)).is_empty());
    }
}
