//! Blocks that stick and slip while their contact rebounds, as it does from gravity that acts suddenly.
//!
//! A block that hardly slides, v' = g sin α − μ N/m, sinks into its contact and comes up again at a speed w, w' = N/m − g cos α. While it slips, v + μ w grows
//! as that of a block on rigid contact. Where μ w exceeds that, the block sticks (v = 0) with less friction than its limit, and v + μ w grows by more. The softer
//! contact is, the larger w is, √(g d) for a depth d at rest, and the faster the block slides from then on.
//!
//! On rigid contact the speed of a block that hardly slides is proportional to L = ∫ g dt, the speed that its loads alone would give it. On soft contact its speed
//! becomes a straight line over L once the first oscillations are over. The value of this line at L = 0 is the speed that rebounds have added. This holds for blocks
//! between others, too.
//!
//! Where loads or friction change later, as in a stage, contact rebounds again. L counts from there, and the speed that a block has by then is none that these
//! rebounds add. What a block that slides already gains while its load turns is not judged.
//!
//! A block that damping in proportion to mass slows is not judged: its speed is no line over L.
//!
//! A block that deforms may still oscillate then, so that there is no line. If it lies on one plane, its impulse tells: while it slips, contact pushes in one
//! direction, and the part of the first impulse that is perpendicular to it is what friction failed to do, the gain over √(1 + μ²).

use ndda_mesh::Vec3;
use serde::{Deserialize, Serialize};

use crate::bodies::report::RigidForcing;

/// Time at which the first window begins, over 1/ω_c; each window is as long as all time before it. Rows of contact stiffness give an ω_c several times that of the oscillations.
const BEGIN: f64 = 15.0;
/// Windows, the last of which ends after 240/ω_c.
const WINDOWS: usize = 4;
/// Longest flight of a block whose contact rebounds, over 1/ω_c.
const LONGEST_FLIGHT: f64 = 30.0;
/// Part by which a load may change in and after the windows, and part of its effect that damping may take in a step.
const STEADY: f64 = 1e-3;
/// Most steps before a block that is drawn in contact touches.
const TOUCHES_WITHIN: f64 = 3.5;
/// Largest speed of a rebound over |g|/ω_c.
const FASTEST: f64 = 10.0;
/// Least part of its speed in one window that a block which slides on has in the next: one that sinks or stops is slower then.
const SLIDES_ON: f64 = 0.95;
/// By how much the starts of two lines may differ where a block deforms and may oscillate slowly, over the gain.
const SAME_LINE: f64 = 0.2;
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
    /// Velocity since then [m/s].
    velocity_m_s: Vec3,
    load_m_s2: Vec3,
    /// Its velocity when the last oscillations began [m/s].
    from_m_s: Vec3,
    /// Impulse of contact since then, over its mass [m/s].
    impulse_m_s: Vec3,
    /// Speed that loads alone would have given it since then [m/s].
    fall_m_s: f64,
    /// The load when it last changed, and the time since then [s], in which the windows lie.
    steady_m_s2: f64,
    steady_s: f64,
    /// Time since it last touched [s].
    flies_s: f64,
    /// Largest ω_c² so far, and whether friction has acted.
    rate2: f64,
    rubs: bool,
    /// Windows since the load has become steady, and how many have ended.
    windows: [Window; WINDOWS],
    ended: usize,
    /// The gain from the line of its speed, and from its impulse on one plane [m/s].
    gained_m_s: f64,
    across_m_s: f64,
    /// The largest of both in earlier oscillations [m/s].
    before_m_s: [f64; 2],
}

/// Time in a window [s], and integrals of the impulse, the velocity and ∫ g dt in it [m].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Window {
    time_s: f64,
    impulse_m: Vec3,
    way_m: Vec3,
    fall_m: f64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
enum Watch {
    #[default]
    ToBegin,
    On,
    /// The oscillations are over, until loads or friction change.
    Over,
    /// Its velocity is not known.
    Lost,
}

impl Rebound {
    /// Books a step of a block that deforms or does not.
    pub(crate) fn add(&mut self, dt_s: f64, drive: &RigidForcing, deforms: bool) {
        if self.watch == Watch::Lost {
            return;
        }
        self.time_s += dt_s;
        if self.watch == Watch::ToBegin && !self.begins(dt_s, drive) {
            return;
        }
        if drive.touches {
            self.follow_contact(dt_s, drive);
        } else {
            self.velocity_m_s += dt_s * self.load_m_s2;
            self.flies_s += dt_s;
            if self.watch == Watch::On && self.falls() {
                self.watch = Watch::Over;
            }
        }
        if self.watch == Watch::On {
            self.fall_m_s += dt_s * self.load_m_s2.norm();
            self.look(dt_s, deforms);
        }
    }

