//! Errors of velocities that steps leave where contact or supports make a block vibrate, or change its forces abruptly.
//!
//! A step takes forces at one instant for their mean over the step. Taken in the middle of it, at a predicted place, the
//! impulse of a force F is off by Δt |Δ²F|/6, Δ²F = Fₙ₊₁ − 2Fₙ + Fₙ₋₁ being Δt² F″: 1/24 for one instant instead of the mean, and
//! 1/8 for the place, which is predicted without the acceleration. Where a force jumps by J, because a block
//! begins to slide or a bond breaks, it does so anywhere within a step, which leaves up to ½ Δt J, and two steps see |Δ²F| = J:
//! ¼ Δt |Δ²F| each. A second difference is a jump where contact begins, and where it is more than twice its root mean square
//! over the last steps: that of a vibration is at most √2 times as much. Taken at the start or the end of a step,
//! an impulse is off by ½ Δt |ΔF|, F being the resultant, or the force by which other blocks press a block from both sides, if
//! that changes more. Supports and elasticity act by their mean over a step without jumps: Δt |Δ²F|/12, π/2 times that where
//! the error has its maximum rather than in the mean, and more at the end of a beam than at its mass centre.
//!
//! In a collision without friction these errors cancel, since the force begins and ends at zero, and what is left is an error of
//! energy, which is judged by itself (`block_diagnostics.rs`). They add up where a force has more than one maximum before the block
//! is free again, and where friction makes of the history of a force a velocity that stays. While a block vibrates, the error
//! is at most twice the speed of its vibration, which is all wrong in phase then.

use crate::bodies::report::RigidForcing;
use std::f64::consts::PI;

use ndda_mesh::{Mat3, Vec3};
use serde::{Deserialize, Serialize};

use crate::bodies::context::StepContext;
use crate::bodies::kind::BodyKind;
use crate::bodies::prototype::Prototype;
use crate::bodies::record::support_acceleration;
use crate::bodies::report::BlockReport;

/// Largest ratio of the speed of a supported block's fastest node to that of its mass centre that is reckoned with: 2.6 for the first mode of a beam
/// that is held at one end.
const END_OF_A_BEAM: f64 = 3.0;

/// Largest error of a block's velocity over its largest so far that is accepted while contact forces are taken at one end of a step, where they damp or feed vibrations.
const MOST_ONE_SIDED: f64 = 10.0;

/// Factor by which a step reduces the sums of squares of the steps before it: they reach over about 64 steps.
const KEPT: f64 = 1.0 - 1.0 / 64.0;

/// Mean of |Δ²a|² over that of |Δa|² from which on accelerations alternate from step to step: 4 if they do nothing else.
const ALTERNATES: f64 = 3.0;

/// Square of a second difference over its mean over the last steps from which on it is a jump, and no part of a vibration.
const JUMP2: f64 = 4.0;

impl RigidForcing {
    /// Forcing of a block in a step that is turned by R.
    pub(crate) fn of(
        shape: &Prototype,
        context: &StepContext,
        rotation: &Mat3,
        report: &BlockReport,
    ) -> Self {
        let touches = report.contact_rate2 > 0.0;
        if context.falls_alone && !touches && shape.is_free() {
            return Self::default();
        }
        let operator = &shape.operator;
        let mut turn_m_s2 = Vec3::zeros();
        if shape.is_free() {
            let center = operator.center(context.contact_position);
            let arms = context.contact_position.iter().zip(context.force);
            let torque: Vec3 = arms.map(|(x, f)| (x - center).cross(f)).sum();
            turn_m_s2 = rotation * (shape.turn_per_n_m * rotation.tr_mul(&torque));
        }
        if !touches && shape.is_free() {
            let free_m_s2 = [context.force.iter().sum::<Vec3>() / operator.mass_kg, turn_m_s2];
            return Self { is_free: true, free_m_s2, ..Self::default() };
        }
        let is_held = shape.kind != BodyKind::Fixed;
        if !is_held {
            return Self::default();
        }
        let load: Vec3 = context.external.iter().sum();
        let force = context.force.iter().sum::<Vec3>() + report.reaction;
        let deforms = shape.deforms();
        let mut pressed_n = 0.0;
        if touches && deforms && !context.weights.contact_in_the_middle() {
            let pressing = context.force.iter().zip(context.external).map(|(f, load)| (f - load).norm());
            pressed_n = 0.5 * pressing.sum::<f64>();
        }
        Self {
            pressed_m_s2: pressed_n / operator.mass_kg,
            load_m_s2: load / operator.mass_kg,
            shift_m_s2: force / operator.mass_kg - support_acceleration(shape, context),
            damped_m_s: report.impulse / operator.mass_kg,
            turn_m_s2,
            is_held,
            is_clamped: !shape.supports.held.is_empty() || !shape.supports.springs.is_empty(),
            touches,
            speed_m_s: report.speed_m_s,
            has_friction: context.friction_force.iter().any(|f| *f != Vec3::zeros()),
            contact_rate2: report.contact_rate2,
            ..Self::default()
        }
    }
}

