//! Creep of blocks that shear springs hold while their contact vibrates.
//!
//! Where a normal force N vibrates, a shear spring slips whenever μN falls below the spring's force, and does not come back when N grows: a block creeps
//! whose mean load friction would bear (`tests/verification/spring_creep.rs` integrates the law by itself). A block that slides has all of μN against it at all
//! times. So a block creeps that moves while its normal force vibrates and the mean of its friction is less than μ times the mean of N. μ is taken as
//! the largest ratio of both that was seen.

use serde::{Deserialize, Serialize};

use ndda_mesh::Vec3;

use crate::ringing::Drive;

/// Least change of a normal force over its mean that counts as vibration.
const LEAST_VIBRATION: f64 = 0.1;
/// Friction is all at work from this part of what it could bear.
const ALL_AT_WORK: f64 = 0.9;

/// What a block did since it touches others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Creep {
    /// Means over time, as sums: of normal force and friction over the mass [m/s], and the time [s].
    normal: Vec3,
    friction: Vec3,
    time_s: f64,
    /// Largest friction over normal force.
    ratio: f64,
    /// Way of the fastest node while the normal force vibrated [m].
    way_m: f64,
    /// Of contacts that are over [m].
    past_m: f64,
}

impl Creep {
    /// Books a step of a block that shear springs hold.
    pub fn add(&mut self, dt_s: f64, drive: &Drive) {
        if !drive.touches {
            if self.time_s > 0.0 {
                *self = Self { past_m: self.way_m(), ..Self::default() };
            }
            return;
        }
        self.normal += dt_s * drive.normal_m_s2;
        self.friction += dt_s * drive.friction_m_s2;
        self.time_s += dt_s;
        let normal = drive.normal_m_s2.norm();
        let mean = self.normal.norm() / self.time_s;
        if normal > 0.5 * mean {
            self.ratio = self.ratio.max(drive.friction_m_s2.norm() / normal);
        }
        if (normal - mean).abs() > LEAST_VIBRATION * mean {
            self.way_m += dt_s * drive.speed_m_s;
        }
    }

    /// How far it may have crept [m].
    pub fn way_m(&self) -> f64 {
        let bears = self.ratio * self.normal.norm();
        let creeps = self.friction.norm() < ALL_AT_WORK * bears;
        self.past_m.max(if creeps { self.way_m } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block that moves at 1 m/s for a second on a force that vibrates by a part of its mean; friction is what `friction` makes of the normal force.
    fn way_m(part: f64, friction: impl Fn(f64) -> f64) -> f64 {
        let mut creep = Creep::default();
        for k in 0..1000 {
            let normal = 10.0 * (1.0 + part * (0.1 * f64::from(k)).sin());
            let drive = Drive {
                touches: true,
                speed_m_s: 1.0,
                normal_m_s2: normal * Vec3::z(),
                friction_m_s2: friction(normal) * Vec3::x(),
                ..Drive::default()
            };
            creep.add(1e-3, &drive);
        }
        creep.way_m()
    }

    #[test]
    fn a_block_creeps_that_moves_on_a_vibrating_force_while_friction_could_bear_more() {
        assert!((0.8..1.0).contains(&way_m(0.9, |normal| 3.0f64.min(0.6 * normal))));
        assert_eq!(way_m(0.9, |normal| 0.6 * normal), 0.0);
        assert_eq!(way_m(0.0, |_| 3.0), 0.0);
    }
}
