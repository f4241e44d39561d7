//! Blocks between others whose contact vibrates while friction acts.
//!
//! Friction on a block between two others is in proportion to the normal forces by which these press it, though the forces cancel each other. Where the block
//! or its neighbours vibrate so strongly that its sides nearly lose contact in turn, the mean of these forces rises, since contact cannot pull, and friction
//! with it: a block that must slide out may hang.
//!
//! Forces along the loads of a block do not count. On one plane, and in a stack, their mean follows from the weight.

use ndda_mesh::Vec3;
use serde::{Deserialize, Serialize};

use crate::bodies::report::RigidForcing;

/// Part of the last largest squeeze below which contact is nearly lost, and inverse of the multiple of the least one from which on it is regained.
const NEARLY_LOST: f64 = 0.25;
/// Longest time for which contact is nearly lost in a vibration, over 1/ω_c: loads that come and go take longer.
const LONGEST: f64 = 45.0;
/// Least speed of a block over that of the fastest one at the same time, and over the largest so far: slower ones are within what the label promises.
const FAST: f64 = 0.5;
const LEAST: f64 = 0.01;

/// How what squeezes one block rises and falls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Squeeze {
    /// Sum of the sizes of normal forces on its facets, and on those of others that press it, in this step, and of the forces [N].
    sizes_n: f64,
    resultant_n: Vec3,
    /// Whether the squeeze has nearly been lost since its last peak, and for how long [s].
    is_lost: bool,
    lost_s: f64,
    /// The largest squeeze since it was regained, or the least since it was lost [m/s²].
    extreme_m_s2: f64,
    /// How often it was regained while friction acted, and the speed of the fastest node when that happened, the largest [m/s].
    regained: u32,
    speed_m_s: f64,
}

/// Speeds of a step that those of single blocks are held against [m/s].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fastest {
    /// Of the fastest node of all blocks.
    pub now_m_s: f64,
    /// The largest so far.
    pub so_far_m_s: f64,
}

impl Squeeze {
    /// Adds the normal force on a facet in this step [N], less its part along the loads of the block.
    pub(crate) fn press(&mut self, force_n: &Vec3, load_m_s2: &Vec3) {
        let along = force_n.dot(load_m_s2) / load_m_s2.norm_squared().max(f64::MIN_POSITIVE);
        let across_n = force_n - along * load_m_s2;
        self.sizes_n += across_n.norm();
        self.resultant_n += across_n;
    }

    /// Books a step of a block of a mass: half of what the sizes of forces add up to beyond the size of their sum is what presses it from opposite sides.
    pub(crate) fn close_step(
        &mut self,
        dt_s: f64,
        (mass_kg, drive): (f64, &RigidForcing),
        fastest: &Fastest,
    ) {
        let squeeze_n = 0.5 * (self.sizes_n - self.resultant_n.norm());
        (self.sizes_n, self.resultant_n) = (0.0, Vec3::zeros());
        self.follow(dt_s, if drive.has_friction { squeeze_n / mass_kg } else { 0.0 }, drive, fastest);
    }

    fn follow(&mut self, dt_s: f64, squeeze_m_s2: f64, drive: &RigidForcing, fastest: &Fastest) {
        if self.is_lost {
            self.lost_s += dt_s;
            // Less than its loads moves the block hardly more than these do.
            let is_regained =
                NEARLY_LOST * squeeze_m_s2 > self.extreme_m_s2 && squeeze_m_s2 > drive.load_m_s2.norm();
            if is_regained {
                self.regain(drive, fastest);
                self.extreme_m_s2 = squeeze_m_s2;
            } else {
                self.extreme_m_s2 = self.extreme_m_s2.min(squeeze_m_s2);
            }
        } else if squeeze_m_s2 < NEARLY_LOST * self.extreme_m_s2 {
            (self.is_lost, self.lost_s, self.extreme_m_s2) = (true, 0.0, squeeze_m_s2);
        } else {
            self.extreme_m_s2 = self.extreme_m_s2.max(squeeze_m_s2);
        }
    }

