//! Blocks that lose and regain contact while friction acts: hops that grow, which undamped contact and friction feed, and short ones, which make a block
//! that deforms slide too far.
//!
//! Contact gives back all energy, and friction turns a part of the energy of sliding into that of rocking: a block that would stand lifts off, comes
//! down, and lifts off again, each time for longer. A block that was dropped bounces too, but friction shortens its hops, and where it
//! does not they are as often longer as shorter than the one before: nine flights in growing order are by chance one in 362 880.

use ndda_mesh::Vec3;
use serde::{Deserialize, Serialize};

use crate::bodies::report::RigidForcing;

/// Length of a flight over that of the last one from which on it has grown.
const GROWTH: f64 = 1.05;
/// Length of a flight over that of the touch before, below which contact chatters: a block that bounces flies for longer.
const SHORT: f64 = 10.0;
/// Speed of the fastest node over what a touch adds to the velocity of its block, above which friction cannot stop the block in it.
const STICKS: f64 = 3.0;
/// Speed of the fastest node over all that touches have added to the velocity of the block, below which it slides so slowly that its surface may stick in
/// its vibrations: a block that slides down a slope α has sin α − μ cos α.
const SLOW: f64 = 0.1;

/// The hops of one block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Hops {
    touched: bool,
    /// Whether friction acted since the block came down.
    rubbed: bool,
    /// Length of this flight and of the last one [s].
    flight_s: f64,
    last_flight_s: f64,
    /// Flights in a row that were longer than the one before, and the most so far.
    growing: u32,
    most: u32,
    /// Flights after a touch in which friction acted and could stop the block, and the largest speed at which one ended [m/s].
    stopped: u32,
    stopped_m_s: f64,
    /// Length of this touch [s], and what contact and loads have added to the velocity of the block in it [m/s].
    touch_s: f64,
    push_m_s: Vec3,
    load_m_s: Vec3,
    /// Flights that were hardly longer than the touch before, in which friction acted and could stop the block.
    short: u32,
    /// Speed of the fastest node when one of these ended, the largest [m/s].
    short_m_s: f64,
    /// The sizes of all these pushes [m/s].
    pushed_m_s: f64,
    /// Flights that were hardly longer than the touch before, in which friction acted, of a block that slides slowly, and the speed of the fastest.
    rubbing: u32,
    rubbing_m_s: f64,
    /// The two largest impacts of touches that have ended, the largest first: velocity that contact added to the block, less that which bears its loads [m/s].
    impacts_m_s: [f64; 2],
}

impl Hops {
    /// Books a step.
    pub(crate) fn add(&mut self, dt_s: f64, drive: &RigidForcing) {
        if drive.touches {
            if !self.touched {
                self.land(drive.speed_m_s);
            }
            self.touch_s += dt_s;
            self.push_m_s += dt_s * (drive.shift_m_s2 - drive.load_m_s2);
            self.load_m_s += dt_s * drive.load_m_s2;
            self.rubbed |= drive.has_friction;
        } else {
            if self.touched {
                self.impacts_m_s = self.impacts_with_this_touch_m_s();
            }
            self.flight_s += dt_s;
        }
        self.touched = drive.touches;
    }

    /// The two largest impacts, the present touch among them [m/s].
    fn impacts_with_this_touch_m_s(&self) -> [f64; 2] {
        // Of a block that lies or slides, contact bears no more than its loads against it.
        let push_m_s = self.push_m_s.norm();
        let borne_m_s = -self.load_m_s.dot(&self.push_m_s) / push_m_s.max(f64::MIN_POSITIVE);
        let mut impact_m_s = push_m_s - borne_m_s.max(0.0);
        self.impacts_m_s.map(|larger_m_s| {
            let kept_m_s = larger_m_s.max(impact_m_s);
            impact_m_s = larger_m_s.min(impact_m_s);
            kept_m_s
        })
    }

    fn land(&mut self, speed_m_s: f64) {
        let grows = self.rubbed && self.last_flight_s > 0.0 && self.flight_s > GROWTH * self.last_flight_s;
        self.growing = if grows { self.growing + 1 } else { 0 };
        self.most = self.most.max(self.growing);
        // A faster block slips all through the touch, so that friction is μ times the normal force, however contact vibrates.
        let may_stick = speed_m_s < STICKS * self.push_m_s.norm();
        self.pushed_m_s += self.push_m_s.norm();
        let may_stop = self.rubbed && may_stick;
        if may_stop && self.flight_s > 0.0 {
            self.stopped += 1;
            self.stopped_m_s = self.stopped_m_s.max(speed_m_s);
        }
        let is_short = self.flight_s < SHORT * self.touch_s;
        if may_stop && is_short {
            self.short += 1;
            self.short_m_s = self.short_m_s.max(speed_m_s);
        }
        if self.rubbed && is_short && speed_m_s < SLOW * self.pushed_m_s {
            self.rubbing += 1;
            self.rubbing_m_s = self.rubbing_m_s.max(speed_m_s);
        }
        (self.last_flight_s, self.flight_s, self.rubbed) = (self.flight_s, 0.0, false);
        (self.touch_s, self.push_m_s, self.load_m_s) = (0.0, Vec3::zeros(), Vec3::zeros());
    }

    /// Most flights in a row that were each longer than the one before, friction acting in between.
    pub(crate) fn most(&self) -> u32 {
        self.most
    }

