//! What rock between neighbouring points of a bolt does to it, and it to the rock.
//!
//! Within a block, and along a free length, the bolt is the straight line between two points p₁, p₂: it stretches by the change of |p₂ − p₁|. Where it
//! crosses from one block to the next, both points may be one, and the direction of the bolt is that of its pieces in both blocks,
//! a ∝ (p₁ − p₀) + (p₃ − p₂): it stretches by r·a, r = p₂ − p₁, and the dowel is sheared by the rest of r. The frame (a, n, b) in which the
//! slip of the dowel is remembered turns with an edge m of the rock. Forces are the slopes of an energy that only depends on how these
//! points lie to each other: they keep momentum and angular momentum, whatever their size.

use ndda_mesh::Vec3;

use crate::bolts::embedding::Anchor;

/// Transverse resistance of a bolt where it crosses a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dowel {
    /// Shear force per offset [N/m].
    pub stiffness_n_m: f64,
    /// Largest shear force [N].
    pub capacity_n: f64,
}

/// Where a bolt crosses from one block to the next: its ends there and in the two blocks.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Crossing {
    /// p₀, p₁, p₂, p₃ and the two ends of m.
    pub points: [Anchor; 6],
}

/// The frame of a crossing.
pub(crate) struct Frame {
    r: Vec3,
    c_length: f64,
    m: Vec3,
    p_length: f64,
    axis: Vec3,
    n: Vec3,
    b: Vec3,
}

impl Frame {
    /// From where the points of a crossing are.
    pub(crate) fn new([p0, p1, p2, p3, m0, m1]: &[Vec3; 6]) -> Self {
        let (r, c, m) = (p2 - p1, (p1 - p0) + (p3 - p2), m1 - m0);
        let (c_length, axis) = (c.norm(), c / c.norm());
        let p = m - m.dot(&axis) * axis;
        let (p_length, n) = (p.norm(), p / p.norm());
        Self { r, c_length, m, p_length, axis, n, b: axis.cross(&n) }
    }

    /// How far the bolt is apart along itself [m].
    pub(crate) fn along_m(&self) -> f64 {
        self.r.dot(&self.axis)
    }

    /// How far it is sheared, in the frame [m].
    pub(crate) fn across_m(&self) -> [f64; 2] {
        [self.r.dot(&self.n), self.r.dot(&self.b)]
    }

    /// Forces on p₀ … m₁ of a tension and of shear forces on the offset in the frame [N].
    pub(crate) fn forces(&self, tension_n: f64, shear_n: [f64; 2]) -> [Vec3; 6] {
        let Self { r, c_length, m, p_length, axis, n, b } = self;
        // Slopes of the energy by a, n, b and r, carried back through their definitions.
        let on_r = tension_n * axis + shear_n[0] * n + shear_n[1] * b;
        let (mut on_axis, mut on_n, on_b) = (tension_n * r, shear_n[0] * r, shear_n[1] * r);
        on_axis += n.cross(&on_b);
        on_n += on_b.cross(axis);
        let on_p = (on_n - on_n.dot(n) * n) / *p_length;
        let on_m = on_p - on_p.dot(axis) * axis;
        on_axis -= m.dot(axis) * on_p + on_p.dot(axis) * m;
        let on_c = (on_axis - on_axis.dot(axis) * axis) / *c_length;
        [on_c, on_r - on_c, on_c - on_r, -on_c, on_m, -on_m]
    }
}

impl Dowel {
    /// Shear forces at an offset, by how much it yields, and the work that this takes [N, m, J].
    pub(crate) fn respond(&self, across_m: [f64; 2], slip_m: [f64; 2]) -> ([f64; 2], [f64; 2], f64) {
        let elastic = [0, 1].map(|i| across_m[i] - slip_m[i]);
        let size_m = elastic[0].hypot(elastic[1]);
        let most_m = self.capacity_n / self.stiffness_n_m;
        if size_m <= most_m {
            return (elastic.map(|x| self.stiffness_n_m * x), [0.0; 2], 0.0);
        }
        let force_n = elastic.map(|x| self.capacity_n * x / size_m);
        let beyond = elastic.map(|x| x * (1.0 - most_m / size_m));
        (force_n, beyond, self.capacity_n * (size_m - most_m))
    }

    /// Stored energy and the work of yielding there [J].
    pub(crate) fn potential_j(&self, across_m: [f64; 2], slip_m: [f64; 2]) -> f64 {
        let (force_n, _, work_j) = self.respond(across_m, slip_m);
        0.5 * (force_n[0] * force_n[0] + force_n[1] * force_n[1]) / self.stiffness_n_m + work_j
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points() -> [Vec3; 6] {
        [
            Vec3::new(0.1, 0.0, -0.2),
            Vec3::new(1.0, 0.1, -0.1),
            Vec3::new(1.05, 0.13, -0.16),
            Vec3::new(1.7, 0.2, 0.3),
            Vec3::new(0.0, 0.5, 0.2),
            Vec3::new(0.3, 1.4, 0.1),
        ]
    }

    /// E = T r·a + ½ k |(r·n, r·b) − s|².
    fn energy_j(points: &[Vec3; 6]) -> f64 {
        let frame = Frame::new(points);
        let [x, y] = frame.across_m();
        7.0 * frame.along_m() + 0.5 * 50.0 * ((x - 0.02).powi(2) + (y + 0.03).powi(2))
    }

    fn forces() -> [Vec3; 6] {
        let frame = Frame::new(&points());
        let [x, y] = frame.across_m();
        frame.forces(7.0, [50.0 * (x - 0.02), 50.0 * (y + 0.03)])
    }

    #[test]
    fn forces_are_minus_the_slopes_of_the_energy() {
        for (k, force) in forces().iter().enumerate() {
            for axis in 0..3 {
                let at = |change: f64| {
                    let mut moved = points();
                    moved[k][axis] += change;
                    energy_j(&moved)
                };
                let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
                assert!((slope + force[axis]).abs() < 1e-7, "point {k}: {slope} {}", force[axis]);
            }
        }
    }

    #[test]
    fn forces_have_neither_sum_nor_moment() {
        let (forces, points) = (forces(), points());
        assert!(forces.iter().sum::<Vec3>().norm() < 1e-13);
        assert!(forces.iter().zip(&points).map(|(f, x)| x.cross(f)).sum::<Vec3>().norm() < 1e-13);
    }

    #[test]
    fn a_dowel_yields_at_its_capacity_in_any_direction() {
        let dowel = Dowel { stiffness_n_m: 100.0, capacity_n: 5.0 };
        let (force_n, slip_m, work_j) = dowel.respond([0.3, 0.4], [0.0, 0.0]);
        assert!((force_n[0] - 3.0).abs() < 1e-14 && (force_n[1] - 4.0).abs() < 1e-14);
        assert!((slip_m[0] - 0.27).abs() < 1e-15 && (work_j - 5.0 * 0.45).abs() < 1e-14);
        let (again_n, more_m, _) = dowel.respond([0.3, 0.4], slip_m);
        assert!((again_n[0] - 3.0).abs() < 1e-13 && more_m[0].abs() < 1e-15);
    }
}
