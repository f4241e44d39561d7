//! Two tetrahedra and the paper's contact between them: all that one pair gives, for other people's codes and tests.
//!
//! W = k ∫_{c∩t} (φ_c + φ_t) dV, φ = 4 min λᵢ. The contactor feels −k ∮ φ_t n dS over its faces in the target, the
//! target −k ∮ φ_c n dS over its own faces in the contactor, and each the opposite of the other's (eq 16).

use ndda_mesh::geometry::{TET_FACES, triangle_area_vector};
use ndda_mesh::{Mat3, Vec3};
use pulp::Arch;

use crate::integration::clip::Outline;
use crate::integration::double_double::Barycentric;
use crate::integration::pair_moments;
use crate::integration::queue::RegionQueue;
use crate::integration::region::element_regions;
use crate::integration::tet_frame::{TetFrame, by_face, is_outside, some_face_separates};
pub use crate::integration::tet_overlap::PairError;
use crate::integration::tet_overlap::ScaledPair;

/// Pairs at a time, so that all about them stays in the cache.
const CHUNK: usize = 64;

/// Contact of a pair of tetrahedra.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairForces {
    /// Volume of c ∩ t [m³].
    pub volume_m3: f64,
    /// W [J].
    pub energy_j: f64,
    /// Force on the contactor [N].
    pub force_n: Vec3,
    /// Its torque about the origin of the coordinates [N m].
    pub torque_n_m: Vec3,
    /// Nodal forces ∫ N dF of the contactor's corners, then of the target's [N].
    pub nodal_n: [Vec3; 8],
    /// ∂f/∂x_t: change of the force on the contactor when the target is shifted [N/m]. That of the contactor's own
    /// shift is its opposite. A surface piece keeps its shape in its own body and φ vanishes on the rim that the
    /// other cuts, so only φ changes: k ∫ n ⊗ ∇φ_t dS over c's faces in t, and the same of t's faces in c.
    pub stiffness_n_m: Mat3,
}

impl PairForces {
    /// Largest singular value of [`stiffness_n_m`](Self::stiffness_n_m) [N/m].
    pub fn largest_stiffness_n_m(&self) -> f64 {
        let largest = self.stiffness_n_m.amax();
        // Squares of the entries would leave the range of f64.
        if largest > 0.0 { largest * (self.stiffness_n_m / largest).singular_values().max() } else { 0.0 }
    }

    fn is_finite(&self) -> bool {
        let vectors = self.nodal_n.iter().chain([&self.force_n, &self.torque_n_m]);
        let numbers = vectors.flat_map(|v| v.iter()).chain(self.stiffness_n_m.iter());
        numbers.chain([&self.energy_j]).all(|v| v.is_finite()) && self.largest_stiffness_n_m().is_finite()
    }
}

/// Forces, energy, volume and stiffness of a pair. Corners may be in either order; results keep the caller's.
///
/// # Errors
/// [`PairError`] for input that has no answer.
pub fn pair_forces(
    contactor: &[Vec3; 4],
    target: &[Vec3; 4],
    penalty_pa: f64,
) -> Result<PairForces, PairError> {
    if penalty_pa.is_nan() || penalty_pa <= 0.0 {
        return Err(PairError::Penalty(penalty_pa));
    }
    if penalty_pa.is_infinite() {
        return Err(PairError::NotFinite("penalty_pa"));
    }
    let pair = ScaledPair::new(contactor, target)?;
    let overlap = pair.overlap()?;
    let energy_j = (overlap.phi_contactor_m3 + overlap.phi_target_m3) * penalty_pa;
    let mut forces = PairForces { volume_m3: overlap.volume_m3, energy_j, ..PairForces::default() };
    if pair.may_overlap() {
        add_forces(&pair, penalty_pa, &mut forces);
    }
    if forces.is_finite() { Ok(forces) } else { Err(PairError::NotFinite("a result")) }
}

