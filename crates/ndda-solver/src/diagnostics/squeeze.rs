//! Blocks between others whose contact vibrates while friction acts.
//!
//! What contact presses a block by from opposite sides does not move it, but friction is in proportion to it. Where the block vibrates so strongly that
//! its sides nearly lose contact in turn, contact cannot pull, so that the mean of the forces grows beyond that of the block at rest, and friction with it: a block that
//! must slide out may hang. A block on one plane has no such forces: there the mean follows from its weight.

use serde::{Deserialize, Serialize};

use crate::bodies::report::RigidForcing;

/// Part of the last largest squeeze below which contact is nearly lost, and inverse of the multiple of the least one from which on it is regained.
const NEARLY_LOST: f64 = 0.25;

/// How what squeezes one block rises and falls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Squeeze {
    /// Whether the squeeze has nearly been lost since its last peak.
    is_lost: bool,
    /// The largest squeeze since it was regained, or the least since it was lost [m/s²].
    extreme_m_s2: f64,
    /// How often it was regained while friction acted, and the speed of the fastest node when that happened, the largest [m/s].
    regained: u32,
    speed_m_s: f64,
}

impl Squeeze {
    /// Books a step.
    pub(crate) fn add(&mut self, drive: &RigidForcing) {
        let squeeze_m_s2 = drive.squeeze_m_s2;
        if self.is_lost {
            // Less than its loads moves the block hardly more than these do.
            let is_regained =
                NEARLY_LOST * squeeze_m_s2 > self.extreme_m_s2 && squeeze_m_s2 > drive.load_m_s2.norm();
            if is_regained {
                self.regained += 1;
                self.speed_m_s = self.speed_m_s.max(drive.speed_m_s);
                (self.is_lost, self.extreme_m_s2) = (false, squeeze_m_s2);
            } else {
                self.extreme_m_s2 = self.extreme_m_s2.min(squeeze_m_s2);
            }
        } else if squeeze_m_s2 < NEARLY_LOST * self.extreme_m_s2 {
            (self.is_lost, self.extreme_m_s2) = (true, squeeze_m_s2);
        } else {
            self.extreme_m_s2 = self.extreme_m_s2.max(squeeze_m_s2);
        }
    }

    /// How often contact from opposite sides was nearly lost and regained while friction acted, and the largest speed of a node then [m/s].
    pub(crate) fn regained(&self) -> (u32, f64) {
        (self.regained, self.speed_m_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_mesh::Vec3;

    /// How often a block under a load of 10 m/s² regains what squeezes it.
    fn regained(squeezes_m_s2: &[f64]) -> u32 {
        let mut squeeze = Squeeze::default();
        for &squeeze_m_s2 in squeezes_m_s2 {
            let load_m_s2 = Vec3::new(0.0, 0.0, -10.0);
            squeeze.add(&RigidForcing { squeeze_m_s2, load_m_s2, speed_m_s: 1.0, ..RigidForcing::default() });
        }
        assert_eq!(squeeze.regained().1, if squeeze.regained().0 > 0 { 1.0 } else { 0.0 });
        squeeze.regained().0
    }

    #[test]
    fn a_squeeze_counts_where_it_is_nearly_lost_and_regained() {
        assert_eq!(regained(&[40.0, 5.0, 40.0, 0.0, 12.0, 30.0, 2.0, 1.0, 11.0]), 3);
    }

    #[test]
    fn a_squeeze_that_varies_does_not_count_nor_does_one_below_the_loads() {
        assert_eq!(regained(&[40.0, 15.0, 40.0, 12.0, 60.0]), 0);
        assert_eq!(regained(&[40.0, 1.0, 9.0, 0.5, 9.9]), 0);
    }
}
