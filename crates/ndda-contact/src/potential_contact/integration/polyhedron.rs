//! The overlap of two tetrahedra as a polyhedron, and integrals over it.
//!
//! A convex polyhedron is a graph: each corner has three neighbours in turning order. A plane classifies each corner
//! once, by the sign of its field there, and the graph is mended along the cut; so the surface is closed whatever
//! rounding does (Powell & Abel 2015, r3d). A corner put on the wrong side by rounding moves the volume by rounding.

use crate::integration::linear::Linear;
use ndda_mesh::Vec3;
use ndda_mesh::geometry::Aabb;

use crate::integration::tet_frame::TetFrame;

/// Three faces meet in each corner, so F faces have 2 F − 4 corners: 18 for two tetrahedra and three rivals of a
/// potential, 148 for two blocks of [`MOST_CUTS`](crate::integration::capacity::MOST_CUTS) faces in a box, and their rivals.
pub(super) const MOST_CORNERS: usize = 152;

/// A convex polyhedron that moves along with a tetrahedron: its corners by their λ, and its graph.
#[derive(Clone, Debug, Default)]
pub(crate) struct EmbeddedPolyhedron {
    lambda: Vec<[f64; 4]>,
    neighbours: Vec<[u8; 3]>,
}

impl EmbeddedPolyhedron {
    /// A convex body in a box, given by functions that are not negative in it, at rest where the tetrahedron is.
    pub(crate) fn new(bounds: &Aabb, sides: impl Iterator<Item = Linear>, tet: &TetFrame) -> Self {
        let mut body = Polyhedron::default();
        // Sides that lie in those of the box would cut by rounding.
        body.set_cuboid(&bounds.inflated(0.125 * bounds.diagonal()));
        sides.for_each(|side| body.cut(&side));
        let lambda = body.position[..body.len].iter().map(|x| tet.lambda_at(x)).collect();
        Self { lambda, neighbours: body.neighbours[..body.len].to_vec() }
    }
}

/// A convex polyhedron; lives on the stack, and is large: room for one is used again and again.
#[derive(Clone, Debug)]
pub struct Polyhedron {
    pub(super) position: [Vec3; MOST_CORNERS],
    pub(super) neighbours: [[u8; 3]; MOST_CORNERS],
    pub(super) len: usize,
    /// Whether a cut would have needed more corners than there is room for; integrals are then not numbers.
    pub(super) outgrown: bool,
    /// Room for what a cut finds at the corners.
    sides: [f64; MOST_CORNERS],
    new_place: [u8; MOST_CORNERS],
}

impl Default for Polyhedron {
    /// Nothing.
    fn default() -> Self {
        let (position, neighbours) = ([Vec3::zeros(); MOST_CORNERS], [[0; 3]; MOST_CORNERS]);
        let (sides, new_place) = ([0.0; MOST_CORNERS], [0; MOST_CORNERS]);
        Self { position, neighbours, len: 0, outgrown: false, sides, new_place }
    }
}

impl Polyhedron {
    /// A tetrahedron with these corners [m], of positive volume.
    pub(crate) fn tet(corners: &[Vec3; 4]) -> Self {
        let mut all = Self::default();
        all.set_tet(corners);
        all
    }

    /// Becomes a tetrahedron with these corners [m], of positive volume.
    pub(crate) fn set_tet(&mut self, corners: &[Vec3; 4]) {
        (self.len, self.outgrown) = (4, false);
        self.position[..4].copy_from_slice(corners);
        self.neighbours[..4].copy_from_slice(&[[1, 3, 2], [2, 3, 0], [0, 3, 1], [1, 2, 0]]);
    }

    /// Becomes what another is.
    pub(super) fn set(&mut self, other: &Self) {
        (self.len, self.outgrown) = (other.len, other.outgrown);
        self.position[..self.len].copy_from_slice(&other.position[..other.len]);
        self.neighbours[..self.len].copy_from_slice(&other.neighbours[..other.len]);
    }

    /// Becomes a body that moves along with a tetrahedron, which has these corners [m] now.
    pub(crate) fn set_embedded(&mut self, body: &EmbeddedPolyhedron, [a, b, c, d]: &[Vec3; 4]) {
        (self.len, self.outgrown) = (body.lambda.len(), false);
        for (x, l) in self.position.iter_mut().zip(&body.lambda) {
            *x = a * l[0] + b * l[1] + c * l[2] + d * l[3];
        }
        self.neighbours[..self.len].copy_from_slice(&body.neighbours);
    }