fn add_forces(pair: &ScaledPair, penalty_pa: f64, forces: &mut PairForces) {
    let ([c, t], unit_m) = (&pair.corners, pair.unit_m);
    let (mut of_c, mut of_t) = ([Vec3::zeros(); 4], [Vec3::zeros(); 4]);
    let own_stiffness = add_faces(c, t, &mut of_c, &mut of_t) + add_faces(t, c, &mut of_t, &mut of_c);
    forces.stiffness_n_m = -own_stiffness * unit_m * penalty_pa;
    let [of_c, of_t] = [of_c, of_t].map(|nodal| nodal.map(|f| f * unit_m * unit_m * penalty_pa));
    forces.force_n = of_c.iter().sum();
    // About the contactor's corner, then about the caller's origin: map coordinates lose no digits.
    let arms = c.iter().zip(&of_c).map(|(x, f)| ((x - c[0]) * unit_m).cross(f));
    forces.torque_n_m = arms.sum::<Vec3>() + (c[0] * unit_m).cross(&forces.force_n);
    forces.nodal_n[..4].copy_from_slice(&in_callers_order(of_c, pair.swapped[0]));
    forces.nodal_n[4..].copy_from_slice(&in_callers_order(of_t, pair.swapped[1]));
}

fn in_callers_order([a, b, c, d]: [Vec3; 4], swapped: bool) -> [Vec3; 4] {
    if swapped { [b, a, c, d] } else { [a, b, c, d] }
}

/// The kernel that blocks use, for many pairs of tetrahedra; its memory is used again and again.
///
/// λ is rounded to f64 here: the forces of a flat tetrahedron along a face are off by ε times its width over its height,
/// where [`pair_forces`] is right to rounding.
pub struct NodalForces {
    arch: Arch,
    batches: RegionQueue,
    /// λ of each pair's corners in the other tetrahedron, as `[owner][corner][b]`.
    lambda: Vec<[[[f64; 4]; 4]; 2]>,
    /// ∫ φ ψ_a dA over the area of each face of each pair.
    pressure: Vec<[[f64; 3]; 8]>,
}

impl Default for NodalForces {
    fn default() -> Self {
        let (lambda, pressure) = (Vec::new(), Vec::new());
        Self { arch: Arch::new(), batches: RegionQueue::default(), lambda, pressure }
    }
}

impl NodalForces {
    /// Nodal forces of each pair of tetrahedra of positive volume on each other [N].
    pub fn of(&mut self, pairs: &[[[Vec3; 4]; 2]], penalty_pa: f64, forces: &mut [[[Vec3; 4]; 2]]) {
        for (pairs, forces) in pairs.chunks(CHUNK).zip(forces.chunks_mut(CHUNK)) {
            self.of_chunk(pairs, penalty_pa, forces);
        }
    }

    fn of_chunk(&mut self, pairs: &[[[Vec3; 4]; 2]], penalty_pa: f64, forces: &mut [[[Vec3; 4]; 2]]) {
        self.lambda.clear();
        self.pressure.clear();
        self.pressure.resize(pairs.len(), [[0.0; 3]; 8]);
        for (index, pair) in pairs.iter().enumerate() {
            self.add_pair(index, pair);
        }
        let pressure = &mut self.pressure;
        self.batches.finish(self.arch, |part| {
            let of_face = &mut pressure[part.pair as usize / 8][part.pair as usize % 8];
            (0..3).for_each(|a| of_face[a] += part.pressure[a]);
        });
        let found = self.lambda.iter().zip(&self.pressure);
        for ((pair, (lambda, pressure)), forces) in pairs.iter().zip(found).zip(forces) {
            *forces = spread(pair, lambda, pressure, penalty_pa);
        }
    }

    fn add_pair(&mut self, index: usize, tets: &[[Vec3; 4]; 2]) {
        let mut lambda = [[[0.0; 4]; 4]; 2];
        for owner in 0..2 {
            let frame = TetFrame::new(&tets[1 - owner]);
            for (lambda, x) in lambda[owner].iter_mut().zip(&tets[owner]) {
                *lambda = frame.lambda_at(x);
            }
            for (face, [i, j, k]) in TET_FACES.iter().enumerate() {
                let at = &lambda[owner];
                self.add_face((8 * index + 4 * owner + face) as u32, [&at[*i], &at[*j], &at[*k]]);
            }
        }
        self.lambda.push(lambda);
    }

