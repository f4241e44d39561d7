//! Two tetrahedra and the paper's contact between them: all that one pair gives, for other people's codes and tests.
//!
//! W = k ∫_{c∩t} (φ_c + φ_t) dV, φ = 4 min λᵢ. The contactor feels −k ∮ φ_t n dS over its faces in the target, the
//! target −k ∮ φ_c n dS over its own faces in the contactor, and each the opposite of the other's (eq 16).

use ndda_mesh::geometry::{TET_FACES, tet_volume, triangle_area_vector};
use ndda_mesh::{Mat3, Vec3};

use crate::clip::region;
use crate::kernel::{GROUP, GroupMoments, PairGroup, element_moments};
use crate::overlap::{Linear, faces_of, overlap_of};
use crate::pair::{self, TetFrame, is_outside};

/// What the processor can do; asked once.
static ARCH: std::sync::LazyLock<pulp::Arch> = std::sync::LazyLock::new(pulp::Arch::new);

/// What a pair of tetrahedra gives.
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
    /// shift is its opposite.
    pub stiffness_n_m: Mat3,
}

/// Why a pair has no forces.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PairError {
    /// A coordinate or the penalty is infinite or not a number, or too large to compute with.
    #[error("{0} is not finite, or too large to compute with")]
    NotFinite(&'static str),
    /// A tetrahedron without volume has no barycentric coordinates.
    #[error("the {0} is flat: its volume is zero to rounding")]
    Flat(&'static str),
    /// The penalty must push.
    #[error("penalty_pa = {0}: must be positive")]
    Penalty(f64),
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
    // From here on coordinates are local: map coordinates lose no digits, and the shift is exact for close corners.
    let origin = contactor[0];
    let (c, c_swapped) = oriented(&contactor.map(|x| x - origin), "contactor")?;
    let (t, t_swapped) = oriented(&target.map(|x| x - origin), "target")?;
    let mut forces = PairForces::default();
    add_volume_integrals(&c, &t, penalty_pa, &mut forces);
    let [of_c, of_t] = nodal_forces(&c, &t, penalty_pa);
    let own_stiffness = -penalty_pa * (slope_of_surface(&c, &t) + slope_of_surface(&t, &c));
    forces.stiffness_n_m = -own_stiffness;
    forces.force_n = of_c.iter().sum();
    forces.torque_n_m = c.iter().zip(&of_c).map(|(x, f)| x.cross(f)).sum::<Vec3>();
    forces.torque_n_m += origin.cross(&forces.force_n);
    forces.nodal_n[..4].copy_from_slice(&in_callers_order(of_c, c_swapped));
    forces.nodal_n[4..].copy_from_slice(&in_callers_order(of_t, t_swapped));
    let sound = forces.energy_j.is_finite()
        && forces.torque_n_m.iter().all(|t| t.is_finite())
        && forces.nodal_n.iter().flat_map(|f| f.iter()).all(|f| f.is_finite())
        && forces.stiffness_n_m.iter().all(|k| k.is_finite());
    if sound { Ok(forces) } else { Err(PairError::NotFinite("a result")) }
}

/// The corners with positive volume, and whether two of them had to be swapped.
fn oriented(corners: &[Vec3; 4], which: &'static str) -> Result<([Vec3; 4], bool), PairError> {
    let edges = [1, 2, 3].map(|i| (corners[i] - corners[0]).norm());
    let scale = edges[0] * edges[1] * edges[2] / 6.0;
    let volume = tet_volume(corners);
    if !volume.is_finite() || !scale.is_finite() {
        return Err(PairError::NotFinite(which));
    }
    if volume.abs() <= 8.0 * f64::EPSILON * scale || !volume.is_normal() {
        return Err(PairError::Flat(which));
    }
    let [a, b, c, d] = *corners;
    Ok(if volume > 0.0 { (*corners, false) } else { ([b, a, c, d], true) })
}

fn in_callers_order([a, b, c, d]: [Vec3; 4], swapped: bool) -> [Vec3; 4] {
    if swapped { [b, a, c, d] } else { [a, b, c, d] }
}

fn add_volume_integrals(c: &[Vec3; 4], t: &[Vec3; 4], penalty_pa: f64, forces: &mut PairForces) {
    let (frame_c, frame_t) = (TetFrame::new(c), TetFrame::new(t));
    let overlap = overlap_of(c, &frame_t, &Vec3::zeros());
    let four = |f: Linear| Linear { value: 4.0 * f.value, gradient: 4.0 * f.gradient };
    let phi = |frame: &TetFrame| overlap.integral_of_smallest(&faces_of(frame, &Vec3::zeros()).map(four));
    forces.volume_m3 = overlap.volume_and_moment().0.max(0.0);
    if !overlap.is_empty() {
        forces.energy_j = penalty_pa * (phi(&frame_c) + phi(&frame_t));
    }
}

/// Nodal forces of two tetrahedra of positive volume on each other [N]: all eight faces at once, a lane each.
pub fn nodal_forces(c: &[Vec3; 4], t: &[Vec3; 4], penalty_pa: f64) -> [[Vec3; 4]; 2] {
    let (tets, frames) = ([c, t], [TetFrame::new(c), TetFrame::new(t)]);
    let (mut group, mut areas) = (PairGroup::default(), [Vec3::zeros(); GROUP]);
    for (lane, area_vector) in areas.iter_mut().enumerate() {
        let (owner, face) = (lane / 4, TET_FACES[lane % 4]);
        let corners = face.map(|i| tets[owner][i]);
        *area_vector = triangle_area_vector(&corners);
        let inside = frames[1 - owner].lambda_inside(&corners);
        let lambda = inside.filter(|_| *area_vector != Vec3::zeros()).unwrap_or([[-1.0; 3]; 4]);
        for (row, value) in group.lambda.as_flattened_mut().iter_mut().zip(lambda.as_flattened()) {
            row[lane] = *value;
        }
    }
    let mut moments = GroupMoments::default();
    element_moments(*ARCH, &group, &mut moments);
    let mut forces = [[Vec3::zeros(); 4]; 2];
    for (lane, area_vector) in areas.iter().enumerate().filter(|(lane, _)| group.lambda[0][0][*lane] != -1.0)
    {
        let (owner, face, area) = (lane / 4, TET_FACES[lane % 4], area_vector.norm());
        let part = if moments.doubtful[lane] == 0.0 {
            moments.of(lane, area)
        } else {
            let lambda = group.lambda.each_ref().map(|at| at.each_ref().map(|row| row[lane]));
            pair::element_moments(&lambda, &[0.0; 4], area)
        };
        let push = -penalty_pa / area * area_vector;
        for (i, w) in face.iter().zip(part.pressure) {
            forces[owner][*i] += w * push;
        }
        for (sum, w) in forces[1 - owner].iter_mut().zip(part.target_pressure) {
            *sum -= w * push;
        }
    }
    forces
}

/// Σ ∫ n ⊗ ∇φ dS over the owner's faces in the other.
fn slope_of_surface(owner: &[Vec3; 4], other: &[Vec3; 4]) -> Mat3 {
    let frame = TetFrame::new(other);
    let of_face = |face: &[usize; 3]| {
        let corners = face.map(|i| owner[i]);
        slope_of_face(&corners, &triangle_area_vector(&corners), &frame)
    };
    TET_FACES.iter().map(of_face).sum()
}

/// ∫ n ⊗ ∇φ dS over the part of a face inside.
fn slope_of_face(corners: &[Vec3; 3], area_vector: &Vec3, frame: &TetFrame) -> Mat3 {
    let lambda = frame.lambda(corners);
    if is_outside(&lambda) {
        return Mat3::zeros();
    }
    let of_region = |i: usize| {
        let part: f64 = region(&lambda, i).fan().map(|(_, twice)| twice).sum();
        part * area_vector * (4.0 * frame.gradients()[i]).transpose()
    };
    (0..4).map(of_region).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

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