    fn regain(&mut self, drive: &RigidForcing, fastest: &Fastest) {
        let vibrates = self.lost_s * drive.contact_rate2.sqrt() < LONGEST;
        let least_m_s = (FAST * fastest.now_m_s).max(LEAST * fastest.so_far_m_s);
        if vibrates && drive.speed_m_s > least_m_s {
            self.regained += 1;
            self.speed_m_s = self.speed_m_s.max(drive.speed_m_s);
        }
        self.is_lost = false;
    }

    /// How often contact from opposite sides was nearly lost and regained while friction acted, and the largest speed of a node then [m/s].
    pub(crate) fn regained(&self) -> (u32, f64) {
        (self.regained, self.speed_m_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How often a block under a load of 10 m/s², with ω_c = 1000/s and nodes as fast as 1 m/s, regains what squeezes it in steps of so many seconds.
    fn regained(squeezes_m_s2: &[f64], dt_s: f64, fastest: &Fastest) -> u32 {
        let mut squeeze = Squeeze::default();
        let load_m_s2 = Vec3::new(0.0, 0.0, -10.0);
        let drive = RigidForcing { load_m_s2, speed_m_s: 1.0, contact_rate2: 1e6, ..RigidForcing::default() };
        for &squeeze_m_s2 in squeezes_m_s2 {
            squeeze.follow(dt_s, squeeze_m_s2, &drive, fastest);
        }
        assert_eq!(squeeze.regained().1, if squeeze.regained().0 > 0 { 1.0 } else { 0.0 });
        squeeze.regained().0
    }

    const ALONE: Fastest = Fastest { now_m_s: 1.0, so_far_m_s: 1.0 };

    #[test]
    fn a_squeeze_counts_where_it_is_nearly_lost_and_regained() {
        assert_eq!(regained(&[40.0, 5.0, 40.0, 0.0, 12.0, 30.0, 2.0, 1.0, 11.0], 1e-3, &ALONE), 3);
    }

    #[test]
    fn a_squeeze_that_varies_does_not_count_nor_does_one_below_the_loads() {
        assert_eq!(regained(&[40.0, 15.0, 40.0, 12.0, 60.0], 1e-3, &ALONE), 0);
        assert_eq!(regained(&[40.0, 1.0, 9.0, 0.5, 9.9], 1e-3, &ALONE), 0);
    }

    #[test]
    fn a_squeeze_that_loads_take_away_and_bring_back_does_not_count_nor_does_that_of_a_slow_block() {
        let comes_and_goes = [40.0, 5.0, 5.0, 5.0, 40.0];
        assert_eq!(regained(&comes_and_goes, 5e-3, &ALONE), 1);
        assert_eq!(regained(&comes_and_goes, 1e-1, &ALONE), 0);
        assert_eq!(regained(&comes_and_goes, 5e-3, &Fastest { now_m_s: 3.0, so_far_m_s: 3.0 }), 0);
        assert_eq!(regained(&comes_and_goes, 5e-3, &Fastest { now_m_s: 1.0, so_far_m_s: 30.0 }), 1);
        assert_eq!(regained(&comes_and_goes, 5e-3, &Fastest { now_m_s: 1.0, so_far_m_s: 300.0 }), 0);
    }

    #[test]
    fn a_block_in_a_stack_is_not_squeezed_and_one_between_two_walls_is_by_the_force_of_one() {
        let squeezed_m_s2 = |forces_n: &[Vec3]| {
            let mut squeeze = Squeeze::default();
            let load_m_s2 = Vec3::new(0.0, 0.0, -10.0);
            let drive = RigidForcing { has_friction: true, load_m_s2, ..RigidForcing::default() };
            forces_n.iter().for_each(|force_n| squeeze.press(force_n, &load_m_s2));
            squeeze.close_step(1e-3, (2.0, &drive), &ALONE);
            squeeze.extreme_m_s2
        };
        assert_eq!(squeezed_m_s2(&[Vec3::new(0.0, 0.0, 6.0), Vec3::new(0.0, 0.0, 1.0)]), 0.0);
        assert_eq!(squeezed_m_s2(&[Vec3::new(0.0, 0.0, 9.0), Vec3::new(0.0, 0.0, -6.0)]), 0.0);
        assert_eq!(squeezed_m_s2(&[Vec3::new(6.0, 0.0, 0.0), Vec3::new(-6.0, 0.0, 0.0)]), 3.0);
    }
}