/// How a step takes forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Quadrature {
    /// Δt [s].
    pub dt_s: f64,
    /// Whether contact is taken at the start or the end of a step.
    pub is_one_sided: bool,
    /// How far from the middle of a step elasticity is taken, over the step: ½ where it is taken at the end.
    pub elastic_lag: f64,
    /// Whether energies of pairs are judged, so that collisions need not be.
    pub judges_pairs: bool,
    /// Whether this is the first step.
    pub is_first: bool,
}

/// Errors of velocities of a block, added up without regard to their direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Ringing {
    last: [Vec3; 2],
    pressed_m_s2: f64,
    change: [Vec3; 2],
    /// Means of |Δa|² and |Δ²a|² over the last steps, as sums with weights, and the sum of the weights.
    first2: f64,
    second2: f64,
    weight: f64,
    /// Whether the acceleration grew in the last step, and how often it has begun to fall since contact began.
    grows: bool,
    maxima: u32,
    has_friction: bool,
    is_held: bool,
    /// Whether contact has acted on it, and whether only supports have, which held places of it in the last step.
    has_touched: bool,
    is_clamped: bool,
    /// Whether the last step was the first of all.
    was_first: bool,
    /// Fastest node since contact began [m/s].
    fastest_m_s: f64,
    /// Sum since contact began [m/s].
    now_m_s: f64,
    /// Velocity error left by contacts that are over [m/s].
    past_m_s: f64,
    /// All of it that is left now [m/s].
    error_m_s: f64,
}

impl Ringing {
    /// Books a step.
    pub(crate) fn add(&mut self, step: &Quadrature, drive: &RigidForcing) {
        if !drive.is_held && !self.is_held {
            return;
        }
        let now = [drive.shift_m_s2, drive.turn_m_s2];
        if !self.is_held {
            // Contact begins at zero, but for what touches from the start.
            self.last = if step.is_first { now } else { [drive.load_m_s2, Vec3::zeros()] };
            self.pressed_m_s2 = if step.is_first { drive.pressed_m_s2 } else { 0.0 };
        }
        let change = [now[0] - self.last[0], now[1] - self.last[1]];
        if std::mem::replace(&mut self.was_first, step.is_first) {
            // The change before the first step is unknown.
            self.change = change;
        }
        let second = [change[0] - self.change[0], change[1] - self.change[1]];
        let (first2, second2) = (square(&change), square(&second));
        let jumps = self.weight < 1.0 || second2 * self.weight > JUMP2 * self.second2;
        let in_the_middle = if jumps { 0.25 } else { 1.0 / 6.0 };
        self.first2 = KEPT * self.first2 + first2;
        self.second2 = KEPT * self.second2 + second2;
        self.weight = KEPT * self.weight + 1.0;
        let only_supported = drive.is_held && !drive.touches;
        let reverses = dot(&now, &self.last) < 0.0 && dot(&change, &self.change) < 0.0;
        self.count_maxima(square(&now) - square(&self.last), only_supported && reverses);
        self.has_friction |= drive.has_friction;
        self.fastest_m_s = self.fastest_m_s.max(drive.speed_m_s);
        self.now_m_s += step.dt_s
            * match (only_supported, step.is_one_sided) {
                (true, _) => {
                    let error_m_s2 = step.elastic_lag * first2.sqrt() + PI / 24.0 * second2.sqrt();
                    self.outer_over_mean(step) * error_m_s2
                }
                (false, true) => 0.5 * first2.sqrt().max((drive.pressed_m_s2 - self.pressed_m_s2).abs()),
                (false, false) => in_the_middle * second2.sqrt(),
            };
        // Taken at one end of a step, forces of contact leave errors of first order until the block is free again.
        let is_over = !step.is_one_sided || step.judges_pairs && !drive.touches;
        self.has_touched |= drive.touches;
        let is_clamped = drive.is_clamped && !self.has_touched;
        let cancels = self.maxima <= 1 && !self.has_friction && is_over && !is_clamped;
        let most_m_s = if is_clamped && step.elastic_lag > 0.0 {
            // The scheme damps vibrations: the error is at most the speed that is left.
            drive.speed_m_s
        } else if step.is_one_sided && !is_clamped {
            MOST_ONE_SIDED * self.fastest_m_s
        } else {
            f64::INFINITY
        };
        let new_m_s = if cancels { 0.0 } else { self.now_m_s.min(most_m_s) };
        self.error_m_s = (self.past_m_s + new_m_s).min(self.bound_m_s(step, only_supported));
        (self.last, self.change, self.is_held) = (now, change, drive.is_held);
        self.is_clamped = is_clamped;
        self.pressed_m_s2 = drive.pressed_m_s2;
        if !drive.is_held {
            *self = Self { past_m_s: self.error_m_s, error_m_s: self.error_m_s, ..Self::default() };
        }
    }