    /// Whether it has left its contact for longer than an oscillation.
    fn falls(&self) -> bool {
        self.flies_s * self.rate2.sqrt() > LONGEST_FLIGHT
    }

    /// Whether a block that has not touched yet does so in a step, soon after it was at rest; one that did not begin at rest is not watched.
    fn begins(&mut self, dt_s: f64, drive: &RigidForcing) -> bool {
        let is_late = self.time_s > TOUCHES_WITHIN * dt_s;
        let from_rest_m_s = 2.0 * drive.load_m_s2.norm() * self.time_s;
        self.watch = match drive.touches {
            true if drive.speed_m_s <= from_rest_m_s => Watch::On,
            true => Watch::Lost,
            false if is_late => Watch::Lost,
            false => return false,
        };
        self.load_m_s2 = drive.load_m_s2;
        self.velocity_m_s = (self.time_s - dt_s) * drive.load_m_s2;
        self.fall_m_s = self.velocity_m_s.norm();
        self.watch == Watch::On
    }

    /// Books a step in contact.
    fn follow_contact(&mut self, dt_s: f64, drive: &RigidForcing) {
        let (load_m_s2, had_m_s2) = (drive.load_m_s2.norm(), self.load_m_s2.norm());
        let turns = drive.load_m_s2.dot(&self.load_m_s2) < SAME * load_m_s2 * had_m_s2;
        let is_damped = drive.damped_m_s.norm() > STEADY * dt_s * load_m_s2;
        // How a block that has fallen has moved under a load that has turned meanwhile is not known.
        if is_damped || turns && self.falls() {
            self.watch = Watch::Lost;
            return;
        }
        self.load_m_s2 = drive.load_m_s2;
        let changes = (load_m_s2 - had_m_s2).abs() > STEADY * had_m_s2;
        if turns || self.watch == Watch::Over && changes {
            self.begin_anew();
        }
        self.wait_for_steady_load();
        self.impulse_m_s += dt_s * (drive.shift_m_s2 - drive.load_m_s2);
        self.velocity_m_s += dt_s * drive.shift_m_s2;
        self.rate2 = self.rate2.max(drive.contact_rate2);
        self.rubs |= drive.has_friction;
        self.flies_s = 0.0;
    }

    /// Watches the oscillations that follow a change of loads or friction.
    pub(crate) fn begin_anew(&mut self) {
        if !matches!(self.watch, Watch::On | Watch::Over) {
            return;
        }
        self.watch = Watch::On;
        self.before_m_s = [self.gained_m_s(), self.across_m_s()];
        (self.gained_m_s, self.across_m_s) = (0.0, 0.0);
        (self.from_m_s, self.impulse_m_s, self.fall_m_s) = (self.velocity_m_s, Vec3::zeros(), 0.0);
        (self.steady_s, self.ended, self.windows) = (0.0, 0, <[Window; WINDOWS]>::default());
    }

    /// Watches a block that has been brought to rest.
    pub(crate) fn begin_at_rest(&mut self) {
        *self = Self { before_m_s: [self.gained_m_s(), self.across_m_s()], ..Self::default() };
    }

    /// Looks no more at a block to which somebody gives another velocity.
    pub(crate) fn lose(&mut self) {
        self.watch = Watch::Lost;
    }

    /// Begins the windows anew while a load grows.
    fn wait_for_steady_load(&mut self) {
        let load_m_s2 = self.load_m_s2.norm();
        if (load_m_s2 - self.steady_m_s2).abs() > STEADY * self.steady_m_s2 {
            (self.steady_m_s2, self.steady_s, self.ended) = (load_m_s2, 0.0, 0);
            self.windows = <[Window; WINDOWS]>::default();
        }
    }

    fn look(&mut self, dt_s: f64, deforms: bool) {
        self.steady_s += dt_s;
        let over_begin = self.steady_s * self.rate2.sqrt() / BEGIN;
        if over_begin < 1.0 {
            return;
        }
        let window = over_begin.log2() as usize;
        if window > self.ended {
            self.ended = window.min(WINDOWS);
            self.find(deforms);
        }
        match self.windows.get_mut(window) {
            Some(sums) => {
                sums.time_s += dt_s;
                sums.impulse_m += dt_s * self.impulse_m_s;
                sums.way_m += dt_s * self.velocity_m_s;
                sums.fall_m += dt_s * self.fall_m_s;
            }
            None => self.watch = Watch::Over,
        }
    }