    /// The regions of a face from λ as `[a][b]`, over a face of unit area: the area comes with the normal.
    fn add_face(&mut self, face: u32, at: [&[f64; 4]; 3]) {
        if some_face_separates(at) {
            return;
        }
        self.batches.push_element(self.arch, face, 1.0, &by_face(at), &[0.0; 4]);
    }
}

/// Nodal forces of one pair.
fn spread(
    tets: &[[Vec3; 4]; 2],
    lambda: &[[[f64; 4]; 4]; 2],
    pressure: &[[f64; 3]; 8],
    penalty_pa: f64,
) -> [[Vec3; 4]; 2] {
    let mut forces = [[Vec3::zeros(); 4]; 2];
    for (face, [p, q, r]) in pressure.iter().enumerate().filter(|(_, w)| **w != [0.0; 3]) {
        let (owner, [i, j, k]) = (face / 4, TET_FACES[face % 4]);
        let own = &tets[owner];
        let push = -penalty_pa * triangle_area_vector(&[own[i], own[j], own[k]]);
        forces[owner][i] += *p * push;
        forces[owner][j] += *q * push;
        forces[owner][k] += *r * push;
        let (x, y, z) = (&lambda[owner][i], &lambda[owner][j], &lambda[owner][k]);
        for b in 0..4 {
            forces[1 - owner][b] -= (x[b] * p + y[b] * q + z[b] * r) * push;
        }
    }
    forces
}

/// Adds −φ n of the owner's faces to both, and returns what a shift of the owner changes: −Σ ∫ n ⊗ ∇φ dS.
fn add_faces(
    owner: &[Vec3; 4],
    other: &[Vec3; 4],
    on_owner: &mut [Vec3; 4],
    on_other: &mut [Vec3; 4],
) -> Mat3 {
    let of_other = Barycentric::new(other);
    let mut stiffness = Mat3::zeros();
    for face in TET_FACES {
        let corners = face.map(|i| owner[i]);
        let lambda = [0, 1, 2, 3].map(|b| corners.map(|x| of_other.at(b, &x)));
        if is_outside(&lambda) {
            continue;
        }
        let area_vector = triangle_area_vector(&corners);
        // Over a face of unit area; the area comes with the normal.
        let moments = pair_moments::element_moments(&lambda, &[0.0; 4], 1.0);
        for (i, w) in face.iter().zip(moments.pressure) {
            on_owner[*i] -= w * area_vector;
        }
        for (sum, w) in on_other.iter_mut().zip(moments.on_target(&lambda).pressure) {
            *sum += w * area_vector;
        }
        let mut slope = Vec3::zeros();
        element_regions(&lambda, &[0.0; 4], |b, region| {
            slope += region.polygon(&Outline::TRIANGLE).fan().map(|(_, twice)| twice).sum::<f64>()
                * 4.0
                * of_other.gradient(b);
        });
        stiffness -= area_vector * slope.transpose();
    }
    stiffness
}

#[cfg(test)]
mod tests {
    use ndda_mesh::BlockMesh;

    use super::*;
    use crate::element_pairs;
    use crate::testing::test_set;