    /// Counts the maxima of an acceleration; one that alternates has one in every step.
    fn count_maxima(&mut self, growth: f64, alternates: bool) {
        if growth < 0.0 && self.grows || alternates {
            self.maxima += 1;
        }
        if growth != 0.0 {
            self.grows = growth > 0.0;
        }
    }

    /// Speed of the fastest node over that of the vibration of the mass centre.
    fn outer_over_mean(&self, step: &Quadrature) -> f64 {
        let mean_m_s = self.vibration_m_s(step);
        // Before the first maximum, the mean is not known.
        let is_known = mean_m_s > 0.0 && self.maxima > 0;
        if is_known { (self.fastest_m_s / mean_m_s).clamp(1.0, END_OF_A_BEAM) } else { 1.0 }
    }

    /// Speed of a vibration: an acceleration of amplitude a that turns by θ in a step has |Δa| = θ a and |Δ²a| = θ² a, √½ of that
    /// in root mean squares, and belongs to a speed of a Δt/θ = |Δa| Δt/θ².
    fn vibration_m_s(&self, step: &Quadrature) -> f64 {
        if self.second2 == 0.0 {
            return 0.0;
        }
        let turn2 = self.second2 / self.first2;
        step.dt_s * (2.0 * self.first2 / self.weight).sqrt() / turn2
    }

    /// Most that a vibration may be wrong; there is no limit while forces are one-sided, which damp or feed vibrations.
    fn bound_m_s(&self, step: &Quadrature, only_supported: bool) -> f64 {
        let is_bounded = (only_supported || !step.is_one_sided) && self.maxima > 1 && self.second2 > 0.0;
        let alternates = only_supported && self.second2 > ALTERNATES * self.first2;
        match (is_bounded, alternates) {
            (false, _) => f64::INFINITY,
            (true, true) => 0.25 * step.dt_s * (self.first2 / self.weight).sqrt(),
            (true, false) => 2.0 * self.vibration_m_s(step),
        }
    }

    /// Whether nothing but supports, which held places of the block in the last step, has ever held it.
    pub(crate) fn is_clamped(&self) -> bool {
        self.is_clamped
    }

    /// Error of the velocity now [m/s].
    pub(crate) fn error_m_s(&self) -> f64 {
        self.error_m_s
    }
}

fn square(a: &[Vec3; 2]) -> f64 {
    dot(a, a)
}

