//! Discs of finite size: which blocks they cut, and how much of them that keeps.
//!
//! A block is cut through and through or not at all, so that all blocks stay convex. The plane of a disc cuts a block in a section; of its
//! area A_s the disc covers a part A_c, the area of a circle and a convex polygon in common. A rule on A_c/A_s decides. A joint is
//! therefore larger than its disc where the disc ends inside a block that it cuts, and missing where it ends inside one that it does not.

use std::collections::BTreeSet;

use serde::Serialize;

use super::polyhedron::{Face, Polyhedron};
use super::random::frame;
use crate::Vec3;
use crate::geometry::Aabb;

/// Which blocks a disc cuts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DiscRule {
    /// Blocks of whose section the disc covers at least this part of the area.
    Share(f64),
    /// Blocks of which the disc meets the section (Boon, Houlsby & Utili 2015).
    Meets,
    /// Blocks of which the disc covers the whole section: no cut is longer than the disc.
    Covers,
}

impl Default for DiscRule {
    fn default() -> Self {
        Self::Share(0.5)
    }
}

/// Discs of a cut in numbers; blocks are convex parts at the time a disc comes to them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct DiscReport {
    /// Discs.
    pub discs: usize,
    /// Discs that cut nothing.
    pub idle: usize,
    /// Blocks that were cut by a disc.
    pub cuts: usize,
    /// Of these, blocks in which the disc ends: their joint is larger than the disc.
    pub ends_in_cut: usize,
    /// How often a disc ends in a block and leaves it whole; a block counts once for each such disc.
    pub left_whole: usize,
    /// Area of the discs in the rock [m²].
    pub disc_m2: f64,
    /// Area of the joints that they made [m²].
    pub joint_m2: f64,
}

/// Counts while rock is cut.
#[derive(Clone, Debug, Default)]
pub(super) struct DiscCounts {
    report: DiscReport,
    /// Numbers of the planes of discs that have cut.
    busy: BTreeSet<u32>,
}

/// A disc in its plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DiscShape {
    pub center_m: Vec3,
    pub radius_m: f64,
    pub rule: DiscRule,
}

impl DiscCounts {
    /// Whether a disc cuts in a section, which consists of faces of blocks.
    pub(super) fn decide(&mut self, number: u32, disc: &DiscShape, section: &[(&Polyhedron, &Face)]) -> bool {
        let is_beside =
            |(part, face): &(&Polyhedron, &Face)| distance(part, face, &disc.center_m) >= disc.radius_m;
        if section.iter().all(is_beside) {
            return false;
        }
        let (mut section_m2, mut common_m2, mut covers_all) = (0.0, 0.0, true);
        for (part, face) in section {
            let area_m2 = part.area_vector(face).norm();
            let covers_face = part.ring(face).all(|x| (x - disc.center_m).norm() <= disc.radius_m);
            section_m2 += area_m2;
            common_m2 += if covers_face { area_m2 } else { covered_m2(part, face, disc) };
            covers_all &= covers_face;
        }
        let cuts = match disc.rule {
            DiscRule::Share(share) => common_m2 >= share * section_m2,
            DiscRule::Meets => true,
            DiscRule::Covers => covers_all,
        };
        let report = &mut self.report;
        report.disc_m2 += common_m2;
        if cuts {
            report.cuts += 1;
            report.ends_in_cut += usize::from(!covers_all);
            report.joint_m2 += section_m2;
            self.busy.insert(number);
        } else {
            report.left_whole += 1;
        }
        cuts
    }

    /// The report of so many discs.
    pub(super) fn report(&self, discs: usize) -> DiscReport {
        DiscReport { discs, idle: discs - self.busy.len(), ..self.report }
    }
}

impl DiscShape {
    /// Whether the ball around it comes near a box.
    pub(super) fn touches(&self, bounds: &Aabb) -> bool {
        let outside =
            |i: usize| (bounds.min[i] - self.center_m[i]).max(self.center_m[i] - bounds.max[i]).max(0.0);
        Vec3::from_fn(|i, _| outside(i)).norm() <= self.radius_m
    }
}

/// Area that a convex face and a disc in its plane have in common [m²]: the sum over the edges of what the triangle of edge and centre has
/// in common with the circle.
fn covered_m2(part: &Polyhedron, face: &Face, disc: &DiscShape) -> f64 {
    let normal = part.area_vector(face).normalize();
    let [u, v] = frame(&normal);
    let ring: Vec<[f64; 2]> = part
        .ring(face)
        .map(|x| {
            let from_center = x - disc.center_m;
            [from_center.dot(&u), from_center.dot(&v)]
        })
        .collect();
    let edges = (0..ring.len()).map(|i| [ring[i], ring[(i + 1) % ring.len()]]);
    edges.map(|[a, b]| of_edge(a, b, disc.radius_m)).sum::<f64>().abs()
}

