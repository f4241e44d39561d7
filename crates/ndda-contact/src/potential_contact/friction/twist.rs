//! Twist of shear springs: the torque of a facet that turns on its target.
//!
//! The springs of a facet are spread over its area. Where it turns by Δθ about its normal, they bear a torque beside their force,
//!
//! ```text
//! T′ = T − ½ k_s r² S̄ Δθ,      r² = mean square distance from the centre of pressure
//! ```
//!
//! and what slips bears less of both: F² + (T/ρ)² ≤ capacity², ρ being the mean distance (Goyal, Ruina & Papadopoulos 1991 approximate the limit surface of an evenly pressed face by this
//! ellipsoid). Force and torque are in the proportion in which the springs would bear them.

use ndda_mesh::Vec3;
use ndda_mesh::geometry::triangle_area_vector;

use crate::affine::convex_target::ConvexBlocks;
use crate::assembly::couples::CoupleScene;
use crate::friction::law::{capped, length};
use crate::friction::law_table::{FrictionLawTable, Memory};
use crate::friction::patches::moments::second_moment_m2;
use crate::integration::integrals::Integrals;
use crate::integration::overlap_pair::ActiveFacet;
use crate::model::ContactInput;

/// ρ/r: 0.937 of a square and 0.943 of a disc that one facet covers. Less, since facets that slide as they turn bear less than the ellipsoid allows: of a
/// square of two facets the torque is right with 0.904.
const MEAN_OVER_ROOT: f64 = 0.92;
/// Part of a facet from which on all of it touches.
const COVERED: f64 = 0.9;

/// Where torques of springs act; none without springs, and where memory belongs to elements: the paper's springs bear forces alone.
pub(crate) fn couples_of_springs<'a>(
    joints: Option<&FrictionLawTable>,
    input: &ContactInput<'a>,
    (integrals, hulls): (&'a Integrals, &'a ConvexBlocks),
) -> Option<CoupleScene<'a>> {
    let bears = |joints: &FrictionLawTable| !joints.act_on_faces_only() && joints.memory == Memory::Body;
    let ContactInput { blocks, position, .. } = *input;
    joints.is_some_and(bears).then_some(CoupleScene { blocks, position, integrals, hulls })
}

/// Mean square distance of the area that touches from its centre of pressure [m²]. It counts as a disc where it is a part of a facet whose shape is not
/// known, on a target that does not move by an affine map.
pub(crate) fn radius2_m2(
    scene: &CoupleScene,
    input: &ContactInput,
    touch: &ActiveFacet,
    (area_m2, center): (f64, &Vec3),
) -> f64 {
    let found = second_moment_m2((input, scene.hulls), touch, area_m2, center).trace();
    let is_cut_out = scene.hulls.affine_target(touch.target).is_some();
    let whole_m2 =
        triangle_area_vector(&input.blocks.triangle_corners(touch.triangle, input.position)).norm();
    if is_cut_out || area_m2 >= COVERED * whole_m2 {
        found
    } else {
        found.min(area_m2 / std::f64::consts::TAU)
    }
}

/// A facet that turns in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Twist {
    /// ½ k_s S̄ [N/m].
    pub spring_n_m: f64,
    /// Mean square distance of the area from the centre of pressure [m²].
    pub radius2_m2: f64,
    /// Turn of the contactor against the target about the normal in the step [rad].
    pub turn_rad: f64,
    /// Shear force [N] and torque [N m] of the last step.
    pub last: ([f64; 2], f64),
    /// Slip of the step [m].
    pub slip_m: [f64; 2],
    /// Most that the law carries [N].
    pub capacity_n: f64,
}

impl Twist {
    /// The torque [N m], and the shear force [N] beside it: that of the law, or less where it slips.
    pub(crate) fn bear(&self, shear_n: [f64; 2]) -> (f64, [f64; 2]) {
        let (old_n, old_n_m) = self.last;
        let trial_n_m = old_n_m - self.spring_n_m * self.radius2_m2 * self.turn_rad;
        if trial_n_m == 0.0 {
            return (0.0, shear_n);
        }
        let trial_n = length([0, 1].map(|i| old_n[i] - self.spring_n_m * self.slip_m[i]));
        let whole_n = trial_n.hypot(trial_n_m / self.mean_distance_m());
        if whole_n <= self.capacity_n {
            return (trial_n_m, shear_n);
        }
        let part = self.capacity_n / whole_n;
        (part * trial_n_m, capped(shear_n, part * trial_n).0)
    }

    /// Most shear force beside a torque [N].
    pub(crate) fn left_n(&self, torque_n_m: f64) -> f64 {
        let twist_n = torque_n_m / self.mean_distance_m();
        (self.capacity_n * self.capacity_n - twist_n * twist_n).max(0.0).sqrt()
    }

    /// Force and torque as one [N].
    pub(crate) fn size_n(&self, shear_n: [f64; 2], torque_n_m: f64) -> f64 {
        if torque_n_m == 0.0 {
            length(shear_n)
        } else {
            length(shear_n).hypot(torque_n_m / self.mean_distance_m())
        }
    }

    fn mean_distance_m(&self) -> f64 {
        MEAN_OVER_ROOT * self.radius2_m2.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn twist(turn_rad: f64, slip_m: [f64; 2]) -> Twist {
        Twist { spring_n_m: 1e6, radius2_m2: 0.25, turn_rad, last: ([0.0; 2], 0.0), slip_m, capacity_n: 10.0 }
    }

    #[test]
    fn a_facet_that_turns_is_a_spring_until_it_slips() {
        let held = twist(1e-6, [0.0; 2]);
        assert_eq!(held.bear([0.0; 2]), (-0.25, [0.0; 2]));
        let slips = twist(1.0, [0.0; 2]);
        let (torque_n_m, _) = slips.bear([0.0; 2]);
        assert!((torque_n_m + 10.0 * MEAN_OVER_ROOT * 0.5).abs() < 1e-12, "{torque_n_m}");
    }

    #[test]
    fn force_and_torque_share_what_the_law_carries() {
        let slides = twist(0.02, [-0.01, 0.0]);
        let (torque_n_m, shear_n) = slides.bear([10.0, 0.0]);
        assert!((slides.size_n(shear_n, torque_n_m) / 10.0 - 1.0).abs() < 1e-12);
        assert!(
            (slides.left_n(torque_n_m) - shear_n[0]).abs() < 1e-12 && shear_n[0] < 10.0 && torque_n_m < 0.0
        );
        // Without a turn the law alone decides.
        assert_eq!(twist(0.0, [-0.01, 0.0]).bear([10.0, 0.0]), (0.0, [10.0, 0.0]));
    }
}
