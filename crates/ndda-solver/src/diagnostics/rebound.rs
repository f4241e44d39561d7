//! Blocks that stick and slip while their contact rebounds, as it does from gravity that acts suddenly.
//!
//! A block that hardly slides, v' = g sin α − μ N/m, sinks into its contact and comes up again at a speed w, w' = N/m − g cos α. While it slips, v + μ w grows
//! as that of a block on rigid contact. Where μ w exceeds that, the block sticks (v = 0) with less friction than its limit, and v + μ w grows by more. The softer
//! contact is, the larger w is, √(g d) for a depth d at rest, and the faster the block slides from then on.
//!
//! While it slips, contact pushes in one direction. What the impulse of the first oscillations has across the direction of later pushes is what friction failed
//! to do: it is v's gain, over √(1 + μ²).

use ndda_mesh::Vec3;
use serde::{Deserialize, Serialize};

use crate::bodies::report::RigidForcing;

/// Length of a window of time, over 1/ω_c: rows of contact stiffness give an ω_c several times that of the oscillations.
const WINDOW: f64 = 60.0;
/// Most steps before a block that is drawn in contact touches.
const TOUCHES_WITHIN: f64 = 3.5;
/// Largest speed of a rebound over |g|/ω_c.
const FASTEST: f64 = 10.0;
/// Least cosine between the gain and the way of a block, 1/√(1 + μ²) where it slides.
const ALONG: f64 = 0.6;
/// Cosine between directions of a load that does not turn.
const SAME: f64 = 0.999_999;

/// The first oscillations of a block on its contacts, and what they gave to its speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Rebound {
    /// Time since the start [s].
    time_s: f64,
    watch: Watch,
    /// Impulse of contact and velocity since then, over its mass [m/s].
    impulse_m_s: Vec3,
    velocity_m_s: Vec3,
    load_m_s2: Vec3,
    /// Largest ω_c² so far.
    rate2: f64,
    /// Time in the second and the third window [s], and integrals of the impulse in each, and of the velocity in both [m].
    window_s: [f64; 2],
    impulse_m: [Vec3; 2],
    way_m: Vec3,
    gained_m_s: f64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
enum Watch {
    #[default]
    ToBegin,
    On,
    Over,
}

impl Rebound {
    /// Books a step.
    pub(crate) fn add(&mut self, dt_s: f64, drive: &RigidForcing) {
        if self.watch == Watch::Over {
            return;
        }
        self.time_s += dt_s;
        if self.watch == Watch::ToBegin {
            let is_late = self.time_s > TOUCHES_WITHIN * dt_s;
            let from_rest_m_s = 2.0 * drive.load_m_s2.norm() * self.time_s;
            self.watch = match drive.touches {
                true if drive.speed_m_s <= from_rest_m_s => Watch::On,
                true => Watch::Over,
                false if is_late => Watch::Over,
                false => return,
            };
            self.load_m_s2 = drive.load_m_s2;
            self.velocity_m_s = (self.time_s - dt_s) * drive.load_m_s2;
        }
        if drive.touches {
            let turns =
                drive.load_m_s2.dot(&self.load_m_s2) < SAME * drive.load_m_s2.norm() * self.load_m_s2.norm();
            if turns {
                self.watch = Watch::Over;
                return;
            }
            self.load_m_s2 = drive.load_m_s2;
            self.impulse_m_s += dt_s * (drive.shift_m_s2 - drive.load_m_s2);
            self.velocity_m_s += dt_s * drive.shift_m_s2;
            self.rate2 = self.rate2.max(drive.contact_rate2);
        } else {
            self.velocity_m_s += dt_s * self.load_m_s2;
        }
        self.look(dt_s);
    }

    fn look(&mut self, dt_s: f64) {
        let window_s = WINDOW / self.rate2.sqrt();
        let window = (self.time_s / window_s) as usize;
        match window {
            0 => {}
            1 | 2 => {
                self.window_s[window - 1] += dt_s;
                self.impulse_m[window - 1] += dt_s * self.impulse_m_s;
                self.way_m += dt_s * self.velocity_m_s;
            }
            _ => {
                self.watch = Watch::Over;
                self.gained_m_s = self.found_m_s();
            }
        }
    }