    fn tets() -> ([Vec3; 4], [Vec3; 4]) {
        let c = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.1, 1.1, 0.0], [0.2, 0.1, 0.9]].map(Vec3::from);
        let t = [[0.3, 0.2, 0.5], [1.2, 0.3, 0.6], [0.3, 1.3, 0.4], [0.4, 0.5, 1.6]].map(Vec3::from);
        (c, t)
    }

    #[test]
    fn the_force_is_minus_the_slope_of_the_energy_and_the_stiffness_the_slope_of_the_force() {
        let (c, t) = tets();
        let step = 1e-6;
        let here = pair_forces(&c, &t, 2.0).unwrap();
        assert!(here.volume_m3 > 0.0);
        for k in 0..3 {
            let shift = Vec3::from_fn(|i, _| if i == k { step } else { 0.0 });
            let [ahead, behind] = [shift, -shift].map(|s| pair_forces(&c.map(|x| x + s), &t, 2.0).unwrap());
            let slope = (ahead.energy_j - behind.energy_j) / (2.0 * step);
            assert!((slope + here.force_n[k]).abs() < 1e-9, "{slope} and {}", here.force_n[k]);
            let change = (ahead.force_n - behind.force_n) / (2.0 * step);
            assert!((change + here.stiffness_n_m.column(k)).norm() < 1e-7, "{change:?}");
        }
        let asymmetry = (here.stiffness_n_m - here.stiffness_n_m.transpose()).norm();
        assert!(asymmetry < 1e-12 * here.stiffness_n_m.norm());
    }

    #[test]
    fn the_kernel_and_the_calculator_agree_also_where_a_barycentric_coordinate_is_minus_one() {
        let t = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
        // λ₀ = 1 − x − y − z is −1 there.
        let far = Vec3::new(1.0, 0.5, 0.5);
        let near = [Vec3::new(0.1, 0.1, 0.1), Vec3::new(0.2, 0.5, 0.1), Vec3::new(0.1, 0.2, 0.6)];
        for c in [[near[0], far, near[1], near[2]], [far, near[0], near[2], near[1]]] {
            let found = pair_forces(&c, &t, 1.0).unwrap();
            let mut fast = [[[Vec3::zeros(); 4]; 2]];
            NodalForces::default().of(&[[c, t]], 1.0, &mut fast);
            let [fast] = fast;
            for (a, b) in found.nodal_n.iter().zip(fast.as_flattened()) {
                assert!((a - b).norm() < 1e-15, "{a:?} and {b:?} for {c:?}");
            }
        }
    }

    #[test]
    fn nodal_forces_are_those_of_the_slow_twin_and_turn_the_body_by_the_torque() {
        let (c, t) = tets();
        let mesh =
            |x: [Vec3; 4]| BlockMesh { nodes: x.to_vec(), tets: vec![[0, 1, 2, 3]], ..BlockMesh::default() };
        let blocks = test_set(vec![mesh(c), mesh(t)]);
        let expected = element_pairs::forces(&blocks, &blocks.rest_position, 3.0);
        let found = pair_forces(&c, &t, 3.0).unwrap();
        assert!(found.nodal_n.iter().zip(&expected).all(|(a, b)| (a - b).norm() < 1e-14));
        let torque: Vec3 = c.iter().zip(&found.nodal_n).map(|(x, f)| x.cross(f)).sum();
        assert!((torque - found.torque_n_m).norm() < 1e-15);
        let far = Vec3::new(4.5e6, 4.2e6, -4.5e6);
        let away = pair_forces(&c.map(|x| x + far), &t.map(|x| x + far), 3.0).unwrap();
        // The corners there are rounded to 2⁻³⁰ m.
        assert!((away.torque_n_m - far.cross(&away.force_n) - found.torque_n_m).norm() < 1e-8);
    }

    #[test]
    fn a_pair_of_any_size_that_f64_can_hold_is_answered() {
        let (c, t) = tets();
        let here = pair_forces(&c, &t, 1.0).unwrap();
        for scale in [1e-100, 1e-30, 1e30, 1e100] {
            let there = pair_forces(&c.map(|x| x * scale), &t.map(|x| x * scale), 1.0).unwrap();
            assert!((there.volume_m3 / scale / scale / scale - here.volume_m3).abs() < 1e-15);
            assert!((there.force_n / scale / scale - here.force_n).norm() < 1e-15);
            let stiffness = there.largest_stiffness_n_m() / scale;
            assert!((stiffness - here.largest_stiffness_n_m()).abs() < 1e-13);
        }
    }

    #[test]
    fn the_order_of_corners_does_not_matter() {
        let (c, t) = tets();
        let here = pair_forces(&c, &t, 1.0).unwrap();
        let other = pair_forces(&[c[1], c[0], c[2], c[3]], &t, 1.0).unwrap();
        assert!((here.force_n - other.force_n).norm() < 1e-14);
        assert!((here.nodal_n[0] - other.nodal_n[1]).norm() < 1e-14);
    }

    #[test]
    fn input_without_an_answer_is_refused() {
        let (c, t) = tets();
        assert_eq!(pair_forces(&c, &t, 0.0), Err(PairError::Penalty(0.0)));
        assert_eq!(pair_forces(&[c[0]; 4], &t, 1.0), Err(PairError::Flat("contactor")));
        let mut nan = t;
        nan[2].y = f64::NAN;
        assert_eq!(pair_forces(&c, &nan, 1.0), Err(PairError::NotFinite("target")));
    }
}
