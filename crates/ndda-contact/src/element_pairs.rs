//! The slow twin: contact as the paper prints it, over all pairs of elements. It is the specification of the fast
//! kernel, and shares no code with it.
//!
//! Eq (16): f_n = k_n ∮ n_S (φ_c − φ_t) dS over the surface of c ∩ t, n_S outward. That surface consists of parts of
//! c's faces, where φ_c = 0, and of parts of t's faces, where φ_t = 0. φ(P) = 4 min λᵢ(P).
//! Energy: W = k_n ∫ (φ_c + φ_t) dV over c ∩ t, by cutting the polyhedron.

use ndda_mesh::geometry::{TET_FACES, tet_volume};
use ndda_mesh::{BlockSet, NodeId, TetId, Vec3};

/// Two barycentric coordinates that differ by less than this over a whole face are equal there.
const IN_PLANE: f64 = 1e-12;

/// Nodal forces ∫ N dF of all pairs of elements of different blocks [N].
pub fn forces(blocks: &BlockSet, position: &[Vec3], penalty_pa: f64) -> Vec<Vec3> {
    let mut force = vec![Vec3::zeros(); position.len()];
    for_each_pair(blocks, |c, t| {
        let (c_nodes, t_nodes) = (&blocks.tets[c.index()], &blocks.tets[t.index()]);
        let origin = position[c_nodes[0].index()];
        let contactor = Tet::new(c_nodes.map(|n| position[n.index()] - origin));
        let target = Tet::new(t_nodes.map(|n| position[n.index()] - origin));
        // On c's faces: n (0 − φ_t).  On t's faces: n (φ_c − 0), n being t's outward normal.
        add_face_forces(&contactor, c_nodes, &target, t_nodes, -penalty_pa, &mut force);
        add_face_forces(&target, t_nodes, &contactor, c_nodes, -penalty_pa, &mut force);
    });
    force
}

/// W = k_n Σ ∫ (φ_c + φ_t) dV [J].
pub fn energy_j(blocks: &BlockSet, position: &[Vec3], penalty_pa: f64) -> f64 {
    let mut energy = 0.0;
    for_each_pair(blocks, |c, t| {
        let corners = |tet: TetId| blocks.tet_corners(tet, position);
        let origin = corners(c)[0];
        let contactor = Tet::new(corners(c).map(|x| x - origin));
        let target = Tet::new(corners(t).map(|x| x - origin));
        let overlap = contactor.cut(Polyhedron::of(&target));
        energy +=
            penalty_pa * (contactor.integral_of_potential(&overlap) + target.integral_of_potential(&overlap));
    });
    energy
}

/// Volume of c ∩ t [m³].
pub fn overlap_volume_m3(c: &[Vec3; 4], t: &[Vec3; 4]) -> f64 {
    let contactor = Tet::new(c.map(|x| x - c[0]));
    let target = Tet::new(t.map(|x| x - c[0]));
    contactor.cut(Polyhedron::of(&target)).volume_and_centroid().0
}

fn for_each_pair(blocks: &BlockSet, mut pair: impl FnMut(TetId, TetId)) {
    for c in 0..blocks.tets.len() {
        for t in c + 1..blocks.tets.len() {
            if blocks.tet_block[c] != blocks.tet_block[t] {
                pair(TetId(c as u32), TetId(t as u32));
            }
        }
    }
}

/// Over the part of each face of `owner` inside `other`: `scale` φ_other n on the owner, the opposite on the other.
fn add_face_forces(
    owner: &Tet,
    owner_nodes: &[NodeId; 4],
    other: &Tet,
    other_nodes: &[NodeId; 4],
    scale: f64,
    force: &mut [Vec3],
) {
    for face in TET_FACES {
        let corners = face.map(|i| owner.corners[i]);
        let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize();
        for smallest in 0..4 {
            let part = other.region(&corners, other.clip(corners.to_vec()), smallest);
            let traction = |x: &Vec3| scale * 4.0 * other.lambda(smallest, x) * normal;
            for a in 0..4 {
                let on_owner = integrate(&part, |x| traction(x) * owner.lambda(a, x));
                let on_other = integrate(&part, |x| traction(x) * other.lambda(a, x));
                force[owner_nodes[a].index()] += on_owner;
                force[other_nodes[a].index()] -= on_other;
            }
        }
    }
}

/// ∫ f dA over a convex polygon for f of degree two: mid-edge rule on a fan.
fn integrate(polygon: &[Vec3], f: impl Fn(&Vec3) -> Vec3) -> Vec3 {
    let fan = (1..polygon.len().max(2) - 1).map(|i| [polygon[0], polygon[i], polygon[i + 1]]);
    let triangle = |[a, b, c]: [Vec3; 3]| {
        let area = 0.5 * (b - a).cross(&(c - a)).norm();
        let middles = [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0];
        middles.iter().map(&f).sum::<Vec3>() * (area / 3.0)
    };
    fan.map(triangle).sum()
}

/// A tetrahedron with its barycentric functions λ_i(x) = g_i · (x − corner) + δ.
struct Tet {
    corners: [Vec3; 4],
    gradients: [Vec3; 4],
}