    /// The gain, for a block that slides on, or 0.
    fn found_m_s(&self) -> f64 {
        if self.window_s.contains(&0.0) {
            return 0.0;
        }
        let [first, second] = [0, 1].map(|k| self.impulse_m[k] / self.window_s[k]);
        let Some(direction) = (second - first).try_normalize(0.0) else { return 0.0 };
        let gain_m_s = first - first.dot(&direction) * direction;
        let gained_m_s = gain_m_s.norm();
        let way_m = self.way_m.norm();
        let mean_m_s = way_m / (self.window_s[0] + self.window_s[1]);
        let fastest_m_s = FASTEST * self.load_m_s2.norm() / self.rate2.sqrt();
        // Blocks that others push aside meanwhile go elsewhere.
        let is_along = gain_m_s.dot(&self.way_m) > ALONG * gained_m_s * way_m;
        if is_along && gained_m_s <= mean_m_s.min(fastest_m_s) { gained_m_s } else { 0.0 }
    }

    /// Speed that a sliding block has gained in rebounds [m/s].
    pub(crate) fn gained_m_s(&self) -> f64 {
        self.gained_m_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the rebounds of a mass on a slope of 45° add, on a spring of ω = 100 /s under gravity that is 10 m/s² down the slope and into it, by steps of 20 µs;
    /// and what it slides faster than on rigid contact after 2 s.
    fn slides(friction: f64, damping: f64) -> (f64, f64) {
        let (dt_s, rate2, for_s) = (2e-5, 1e4, 2.0);
        let load_m_s2 = Vec3::new(10.0, 0.0, -10.0);
        let (mut depth_m, mut sinks_m_s, mut slides_m_s) = (0.0, 0.0, 0.0);
        let mut rebound = Rebound::default();
        for _ in 0..(for_s / dt_s) as u32 {
            let push_m_s2 = f64::max(0.0, rate2 * depth_m + damping * sinks_m_s);
            sinks_m_s += dt_s * (10.0 - push_m_s2);
            depth_m += dt_s * sinks_m_s;
            let free_m_s = slides_m_s + dt_s * 10.0;
            let stopped_m_s = f64::max(0.0, free_m_s - dt_s * friction * push_m_s2);
            let rubs_m_s2 = (free_m_s - stopped_m_s) / dt_s;
            slides_m_s = stopped_m_s;
            let drive = RigidForcing {
                load_m_s2,
                shift_m_s2: load_m_s2 + Vec3::new(-rubs_m_s2, 0.0, push_m_s2),
                touches: push_m_s2 > 0.0,
                speed_m_s: f64::hypot(slides_m_s, sinks_m_s),
                contact_rate2: rate2,
                ..RigidForcing::default()
            };
            rebound.add(dt_s, &drive);
        }
        (rebound.gained_m_s(), slides_m_s - 10.0 * for_s * f64::max(0.0, 1.0 - friction))
    }

    #[test]
    fn a_block_that_hardly_slides_gains_what_its_rebounds_add_and_one_that_slides_fast_gains_nothing() {
        let (gained_m_s, faster_m_s) = slides(0.97, 60.0);
        assert!(faster_m_s > 0.01, "{faster_m_s}");
        assert!((gained_m_s * 1.97f64.sqrt() / faster_m_s - 1.0).abs() < 0.1, "{gained_m_s} {faster_m_s}");
        let (gained_m_s, faster_m_s) = slides(0.7, 60.0);
        assert!(gained_m_s < 1e-3 && faster_m_s.abs() < 1e-3, "{gained_m_s} {faster_m_s}");
    }

    /// One whose contact vibrates for ever slips a little in each vibration, and walks where it should stand.
    #[test]
    fn a_block_that_comes_to_rest_has_gained_nothing_and_one_that_walks_on_vibrations_is_told() {
        let [(rests_m_s, _), (walks_m_s, _)] = [60.0, 0.0].map(|damping| slides(1.3, damping));
        assert!(rests_m_s < 1e-3 && walks_m_s > 0.01, "{rests_m_s} {walks_m_s}");
    }
}
