//! The overlap of two tetrahedra as a polyhedron, and integrals over it.
//!
//! A convex polyhedron is a graph: each corner has three neighbours in turning order. A plane classifies each corner
//! once, by the sign of its field there, and the graph is mended along the cut; so the surface is closed whatever
//! rounding does (Powell & Abel 2015, r3d). A corner put on the wrong side by rounding moves the volume by rounding.

use ndda_mesh::Vec3;

use crate::pair::TetFrame;

/// A tetrahedron has 4 corners; a cut of a convex polyhedron with n corners leaves at most 2 n − 4 … far more than
/// four faces and a potential's rivals ever make of it.
const MOST_CORNERS: usize = 96;

/// A linear function of place, value + gradient · x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    /// Value at the origin.
    pub value: f64,
    /// Gradient [1/m].
    pub gradient: Vec3,
}

impl Linear {
    /// The function with these values at the corners of a tetrahedron, seen from `origin`.
    pub fn of_corners(frame: &TetFrame, values: &[f64; 4], origin: &Vec3) -> Self {
        let gradient: Vec3 = (0..4).map(|b| values[b] * frame.gradients()[b]).sum();
        // λ₀ is 1 at the frame's own corner, the others 0.
        Self { value: values[0] + gradient.dot(&(origin - frame.origin())), gradient }
    }

    /// Its value at x.
    pub fn at(&self, x: &Vec3) -> f64 {
        self.value + self.gradient.dot(x)
    }

    /// The difference of two functions.
    pub fn minus(&self, other: &Self) -> Self {
        Self { value: self.value - other.value, gradient: self.gradient - other.gradient }
    }
}

/// A convex polyhedron; lives on the stack.
#[derive(Clone, Debug)]
pub struct Polyhedron {
    position: [Vec3; MOST_CORNERS],
    neighbours: [[u8; 3]; MOST_CORNERS],
    len: usize,
}

impl Polyhedron {
    /// A tetrahedron with these corners [m], of positive volume.
    pub fn tet(corners: &[Vec3; 4]) -> Self {
        let mut all =
            Self { position: [Vec3::zeros(); MOST_CORNERS], neighbours: [[0; 3]; MOST_CORNERS], len: 4 };
        all.position[..4].copy_from_slice(corners);
        all.neighbours[..4].copy_from_slice(&[[1, 3, 2], [2, 3, 0], [0, 3, 1], [1, 2, 0]]);
        all
    }

    /// Whether nothing is left.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Keeps the part where the function is not negative.
    pub fn cut(&mut self, side: &Linear) {
        let mut sides = [0.0; MOST_CORNERS];
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for (value, x) in sides.iter_mut().zip(&self.position[..self.len]) {
            *value = side.at(x);
            (least, most) = (least.min(*value), most.max(*value));
        }
        // A polyhedron that only touches the plane has no volume in front of it.
        if most <= 0.0 {
            self.len = 0;
        } else if least < 0.0 {
            let old = self.len;
            self.add_crossings(&sides);
            self.close_cut(old);
            self.drop_behind(&sides, old);
        }
    }

    /// A new corner on each edge that crosses the plane, between its kept end and nothing yet.
    fn add_crossings(&mut self, sides: &[f64; MOST_CORNERS]) {
        let old = self.len;
        for i in (0..old).filter(|&i| sides[i] >= 0.0) {
            for k in 0..3 {
                let j = self.neighbours[i][k] as usize;
                if j >= old || sides[j] >= 0.0 {
                    continue;
                }
                assert!(self.len < MOST_CORNERS, "a polyhedron outgrew its {MOST_CORNERS} corners");
                let t = sides[i] / (sides[i] - sides[j]);
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
    fn turn(&self, at: usize, from: usize) -> usize {
        let around = &self.neighbours[at];
        let k = around.iter().position(|&n| n as usize == from).expect("neighbours know each other");
        around[(k + 1) % 3] as usize
    }

    fn drop_behind(&mut self, sides: &[f64; MOST_CORNERS], old: usize) {
        let mut new_place = [0u8; MOST_CORNERS];
        let mut kept = 0;
        for i in 0..self.len {
            if i >= old || sides[i] >= 0.0 {
                new_place[i] = kept as u8;
                self.position[kept] = self.position[i];
                self.neighbours[kept] = self.neighbours[i];
                kept += 1;
            }
        }
        self.len = kept;
        for around in &mut self.neighbours[..kept] {
            *around = around.map(|n| new_place[n as usize]);
        }
    }

    /// Volume [m³] and ∫ x dV [m⁴], from a fan of triangles over each face and a corner of the polyhedron.
    pub fn volume_and_moment(&self) -> (f64, Vec3) {
        if self.len == 0 {
            return (0.0, Vec3::zeros());
        }
        let base = self.position[0];
        let (mut six_volumes, mut moment) = (0.0, Vec3::zeros());
        self.for_each_triangle(|corners| {
            let [a, b, c] = corners.map(|x| x - base);
            let six = a.dot(&b.cross(&c));
            six_volumes += six;
            moment += six * (a + b + c);
        });
        let volume = six_volumes / 6.0;
        (volume, moment / 24.0 + volume * base)
    }

    fn for_each_triangle(&self, mut triangle: impl FnMut([Vec3; 3])) {
        let mut seen = [[false; 3]; MOST_CORNERS];
        for start in 0..self.len {
            for first in 0..3 {
                if seen[start][first] {
                    continue;
                }
                seen[start][first] = true;
                let (mut here, mut next) = (start, self.neighbours[start][first] as usize);
                loop {
                    let turned = self.turn(next, here);
                    let k = self.neighbours[next].iter().position(|&n| n as usize == turned).unwrap_or(0);
                    (here, next) = (next, turned);
                    seen[here][k] = true;
                    if next == start {
                        break;
                    }
                    triangle([self.position[start], self.position[next], self.position[here]]);
                }
            }
        }
    }

    /// ∫ f dV [m³ of f's unit].
    pub fn integral(&self, f: &Linear) -> f64 {
        let (volume, moment) = self.volume_and_moment();
        f.value * volume + f.gradient.dot(&moment)
    }

    /// ∫ min f dV over linear functions: each over the part where it is the smallest.
    pub fn integral_of_smallest(&self, functions: &[Linear]) -> f64 {
        if let [only] = functions {
            return self.integral(only);
        }
        let part = |i: usize| {
            let mut region = self.clone();
            for (j, rival) in functions.iter().enumerate() {
                if j != i && !region.is_empty() {
                    region.cut(&rival.minus(&functions[i]));
                }
            }
            region.integral(&functions[i])
        };
        (0..functions.len()).map(part).sum()
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
pub fn faces_of(t: &TetFrame, origin: &Vec3) -> [Linear; 4] {
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
    fn a_tetrahedron_overlaps_itself_wholly_and_its_neighbour_not_at_all() {
        let c = unit([0.0; 3], 1.0);
        let same = overlap_of(&c, &TetFrame::new(&c), &c[0]);
        assert!((same.volume_and_moment().0 - 1.0 / 6.0).abs() < 1e-15);
        let mirrored = [c[0], c[2], c[1], -c[3]];
        assert_eq!(overlap_of(&c, &TetFrame::new(&mirrored), &c[0]).volume_and_moment().0, 0.0);
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