fn dot(a: &[Vec3; 2], b: &[Vec3; 2]) -> f64 {
    a[0].dot(&b[0]) + a[1].dot(&b[1])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn step(dt_s: f64, is_one_sided: bool) -> Quadrature {
        Quadrature { dt_s, is_one_sided, elastic_lag: 0.0, judges_pairs: true, is_first: false }
    }

    fn pushed(acceleration: f64, is_held: bool) -> RigidForcing {
        RigidForcing {
            shift_m_s2: Vec3::new(0.0, 0.0, acceleration),
            is_held,
            touches: true,
            ..RigidForcing::default()
        }
    }

    /// Half a period of ω = 1 in `steps`, as often as `collisions` says, without or with friction.
    fn collide(ringing: &mut Ringing, steps: u32, collisions: u32, has_friction: bool) {
        let dt_s = PI / f64::from(steps);
        for _ in 0..collisions {
            for k in 1..steps {
                let drive = RigidForcing { has_friction, ..pushed((dt_s * f64::from(k)).sin(), true) };
                ringing.add(&step(dt_s, false), &drive);
            }
            ringing.add(&step(dt_s, false), &RigidForcing::default());
        }
    }

    #[test]
    fn forces_at_one_end_of_a_step_make_of_a_block_that_hardly_moves_no_fast_one() {
        let mut ringing = Ringing::default();
        for k in 0..1000 {
            let drive = RigidForcing { speed_m_s: 1e-3, ..pushed(f64::from(k % 2), true) };
            ringing.add(&step(1e-2, true), &drive);
        }
        assert_eq!(ringing.error_m_s(), MOST_ONE_SIDED * 1e-3);
    }

    #[test]
    fn errors_of_a_collision_cancel_unless_there_is_friction() {
        let mut ringing = Ringing::default();
        collide(&mut ringing, 100, 5, false);
        assert_eq!(ringing.error_m_s(), 0.0);
        collide(&mut ringing, 100, 1, true);
        // |Δ²F| is θ where the force begins, a quarter of which counts, and adds up to 2 θ in its course, of which a sixth does.
        let expected = (0.25 + 2.0 / 6.0) * (PI / 100.0).powi(2);
        assert!((ringing.error_m_s() / expected - 1.0).abs() < 0.01, "{}", ringing.error_m_s() / expected);
    }

    #[test]
    fn a_vibration_is_late_by_a_part_of_its_speed_and_never_more_than_all_wrong() {
        for (turn, periods) in [(0.1, 3u32), (0.1, 1000), (0.02, 20)] {
            let mut ringing = Ringing::default();
            let steps = (TAU / turn * f64::from(periods)) as u32;
            for k in 0..steps {
                let mut step = step(turn, false);
                step.is_first = k == 0;
                ringing.add(&step, &pushed((turn * f64::from(k)).cos(), true));
            }
            // True is θ²/24 per radian for forces at predicted places; the sum has θ²/6 times the mean of |cos|.
            let (late, time) = (turn * turn / 24.0, TAU * f64::from(periods));
            let (least, most) = ((late * time).min(1.0), (4.0 * late * time).min(3.0));
            assert!(
                (least..most).contains(&ringing.error_m_s()),
                "{turn} {periods}: {} in {least}..{most}",
                ringing.error_m_s()
            );
        }
    }

    #[test]
    fn all_of_a_velocity_that_alternates_from_step_to_step_is_wrong() {
        // v₁ = −v₀ of 1 m/s by accelerations of ±2 v/Δt, which die out slowly.
        let (dt_s, mut ringing) = (0.5, Ringing::default());
        for k in 0..40 {
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            let drive = RigidForcing {
                touches: false,
                speed_m_s: 1.0,
                ..pushed(sign * 2.0 / dt_s * 0.9999f64.powi(k), true)
            };
            ringing.add(&Quadrature { is_first: k == 0, elastic_lag: 0.5, ..step(dt_s, false) }, &drive);
        }
        assert!((ringing.error_m_s() - 1.0).abs() < 0.02, "{}", ringing.error_m_s());
    }

    #[test]
    fn what_a_vibration_has_left_goes_with_it() {
        let mut ringing = Ringing::default();
        for k in 0..20_000 {
            let time = 0.1 * f64::from(k);
            let step = Quadrature { is_first: k == 0, ..step(0.1, false) };
            ringing.add(&step, &pushed(time.cos() * (-0.01 * time).exp(), true));
        }
        assert!(ringing.error_m_s() < 1e-7, "{}", ringing.error_m_s());
    }

    #[test]
    fn a_force_that_jumps_leaves_half_the_jump() {
        let mut ringing = Ringing::default();
        for k in 0..10 {
            let step = Quadrature { is_first: k == 0, ..step(0.01, false) };
            ringing.add(
                &step,
                &RigidForcing { has_friction: true, ..pushed(if k < 5 { 2.0 } else { 1.0 }, true) },
            );
        }
        assert!((ringing.error_m_s() - 0.5 * 0.01 * 1.0).abs() < 1e-15);
    }

    #[test]
    fn forces_at_the_end_of_steps_are_off_by_half_their_change() {
        let mut ringing = Ringing::default();
        let step = Quadrature { judges_pairs: false, ..step(0.01, true) };
        for push in [1.0, 2.0, 1.0] {
            ringing.add(&step, &RigidForcing { speed_m_s: 1.0, ..pushed(push, true) });
        }
        ringing.add(&step, &RigidForcing::default());
        assert!((ringing.error_m_s() - 0.5 * 0.01 * 4.0).abs() < 1e-15);
    }
}