    /// Flights that came after a touch in which friction acted and could stop the block, and the largest speed at which one ended [m/s]; of a block that
    /// deforms and slides slowly, all short ones after a touch in which friction acted.
    pub(crate) fn with_friction(&self, deforms: bool) -> (u32, f64) {
        if deforms && self.rubbing > self.stopped {
            (self.rubbing, self.rubbing_m_s)
        } else {
            (self.stopped, self.stopped_m_s)
        }
    }

    /// The largest impact, as the velocity that contact added \[m/s\].
    pub(crate) fn impact_m_s(&self) -> f64 {
        if self.touched { self.impacts_with_this_touch_m_s()[0] } else { self.impacts_m_s[0] }
    }

    /// The second largest impact, as the velocity that contact added \[m/s\]; 0 where there was one or none.
    pub(crate) fn second_impact_m_s(&self) -> f64 {
        let all = if self.touched { self.impacts_with_this_touch_m_s() } else { self.impacts_m_s };
        all[1]
    }

    /// Flights that were hardly longer than the touch before, in which friction acted and could stop the block, and the largest speed at which one ended [m/s].
    pub(crate) fn short(&self) -> (u32, f64) {
        (self.short, self.short_m_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A step on the ground, which pushes the block up.
    fn on_ground(has_friction: bool, push_m_s2: f64, speed_m_s: f64) -> RigidForcing {
        let shift_m_s2 = push_m_s2 * Vec3::z();
        RigidForcing { touches: true, has_friction, shift_m_s2, speed_m_s, ..RigidForcing::default() }
    }

    /// Most growing hops of flights of so many steps.
    fn most(flights: &[u32], has_friction: bool) -> u32 {
        let mut hops = Hops::default();
        let on_ground = on_ground(has_friction, 0.0, 0.0);
        for &flight in flights {
            hops.add(1e-3, &on_ground);
            (0..flight).for_each(|_| hops.add(1e-3, &RigidForcing::default()));
        }
        hops.add(1e-3, &on_ground);
        hops.most()
    }

    #[test]
    fn flights_are_short_where_they_last_less_than_ten_times_a_touch_in_which_friction_could_stop_the_block()
    {
        let short = |touch: u32, flight: u32, has_friction: bool, push_m_s2: f64| {
            let mut hops = Hops::default();
            let on_ground = on_ground(has_friction, push_m_s2, 2.0);
            for _ in 0..3 {
                (0..touch).for_each(|_| hops.add(1e-3, &on_ground));
                (0..flight).for_each(|_| hops.add(1e-3, &RigidForcing::default()));
            }
            hops.add(1e-3, &on_ground);
            hops.short()
        };
        assert_eq!(short(2, 15, true, 500.0), (3, 2.0));
        assert_eq!(short(1, 15, true, 1000.0), (0, 0.0));
        assert_eq!(short(2, 15, false, 500.0), (0, 0.0));
        // It moves more than three times as fast as contact pushes it.
        assert_eq!(short(2, 15, true, 300.0), (0, 0.0));
    }

    #[test]
    fn flights_count_from_the_second_touch_on_where_friction_acted_and_could_stop_the_block() {
        let counted = |has_friction: bool, speed_m_s: f64, touches: usize| {
            let mut hops = Hops::default();
            let on_ground = on_ground(has_friction, 500.0, speed_m_s);
            for _ in 0..touches {
                for drive in [RigidForcing::default(), on_ground, on_ground] {
                    hops.add(1e-3, &drive);
                }
            }
            [false, true].map(|deforms| hops.with_friction(deforms))
        };
        assert_eq!(counted(true, 1.0, 2), [(1, 1.0); 2]);
        assert_eq!(counted(false, 1.0, 2), [(0, 0.0); 2]);
        // Too fast to be stopped by one touch, but slow beside what 41 and more of them push it by.
        assert_eq!(counted(true, 4.0, 45), [(0, 0.0), (4, 4.0)]);
    }

    #[test]
    fn the_second_largest_push_of_touches_is_known() {
        let mut hops = Hops::default();
        let touch = |hops: &mut Hops, push_m_s2: f64| hops.add(1e-3, &on_ground(false, push_m_s2, 1.0));
        for push_m_s2 in [500.0, 3000.0, 1000.0] {
            touch(&mut hops, push_m_s2);
            touch(&mut hops, push_m_s2);
            hops.add(1e-3, &RigidForcing::default());
        }
        assert!((hops.second_impact_m_s() - 2.0).abs() < 1e-12, "{}", hops.second_impact_m_s());
        // A touch that goes on counts, and one in which contact bears the load does not.
        touch(&mut hops, 4000.0);
        assert!((hops.second_impact_m_s() - 4.0).abs() < 1e-12, "{}", hops.second_impact_m_s());
        let mut lying = Hops::default();
        let load_m_s2 = -500.0 * Vec3::z();
        for _ in 0..4 {
            lying.add(1e-3, &RigidForcing { touches: true, load_m_s2, ..RigidForcing::default() });
            lying.add(1e-3, &RigidForcing::default());
        }
        assert_eq!(lying.second_impact_m_s(), 0.0);
    }

    #[test]
    fn hops_count_where_each_is_longer_than_the_one_before_and_friction_acts() {
        assert_eq!(most(&[1, 2, 3, 4, 5], true), 4);
        assert_eq!(most(&[1, 2, 3, 4, 5], false), 0);
        assert_eq!(most(&[50, 49, 50, 51, 52], true), 0);
        assert_eq!(most(&[1, 2, 3, 2, 3], true), 2);
    }
}