    /// Becomes a box along the axes.
    pub(crate) fn set_cuboid(&mut self, bounds: &Aabb) {
        (self.len, self.outgrown) = (8, false);
        for corner in 0..8 {
            let upper = |axis: usize| corner >> axis & 1 == 1;
            let at = |axis: usize| if upper(axis) { bounds.max[axis] } else { bounds.min[axis] };
            self.position[corner] = Vec3::from_fn(|axis, _| at(axis));
            let along = [0, 1, 2].map(|axis| (corner ^ 1 << axis) as u8);
            // Seen from inside out, neighbours turn the other way round where an odd number of axes is turned.
            let [x, y, z] = along;
            self.neighbours[corner] = if corner.count_ones() % 2 == 0 { [x, z, y] } else { along };
        }
    }

    /// Whether nothing is left.
    pub(crate) fn is_empty(&self) -> bool {
        self.len == 0 && !self.outgrown
    }

    /// The box around its corners.
    pub(crate) fn bounds(&self) -> Aabb {
        Aabb::around(&self.position[..self.len])
    }

    /// Keeps the part where the function is not negative.
    pub(crate) fn cut(&mut self, side: &Linear) {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for (value, x) in self.sides.iter_mut().zip(&self.position[..self.len]) {
            *value = side.at(x);
            (least, most) = (least.min(*value), most.max(*value));
        }
        // A polyhedron that only touches the plane has no volume in front of it.
        if most <= 0.0 {
            self.len = 0;
        } else if least < 0.0 {
            let old = self.len;
            self.add_crossings();
            if self.outgrown {
                self.len = 0;
                return;
            }
            self.close_cut(old);
            self.drop_behind(old);
        }
    }

    /// The least and the largest value of a function; at corners, for it is linear.
    pub(super) fn range_of(&self, function: &Linear) -> (f64, f64) {
        let wider = |(least, most): (f64, f64), value: f64| (least.min(value), most.max(value));
        let values = self.position[..self.len].iter().map(|x| function.at(x));
        values.fold((f64::INFINITY, f64::NEG_INFINITY), wider)
    }

    /// A new corner on each edge that crosses the plane, between its kept end and nothing yet.
    fn add_crossings(&mut self) {
        let old = self.len;
        for i in 0..old {
            let is_kept = self.sides[i] >= 0.0;
            if !is_kept {
                continue;
            }
            for k in 0..3 {
                let j = self.neighbours[i][k] as usize;
                if j >= old || self.sides[j] >= 0.0 {
                    continue;
                }
                if self.len == MOST_CORNERS {
                    self.outgrown = true;
                    return;
                }
                let t = self.sides[i] / (self.sides[i] - self.sides[j]);
                self.position[self.len] = self.position[i] + t * (self.position[j] - self.position[i]);
                self.neighbours[self.len] = [i as u8, 0, 0];
                self.neighbours[i][k] = self.len as u8;
                self.len += 1;
            }
        }
    }

    /// Joins the new corners to a rim: from each, along the face on its side, to the next new corner.
    fn close_cut(&mut self, old: usize) {
        for start in old..self.len {
            let (mut here, mut next) = (start, self.neighbours[start][0] as usize);
            loop {
                let turned = self.turn(next, here);
                (here, next) = (next, turned);
                if here >= old {
                    break;
                }
            }
            self.neighbours[start][2] = here as u8;
            self.neighbours[here][1] = start as u8;
        }
    }

    /// The neighbour of `at` that follows the one it was reached from, around the face.
    pub(super) fn turn(&self, at: usize, from: usize) -> usize {
        let around = &self.neighbours[at];
        let k = around.iter().position(|&n| n as usize == from).expect("neighbours know each other");
        around[(k + 1) % 3] as usize
    }

    fn drop_behind(&mut self, old: usize) {
        let mut kept = 0;
        for i in 0..self.len {
            if i >= old || self.sides[i] >= 0.0 {
                self.new_place[i] = kept as u8;
                self.position[kept] = self.position[i];
                self.neighbours[kept] = self.neighbours[i];
                kept += 1;
            }
        }
        self.len = kept;
        let new_place = &self.new_place;
        for around in &mut self.neighbours[..kept] {
            *around = around.map(|n| new_place[n as usize]);
        }
    }
}

