//! Statics of the block above two joints, and of its faces.

use nalgebra::{SMatrix, SVector};
use ndda_mesh::geometry::{tet_volume, triangle_area_vector};
use ndda_mesh::planar::turn;
use ndda_mesh::{Mat3, Vec3};
use ndda_solver::BodyKind;

use crate::simulation;

const DENSITY_KG_M3: f64 = 2600.0;
const GRAVITY_M_S2: f64 = 9.81;

/// A named joint of the block above both: its area [m²] and its triangles.
pub(crate) struct Face {
    pub(crate) area_m2: f64,
    triangles: Vec<[Vec3; 3]>,
}

impl Face {
    pub(crate) fn center(&self) -> Vec3 {
        let of = |t: &[Vec3; 3]| triangle_area_vector(t).norm() * (t[0] + t[1] + t[2]) / 3.0;
        self.triangles.iter().map(of).sum::<Vec3>() / self.area_m2
    }

    /// Pressures at its corners where a weight presses it by its part along a normal [N] at a point above it, and water [Pa] from below, and it stays plane: linear
    /// ones with that force and its moments.
    pub(crate) fn pressures(&self, normal: Vec3, (pressed_n, point): (f64, Vec3), water_pa: f64) -> Vec<f64> {
        // Linear in the horizontal distances from the line of the weight.
        let terms = |x: Vec3| Vec3::new(1.0, x.x - point.x, x.y - point.y);
        let middles = |[a, b, c]: &[Vec3; 3]| [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)];
        let (mut sums, mut water) = (Mat3::zeros(), Vec3::zeros());
        for triangle in &self.triangles {
            assert!((triangle_area_vector(triangle).normalize().dot(&normal).abs() - 1.0).abs() < 1e-9);
            let third_m2 = triangle_area_vector(triangle).norm() / 3.0;
            for middle in middles(triangle).map(terms) {
                sums += third_m2 * middle * middle.transpose();
                water += third_m2 * water_pa * middle;
            }
        }
        let slopes = sums.try_inverse().expect("a face has an area") * (pressed_n * Vec3::x() - water);
        self.triangles.iter().flatten().map(|corner| slopes.dot(&terms(*corner))).collect()
    }
}

/// The block above both joints: its weight [N], its mass centre [m], and its faces on joint `a` and on joint `b`.
pub(crate) fn measures(text: &str) -> (f64, Vec3, [Face; 2]) {
    let simulation = simulation(text);
    let blocks = simulation.blocks();
    let free =
        blocks.ids().find(|&block| simulation.shape(block).kind != BodyKind::Fixed).expect("a free block");
    let x = &blocks.rest_position;
    let corners = |tet: usize| blocks.tets[tet].map(|n| x[n.index()]);
    let volume_m3: f64 = blocks.tets_of(free).map(|tet| tet_volume(&corners(tet))).sum();
    let center = |tet: usize| 0.25 * corners(tet).iter().sum::<Vec3>();
    let moment: Vec3 = blocks.tets_of(free).map(|tet| tet_volume(&corners(tet)) * center(tet)).sum();
    let face = |name: &str| {
        let on_joint = |(triangle, surface): &(&[ndda_mesh::NodeId; 3], &Option<u32>)| {
            let is_named = surface.is_some_and(|surface| blocks.surface_names[surface as usize] == name);
            is_named && blocks.block_of(triangle[0]) == free
        };
        let triangles = blocks.triangles.iter().zip(&blocks.triangle_surface).filter(on_joint);
        let triangles: Vec<[Vec3; 3]> = triangles.map(|(t, _)| t.map(|n| x[n.index()])).collect();
        Face { area_m2: triangles.iter().map(|t| triangle_area_vector(t).norm()).sum(), triangles }
    };
    (DENSITY_KG_M3 * GRAVITY_M_S2 * volume_m3, moment / volume_m3, [face("a"), face("b")])
}

/// Whether a wedge can slide along its line in all equations of statics, moments too, without a pull anywhere: whether there is a point in each face through which its
/// normal force can pass, cohesion and water acting at the centre. Per face the normal, the normal force, tan φ, and the forces of cohesion and water.
pub(crate) fn slides_without_turning(
    faces: &[Face; 2],
    center: Vec3,
    line: Vec3,
    forces: &[(Vec3, f64, f64, [f64; 2]); 2],
) -> bool {
    let down = -line.z.signum() * line.normalize();
    // Both forces may be moved along the line and across it: three equations of moments for four unknown shifts, which leave a straight line of them.
    let (mut turns, mut moment) = (SMatrix::<f64, 3, 4>::zeros(), Vec3::zeros());
    for (k, (face, (n, pressed_n, tan, [held_n, water_n]))) in faces.iter().zip(forces).enumerate() {
        let force = *pressed_n * (n - *tan * down);
        turns.set_column(2 * k, &down.cross(&force));
        turns.set_column(2 * k + 1, &n.cross(&down).cross(&force));
        moment += (face.center() - center).cross(&(force - *held_n * down + *water_n * n));
    }
    let square = (turns * turns.transpose()).try_inverse().expect("no force is zero");
    let first = -turns.transpose() * (square * moment);
    // What the equations leave free: the part of some shift that they do not fix.
    let free = (0..4).map(|k| {
        let unit = SVector::<f64, 4>::ith(k, 1.0);
        unit - turns.transpose() * (square * (turns * unit))
    });
    let free = free.max_by(|a, b| a.norm().total_cmp(&b.norm())).expect("four").normalize();
    // Along it, from where to where both points are in their faces.
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    for (k, (face, (n, ..))) in faces.iter().zip(forces).enumerate() {
        let across = n.cross(&down);
        let middle = face.center();
        let flat = |x: &Vec3| [down, across].map(|axis| axis.dot(&(x - middle)));
        let corners: Vec<[f64; 2]> = face.triangles.iter().flatten().map(flat).collect();
        let point = |at: f64| [0, 1].map(|i| first[2 * k + i] + at * free[2 * k + i]);
        let (p, q) = (point(0.0), point(1.0));
        for (a, b) in edges(&corners) {
            let (v, w) = (turn(&a, &b, &p), turn(&a, &b, &q));
            // v + t (w − v) ≥ 0.
            match w - v {
                slope if slope > 0.0 => from = from.max(-v / slope),
                slope if slope < 0.0 => to = to.min(-v / slope),
                _ if v < 0.0 => return false,
                _ => {}
            }
        }
    }
    from <= to
}

/// The edges of the convex outline of points in a plane, with its inside on their left.
fn edges(points: &[[f64; 2]]) -> Vec<([f64; 2], [f64; 2])> {
    let size = points.iter().flatten().fold(0.0f64, |size, x| size.max(x.abs()));
    let is_edge = |a: &[f64; 2], b: &[f64; 2]| {
        let long = (a[0] - b[0]).hypot(a[1] - b[1]) > 1e-6 * size;
        long && points.iter().all(|c| turn(a, b, c) > -1e-9 * size * size)
    };
    let pairs = points.iter().flat_map(|a| points.iter().map(move |b| (*a, *b)));
    pairs.filter(|(a, b)| is_edge(a, b)).collect()
}