impl Tet {
    fn new(corners: [Vec3; 4]) -> Self {
        let six_volumes = 6.0 * tet_volume(&corners);
        let gradients = TET_FACES.map(|face| {
            let [a, b, c] = face.map(|i| corners[i]);
            // The outward area vector of the face opposite to a corner is −3 V ∇λ.
            -(b - a).cross(&(c - a)) / six_volumes
        });
        Self { corners, gradients }
    }

    /// λ_i at x; zero on the face opposite to corner i.
    fn lambda(&self, i: usize, x: &Vec3) -> f64 {
        self.gradients[i].dot(&(x - self.corners[TET_FACES[i][0]]))
    }

    /// The part of a polygon inside.
    fn clip(&self, polygon: Vec<Vec3>) -> Vec<Vec3> {
        (0..4).fold(polygon, |p, i| clip_polygon(&p, |x| self.lambda(i, x)))
    }

    /// The part of a polygon of the plane of `face` where λ_i is the smallest. A face that lies in the plane
    /// λ_i = λ_j is given to the smaller index: clipped by either it could be counted twice, or not at all.
    fn region(&self, face: &[Vec3; 3], polygon: Vec<Vec3>, i: usize) -> Vec<Vec3> {
        let mut part = polygon;
        for j in (0..4).filter(|&j| j != i) {
            let ahead = |x: &Vec3| self.lambda(j, x) - self.lambda(i, x);
            let in_plane = face.iter().all(|x| ahead(x).abs() <= IN_PLANE);
            if in_plane && j < i {
                return Vec::new();
            }
            if !in_plane {
                part = clip_polygon(&part, ahead);
            }
        }
        part
    }

    /// The part of a polyhedron inside.
    fn cut(&self, polyhedron: Polyhedron) -> Polyhedron {
        (0..4).fold(polyhedron, |p, i| p.clipped(|x| self.lambda(i, x)))
    }

    /// ∫ φ dV over a polyhedron: φ is linear in each of the four regions, so its value at the centroid counts.
    fn integral_of_potential(&self, polyhedron: &Polyhedron) -> f64 {
        let region = |i: usize| {
            let rivals = (0..4).filter(|&j| j != i);
            let part =
                rivals.fold(polyhedron.clone(), |p, j| p.clipped(|x| self.lambda(j, x) - self.lambda(i, x)));
            let (volume, centroid) = part.volume_and_centroid();
            volume * 4.0 * self.lambda(i, &centroid)
        };
        (0..4).map(region).sum()
    }
}

/// The part of a polygon where `side` ≥ 0.
fn clip_polygon(polygon: &[Vec3], side: impl Fn(&Vec3) -> f64) -> Vec<Vec3> {
    let sides: Vec<f64> = polygon.iter().map(&side).collect();
    let mut kept = Vec::new();
    for i in 0..polygon.len() {
        let j = (i + 1) % polygon.len();
        if sides[i] >= 0.0 {
            kept.push(polygon[i]);
        }
        if (sides[i] < 0.0) != (sides[j] < 0.0) {
            kept.push(polygon[i] + (polygon[j] - polygon[i]) * (sides[i] / (sides[i] - sides[j])));
        }
    }
    if kept.len() < 3 { Vec::new() } else { kept }
}

/// The points of a polygon's rim where `side` is zero.
fn crossings(polygon: &[Vec3], side: impl Fn(&Vec3) -> f64) -> Vec<Vec3> {
    let edges = (0..polygon.len()).map(|i| (polygon[i], polygon[(i + 1) % polygon.len()]));
    let crossing = |(a, b): (Vec3, Vec3)| {
        let (from, to) = (side(&a), side(&b));
        match (from == 0.0, from * to < 0.0) {
            (true, _) => Some(a),
            (_, true) => Some(a + (b - a) * (from / (from - to))),
            _ => None,
        }
    };
    edges.filter_map(crossing).collect()
}

/// A convex polyhedron by its faces.
#[derive(Clone)]
struct Polyhedron {
    faces: Vec<Vec<Vec3>>,
}

impl Polyhedron {
    fn of(tet: &Tet) -> Self {
        Self { faces: TET_FACES.map(|face| face.map(|i| tet.corners[i]).to_vec()).to_vec() }
    }

    /// The part where `side` ≥ 0: faces cut, and the cut closed by a new face. Corners within [`IN_PLANE`] are on
    /// the plane: whether a face that lies in it is kept or replaced must not hang on the last bit.
    fn clipped(&self, side: impl Fn(&Vec3) -> f64) -> Self {
        let side = |x: &Vec3| Some(side(x)).filter(|s| s.abs() > IN_PLANE).unwrap_or(0.0);
        let corners = || self.faces.iter().flatten();
        if !corners().any(|x| side(x) > 0.0) {
            return Self { faces: Vec::new() };
        }
        if !corners().any(|x| side(x) < 0.0) {
            return self.clone();
        }
        let faces: Vec<_> = self.faces.iter().map(|face| clip_polygon(face, side)).collect();
        let kept = faces.into_iter().filter(|face| !face.is_empty());
        let rim = self.faces.iter().flat_map(|face| crossings(face, side)).collect();
        Self { faces: kept.chain([in_order(rim)]).collect() }
    }