/// c ∩ t, in coordinates with the origin at `origin`, a point nearby.
pub fn overlap_of(c: &[Vec3; 4], t: &TetFrame, origin: &Vec3) -> Polyhedron {
    let mut overlap = Polyhedron::tet(&c.map(|x| x - origin));
    for face in faces_of(t, origin) {
        overlap.cut(&face);
        if overlap.is_empty() {
            break;
        }
    }
    overlap
}

/// λ₀ … λ₃ as functions of place.
pub(crate) fn faces_of(t: &TetFrame, origin: &Vec3) -> [Linear; 4] {
    [0, 1, 2, 3].map(|b| {
        let mut values = [0.0; 4];
        values[b] = 1.0;
        Linear::of_corners(t, &values, origin)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element_pairs;

    fn unit(shift: [f64; 3], scale: f64) -> [Vec3; 4] {
        let corners = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
        corners.map(|x| scale * x + Vec3::from(shift))
    }

    #[test]
    fn a_tetrahedron_has_its_volume_and_centroid() {
        let (volume, moment) = Polyhedron::tet(&unit([1.0, 2.0, 3.0], 1.0)).volume_and_moment();
        assert!((volume - 1.0 / 6.0).abs() < 1e-15, "{volume}");
        assert!((moment / volume - Vec3::new(1.25, 2.25, 3.25)).norm() < 1e-13);
    }

    #[test]
    fn a_box_has_its_volume_and_centroid_whole_and_cut() {
        let mut cuboid = Polyhedron::default();
        cuboid.set_cuboid(&Aabb { min: Vec3::new(1.0, 2.0, 3.0), max: Vec3::new(2.0, 4.0, 6.0) });
        let (volume, moment) = cuboid.volume_and_moment();
        assert!((volume - 6.0).abs() < 1e-14, "{volume}");
        assert!((moment / volume - Vec3::new(1.5, 3.0, 4.5)).norm() < 1e-14);
        // A corner is left: x + y + z ≤ 7.
        cuboid.cut(&Linear { value: 7.0, gradient: Vec3::repeat(-1.0) });
        assert!((cuboid.volume_and_moment().0 - 1.0 / 6.0).abs() < 1e-14);
    }

    #[test]
    fn a_tetrahedron_overlaps_itself_wholly_and_its_neighbour_not_at_all() {
        let c = unit([0.0; 3], 1.0);
        let same = overlap_of(&c, &TetFrame::new(&c), &c[0]);
        assert!((same.volume_and_moment().0 - 1.0 / 6.0).abs() < 1e-15);
        let mirrored = [c[0], c[2], c[1], -c[3]];
        assert_eq!(overlap_of(&c, &TetFrame::new(&mirrored), &c[0]).volume_and_moment().0, 0.0);
    }

    #[test]
    fn a_polyhedron_that_outgrows_its_room_has_no_volume_rather_than_a_wrong_one() {
        let mut ball = Polyhedron::tet(&unit([0.0; 3], 1.0));
        let middle = Vec3::repeat(0.25);
        for k in 0..200 {
            let (turn, height) = (2.4 * f64::from(k), (f64::from(k) + 0.5) / 100.0 - 1.0);
            let round = (1.0 - height * height).sqrt();
            let gradient = -Vec3::new(round * turn.cos(), round * turn.sin(), height);
            ball.cut(&Linear { value: 0.01 - gradient.dot(&middle), gradient });
        }
        assert!(!ball.is_empty() && ball.volume_and_moment().0.is_nan());
    }

    #[test]
    fn volumes_and_potentials_are_those_of_the_slow_twin() {
        for k in 0..60 {
            let at = |i: f64| (f64::from(k) * i).sin() * 0.4;
            let (c, t) = (unit([0.0; 3], 1.0), unit([at(1.3), at(2.1), at(0.7)], 0.9 + at(3.0)));
            let frame = TetFrame::new(&t);
            let overlap = overlap_of(&c, &frame, &c[0]);
            let expected = element_pairs::overlap_volume_m3(&c, &t);
            assert!((overlap.volume_and_moment().0 - expected).abs() < 1e-14);
        }
    }
}