    /// Finds the gain from the last two windows that have ended.
    fn find(&mut self, deforms: bool) {
        let ended = &self.windows[..self.ended];
        let [.., first, second] = ended else { return };
        if !self.rubs || ended.iter().any(|window| window.time_s == 0.0) {
            return;
        }
        let fastest_m_s = self.fastest_m_s();
        let before = ended.len().checked_sub(3).map(|place| &ended[place]);
        let gained_m_s = start_of_line_m_s(first, second, &self.from_m_s);
        let is_a_line = |before| {
            let other_m_s = start_of_line_m_s(before, first, &self.from_m_s);
            (other_m_s - gained_m_s).abs() < SAME_LINE * gained_m_s
        };
        let is_told = gained_m_s < fastest_m_s && (!deforms || before.is_some_and(is_a_line));
        let across_m_s = if deforms { impulse_across_m_s(first, second) } else { 0.0 };
        self.gained_m_s = if is_told { gained_m_s } else { 0.0 };
        self.across_m_s = if across_m_s < fastest_m_s { across_m_s } else { 0.0 };
    }

    /// Largest speed that rebounds may bring [m/s].
    fn fastest_m_s(&self) -> f64 {
        FASTEST * self.load_m_s2.norm() / self.rate2.sqrt()
    }

    /// Speed that a sliding block has gained in rebounds [m/s].
    pub(crate) fn gained_m_s(&self) -> f64 {
        self.gained_m_s.max(self.before_m_s[0])
    }

    /// Speed that a block which deforms has gained, from its impulse [m/s]; holds if it slides on one plane.
    pub(crate) fn across_m_s(&self) -> f64 {
        self.across_m_s.max(self.before_m_s[1])
    }
}

/// Value at L = 0 of the line of the speed through two windows, less what the block had along its way before [m/s]; 0 for a block that has slowed down.
fn start_of_line_m_s(first: &Window, second: &Window, from: &Vec3) -> f64 {
    let Some(along) = second.way_m.try_normalize(0.0) else { return 0.0 };
    let [(from_m_s, from_fall), (to_m_s, to_fall)] = [first, second]
        .map(|window| (window.way_m.dot(&along) / window.time_s, window.fall_m / window.time_s));
    let start_m_s = from_m_s - (to_m_s - from_m_s) / (to_fall - from_fall) * from_fall;
    let gained_m_s = start_m_s - from.dot(&along).max(0.0);
    if to_m_s > SLIDES_ON * from_m_s { gained_m_s.max(0.0) } else { 0.0 }
}