    /// Volume [m³] and centroid [m], by cones from an inner point; face orientation does not matter.
    fn volume_and_centroid(&self) -> (f64, Vec3) {
        let corners: Vec<&Vec3> = self.faces.iter().flatten().collect();
        if corners.is_empty() {
            return (0.0, Vec3::zeros());
        }
        let apex = corners.iter().copied().sum::<Vec3>() / corners.len() as f64;
        let (mut volume, mut moment) = (0.0, Vec3::zeros());
        for face in &self.faces {
            for i in 1..face.len() - 1 {
                let cone = tet_volume(&[apex, face[0], face[i], face[i + 1]]).abs();
                volume += cone;
                moment += cone * (apex + face[0] + face[i] + face[i + 1]) / 4.0;
            }
        }
        if volume > 0.0 { (volume, moment / volume) } else { (0.0, apex) }
    }
}

/// Points of a convex polygon in order around their mean.
fn in_order(mut points: Vec<Vec3>) -> Vec<Vec3> {
    let middle = points.iter().sum::<Vec3>() / points.len() as f64;
    let furthest = |from: &Vec3| {
        points.iter().fold(*from, |a, b| if (b - from).norm() > (a - from).norm() { *b } else { a })
    };
    let along = furthest(&middle) - middle;
    let widest = points
        .iter()
        .map(|p| along.cross(&(p - middle)))
        .fold(Vec3::zeros(), |a, b| if b.norm() > a.norm() { b } else { a });
    if widest.norm() == 0.0 {
        return points;
    }
    let (e1, e2) = (along.normalize(), widest.normalize().cross(&along.normalize()));
    let angle = |p: &Vec3| (p - middle).dot(&e2).atan2((p - middle).dot(&e1));
    points.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{test_box, test_set};
    use ndda_mesh::BlockMesh;

    fn corner(at: Vec3) -> BlockMesh {
        let nodes = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()].map(|x| x + at).to_vec();
        BlockMesh { nodes, tets: vec![[0, 1, 2, 3]], ..BlockMesh::default() }
    }

    #[test]
    fn a_corner_shifted_into_its_copy_overlaps_by_a_smaller_corner() {
        // x, y, z ≥ shift and x + y + z ≤ 1: a corner of edge 1 − 3 shift.
        let blocks = test_set(vec![corner(Vec3::zeros()), corner(Vec3::repeat(0.2))]);
        let corners = |t| blocks.tet_corners(TetId(t), &blocks.rest_position);
        let expected = 0.4f64.powi(3) / 6.0;
        assert!((overlap_volume_m3(&corners(0), &corners(1)) - expected).abs() < 1e-15);
    }

    #[test]
    fn the_whole_tetrahedron_holds_a_quarter_of_its_volume() {
        // φ = 4 min λ has the mean 1/4, twice for two identical blocks.
        let blocks = test_set(vec![corner(Vec3::zeros()), corner(Vec3::zeros())]);
        let energy = energy_j(&blocks, &blocks.rest_position, 3.0);
        assert!((energy - 3.0 * 2.0 * 0.25 / 6.0).abs() < 1e-14, "{energy}");
    }

    #[test]
    fn forces_balance_and_are_minus_the_gradient_of_the_energy() {
        let upper = test_box([0.3, 0.2, 0.9], [0.5, 0.6, 0.4], [1, 1, 1]);
        let blocks = test_set(vec![test_box([0.0; 3], [1.0; 3], [1, 1, 1]), upper]);
        let moved = |shift: Vec3| {
            let upper = |i: usize| i >= blocks.nodes_of(ndda_mesh::BlockId(1)).start;
            let place = |(i, x): (usize, &Vec3)| if upper(i) { x + shift } else { *x };
            blocks.rest_position.iter().enumerate().map(place).collect::<Vec<_>>()
        };
        let position = moved(Vec3::new(0.01, 0.02, -0.01));
        let force = forces(&blocks, &position, 1e9);
        let scale: f64 = force.iter().map(|f| f.norm()).sum();
        assert!(force.iter().sum::<Vec3>().norm() < 1e-13 * scale);
        let torque: Vec3 = position.iter().zip(&force).map(|(x, f)| x.cross(f)).sum();
        assert!(torque.norm() < 1e-13 * scale);
        let on_upper: Vec3 = force[blocks.nodes_of(ndda_mesh::BlockId(1))].iter().sum();
        for axis in [Vec3::x(), Vec3::y(), Vec3::z()] {
            let at = |by: f64| energy_j(&blocks, &moved(Vec3::new(0.01, 0.02, -0.01) + by * axis), 1e9);
            let slope = (at(1e-5) - at(-1e-5)) / 2e-5;
            assert!((slope + on_upper.dot(&axis)).abs() < 1e-6 * scale, "{axis:?}: {slope}, {on_upper:?}");
        }
    }
}