/// Signed area that a circle about the origin has in common with the triangle of the origin, `a` and `b`.
fn of_edge(a: [f64; 2], b: [f64; 2], radius: f64) -> f64 {
    let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let dot = |p: [f64; 2], q: [f64; 2]| p[0] * q[0] + p[1] * q[1];
    let sector = |p: [f64; 2], q: [f64; 2]| 0.5 * radius * radius * cross(p, q).atan2(dot(p, q));
    // Where on a + t (b − a) the circle is: t² d·d + 2 t a·d + a·a − r² = 0.
    let d = [b[0] - a[0], b[1] - a[1]];
    let (square, half, rest) = (dot(d, d), dot(a, d), dot(a, a) - radius * radius);
    let discriminant = half * half - square * rest;
    if square == 0.0 || discriminant <= 0.0 {
        return sector(a, b);
    }
    let root = discriminant.sqrt();
    let [enters, leaves] = [(-half - root) / square, (-half + root) / square];
    if leaves <= 0.0 || enters >= 1.0 {
        return sector(a, b);
    }
    let at = |t: f64| [a[0] + t * d[0], a[1] + t * d[1]];
    let [first, last] = [at(enters.max(0.0)), at(leaves.min(1.0))];
    let before = if enters > 0.0 { sector(a, first) } else { 0.0 };
    let after = if leaves < 1.0 { sector(last, b) } else { 0.0 };
    before + 0.5 * cross(first, last) + after
}

/// Distance of a point of its plane from a convex face; 0 inside.
fn distance(part: &Polyhedron, face: &Face, point: &Vec3) -> f64 {
    let ring: Vec<Vec3> = part.ring(face).collect();
    let normal = part.area_vector(face);
    let mut is_inside = true;
    let mut nearest = f64::INFINITY;
    for (i, a) in ring.iter().enumerate() {
        let edge = ring[(i + 1) % ring.len()] - a;
        let to_point = point - a;
        is_inside &= normal.dot(&edge.cross(&to_point)) >= 0.0;
        let along = (edge.dot(&to_point) / edge.norm_squared()).clamp(0.0, 1.0);
        nearest = nearest.min((to_point - edge * along).norm());
    }
    if is_inside { 0.0 } else { nearest }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::random::Stream;
    use super::*;

    /// The unit square in z = 0, as a face of a box.
    fn area(center: [f64; 2], radius_m: f64) -> f64 {
        let part = Polyhedron::cuboid(Vec3::new(0.0, 0.0, -1.0), Vec3::new(1.0, 1.0, 0.0));
        let top = part.faces.iter().find(|face| part.area_vector(face).z > 0.5).unwrap();
        let center_m = Vec3::new(center[0], center[1], 0.0);
        covered_m2(&part, top, &DiscShape { center_m, radius_m, rule: DiscRule::Meets })
    }

    #[test]
    fn the_area_in_common_is_that_of_closed_forms() {
        let r = 0.3;
        // A whole circle, half of one on an edge, a quarter at a corner, the whole square, and nothing.
        for (center, radius, exact) in [
            ([0.5, 0.5], r, PI * r * r),
            ([0.0, 0.5], r, 0.5 * PI * r * r),
            ([1.0, 1.0], r, 0.25 * PI * r * r),
            ([0.5, 0.5], 0.8, 1.0),
            ([1.5, 1.5], 0.7, 0.0),
        ] {
            assert!((area(center, radius) - exact).abs() < 1e-14, "{center:?}: {}", area(center, radius));
        }
        // A segment of height h: r² acos(1 − h/r) − (r − h) √(2 r h − h²).
        let h: f64 = 0.1;
        let segment = r * r * (1.0 - h / r).acos() - (r - h) * (2.0 * r * h - h * h).sqrt();
        assert!((area([-(r - h), 0.5], r) - segment).abs() < 1e-14);
        // A circle about the middle that leaves the square at its four sides loses four segments.
        let (r, h): (f64, f64) = (0.6, 0.1);
        let segment = r * r * (1.0 - h / r).acos() - (r - h) * (2.0 * r * h - h * h).sqrt();
        assert!((area([0.5, 0.5], r) - (PI * r * r - 4.0 * segment)).abs() < 1e-14);
    }

    #[test]
    fn the_area_in_common_is_that_of_strips() {
        let mut stream = Stream::new(3, &[]);
        for _ in 0..100 {
            let center = [stream.between(-0.5, 1.5), stream.between(-0.5, 1.5)];
            let radius = stream.between(0.05, 1.2);
            let strips = 20_000;
            let length = |i: i32| {
                let x = (f64::from(i) + 0.5) / f64::from(strips);
                let half = (radius * radius - (x - center[0]).powi(2)).max(0.0).sqrt();
                ((center[1] + half).min(1.0) - (center[1] - half).max(0.0)).max(0.0)
            };
            let sum: f64 = (0..strips).map(|i| length(i) / f64::from(strips)).sum();
            assert!((area(center, radius) - sum).abs() < 2e-5, "{center:?} {radius}");
        }
    }
}