/// Part of the first impulse perpendicular to later pushes [m/s]; 0 where it is not along the way of the block.
fn impulse_across_m_s(first: &Window, second: &Window) -> f64 {
    let [from_m_s, to_m_s] = [first, second].map(|window| window.impulse_m / window.time_s);
    let Some(direction) = (to_m_s - from_m_s).try_normalize(0.0) else { return 0.0 };
    let gain_m_s = from_m_s - from_m_s.dot(&direction) * direction;
    let gained_m_s = gain_m_s.norm();
    let way_m = first.way_m + second.way_m;
    // Blocks that others push aside meanwhile go elsewhere.
    let is_along = gain_m_s.dot(&way_m) > ALONG * gained_m_s * way_m.norm();
    if is_along && gained_m_s * (first.time_s + second.time_s) <= way_m.norm() { gained_m_s } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the rebounds of a mass on a slope of 45° add, on a spring of ω = 100 /s under gravity that is 10 m/s² down the slope and into it, by steps of 20 µs;
    /// and what it slides faster than on rigid contact after 2.5 s.
    fn slides(friction: f64, damping: f64, deforms: bool) -> (f64, f64) {
        let (rebound, slides_m_s) =
            pushed(2.5, damping, deforms, |_| (Vec3::new(10.0, 0.0, -10.0), friction));
        (
            if deforms { rebound.across_m_s() } else { rebound.gained_m_s() },
            slides_m_s - 10.0 * 2.5 * f64::max(0.0, 1.0 - friction),
        )
    }

    /// A mass on that spring under a load and with a friction that depend on time, after some seconds, and how fast it slides.
    fn pushed(for_s: f64, damping: f64, deforms: bool, at: impl Fn(f64) -> (Vec3, f64)) -> (Rebound, f64) {
        let (dt_s, rate2) = (2e-5, 1e4);
        let (mut depth_m, mut sinks_m_s, mut slides_m_s) = (0.0, 0.0, 0.0);
        let mut rebound = Rebound::default();
        for step in 0..(for_s / dt_s) as u32 {
            let (load_m_s2, friction) = at(f64::from(step) * dt_s);
            let push_m_s2 = f64::max(0.0, rate2 * depth_m + damping * sinks_m_s);
            sinks_m_s += dt_s * (-load_m_s2.z - push_m_s2);
            depth_m += dt_s * sinks_m_s;
            let free_m_s = slides_m_s + dt_s * load_m_s2.x;
            let stopped_m_s = f64::max(0.0, free_m_s - dt_s * friction * push_m_s2);
            let rubs_m_s2 = (free_m_s - stopped_m_s) / dt_s;
            slides_m_s = stopped_m_s;
            let drive = RigidForcing {
                load_m_s2,
                shift_m_s2: load_m_s2 + Vec3::new(-rubs_m_s2, 0.0, push_m_s2),
                touches: push_m_s2 > 0.0,
                has_friction: rubs_m_s2 > 0.0,
                speed_m_s: f64::hypot(slides_m_s, sinks_m_s),
                contact_rate2: rate2,
                ..RigidForcing::default()
            };
            rebound.add(dt_s, &drive, deforms);
        }
        (rebound, slides_m_s)
    }

    #[test]
    fn a_load_that_comes_later_is_judged_as_one_at_the_start_is() {
        let [gentle, steep] = [Vec3::new(0.0, 0.0, -1.0), Vec3::new(10.0, 0.0, -10.0)];
        let later = |t: f64| (if t < 3.0 { gentle } else { steep }, 0.97);
        let (rebound, slides_m_s) = pushed(5.5, 60.0, false, later);
        let faster_m_s = slides_m_s - 10.0 * 2.5 * 0.03;
        let gained_m_s = rebound.gained_m_s();
        assert!(
            faster_m_s > 5e-3 && (gained_m_s / faster_m_s - 1.0).abs() < 0.1,
            "{gained_m_s} {faster_m_s}"
        );
    }

    #[test]
    fn a_block_that_slides_already_has_gained_nothing_where_friction_or_the_load_changes() {
        let (steep, steeper) = (Vec3::new(10.0, 0.0, -10.0), Vec3::new(10.5, 0.0, -10.0));
        for (first, then, more) in
            [(0.7, 0.5, steep), (0.7, 0.9, steep), (0.7, 0.7, steeper), (0.7, 1.1, steep)]
        {
            let at = |t: f64| if t < 3.0 { (steep, first) } else { (more, then) };
            let (rebound, _) = pushed(6.0, 60.0, false, at);
            assert!(rebound.gained_m_s() < 0.05, "{then}: {}", rebound.gained_m_s());
        }
    }

    #[test]
    fn a_block_that_hardly_slides_gains_what_its_rebounds_add_and_one_that_slides_fast_gains_nothing() {
        let (gained_m_s, faster_m_s) = slides(0.97, 60.0, false);
        assert!(
            faster_m_s > 0.01 && (gained_m_s / faster_m_s - 1.0).abs() < 0.05,
            "{gained_m_s} {faster_m_s}"
        );
        let (across_m_s, faster_m_s) = slides(0.97, 60.0, true);
        assert!((across_m_s * 1.97f64.sqrt() / faster_m_s - 1.0).abs() < 0.1, "{across_m_s} {faster_m_s}");
        for deforms in [false, true] {
            let (gained_m_s, faster_m_s) = slides(0.7, 60.0, deforms);
            assert!(gained_m_s < 1e-3 && faster_m_s.abs() < 1e-3, "{gained_m_s} {faster_m_s}");
        }
    }

    /// One whose contact vibrates for ever slips a little in each vibration, and walks where it should stand.
    #[test]
    fn a_block_that_comes_to_rest_has_gained_nothing_and_one_that_walks_on_vibrations_is_told() {
        for deforms in [false, true] {
            let [(rests_m_s, _), (walks_m_s, _)] = [60.0, 0.0].map(|damping| slides(1.3, damping, deforms));
            assert!(rests_m_s < 1e-3 && walks_m_s > 0.01, "{rests_m_s} {walks_m_s}");
        }
    }
}
