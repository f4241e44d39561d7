//! Errors of a block that nothing touches or holds, whose loads change along its way: water on a raft, forces on a bar that turns, bolts.
//!
//! A step takes loads at one instant for their mean, at a predicted place. Gravity is exact then, as is all that does not change along the way. The impulse of what changes is off by up to
//! Δt |Δ²a|/6 for a second difference Δ²a of accelerations (1/24 for one instant instead of the mean, 1/8 for the place), and by ½ Δt |Δa| where a scheme takes
//! loads at one end of a step. These errors are added up without regard to their direction: more than there is, by four times where a block swings. They do not judge a
//! run; they tell whether a second run with half the step has to.

use ndda_mesh::Vec3;
use serde::{Deserialize, Serialize};

use crate::bodies::report::RigidForcing;
use crate::diagnostics::ringing::Quadrature;

/// What steps leave of changing loads on one block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct FreeLoads {
    /// Accelerations in the last step, of its mass centre and of its rotation, and their change in it [m/s²].
    last: [Vec3; 2],
    change: [Vec3; 2],
    /// Steps since something touched or held it, up to two.
    steps: u8,
    /// Sum of the errors [m/s], and its integral over time [m].
    error_m_s: f64,
    place_m: f64,
}

impl FreeLoads {
    /// Books a step.
    pub(crate) fn add(&mut self, step: &Quadrature, drive: &RigidForcing) {
        self.place_m += step.dt_s * self.error_m_s;
        if !drive.is_free {
            self.steps = 0;
            return;
        }
        let now = drive.free_m_s2;
        let change = [now[0] - self.last[0], now[1] - self.last[1]];
        let second = [change[0] - self.change[0], change[1] - self.change[1]];
        let size = |both: &[Vec3; 2]| both[0].norm() + both[1].norm();
        self.error_m_s += step.dt_s
            * match (self.steps, step.is_one_sided || step.elastic_lag > 0.0) {
                (0, _) | (1, false) => 0.0,
                (_, true) => 0.5 * size(&change),
                (_, false) => size(&second) / 6.0,
            };
        (self.last, self.change, self.steps) = (now, change, (self.steps + 1).min(2));
    }

    /// Most that its velocity may be off [m/s].
    pub(crate) fn error_m_s(&self) -> f64 {
        self.error_m_s
    }

    /// Most that its place may be off [m].
    pub(crate) fn place_m(&self) -> f64 {
        self.place_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: Quadrature =
        Quadrature { dt_s: 0.1, is_one_sided: false, elastic_lag: 0.0, judges_pairs: true, is_first: false };

    fn free(acceleration_m_s2: f64) -> RigidForcing {
        let free_m_s2 = [acceleration_m_s2 * Vec3::z(), Vec3::zeros()];
        RigidForcing { is_free: true, free_m_s2, ..RigidForcing::default() }
    }

    #[test]
    fn loads_of_a_block_that_swings_leave_more_than_its_error_and_gravity_leaves_none() {
        let (mut swings, mut falls, mut lies) =
            (FreeLoads::default(), FreeLoads::default(), FreeLoads::default());
        for k in 0..60 {
            swings.add(&STEP, &free((3.3 * 0.1 * f64::from(k)).cos()));
            falls.add(&STEP, &free(-9.81));
            lies.add(&STEP, &RigidForcing { touches: true, ..RigidForcing::default() });
        }
        // The phase is off by θ²/24 in a radian, of a speed of 1/3.3 m/s.
        let error_m_s = 0.33f64.powi(2) / 24.0 * 6.0;
        assert!((2.0..5.0).contains(&(swings.error_m_s() / error_m_s)), "{}", swings.error_m_s() / error_m_s);
        assert!(swings.place_m() > 0.3 * swings.error_m_s() * 6.0);
        assert_eq!((falls.error_m_s(), falls.place_m(), lies), (0.0, 0.0, FreeLoads::default()));
    }

    #[test]
    fn what_a_touch_changes_does_not_count_and_what_one_end_of_a_step_misses_does() {
        let mut hops = FreeLoads::default();
        for load_m_s2 in [-9.81, -5.0, 3.0] {
            (0..3).for_each(|_| hops.add(&STEP, &free(load_m_s2)));
            hops.add(&STEP, &RigidForcing { touches: true, ..RigidForcing::default() });
        }
        assert_eq!(hops.error_m_s(), 0.0);
        let mut late = FreeLoads::default();
        (0..3).for_each(|k| late.add(&Quadrature { is_one_sided: true, ..STEP }, &free(f64::from(k))));
        assert!((late.error_m_s() - 0.1).abs() < 1e-15, "{}", late.error_m_s());
    }
}
