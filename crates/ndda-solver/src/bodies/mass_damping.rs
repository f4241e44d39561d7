//! Damping in proportion to mass, exact for its own decay at any step.
//!
//! Between two instants a constant force f and the drag −a m v give
//!
//! ```text
//! v₁ = e v₀ + s Δt f/m        e = exp(−a Δt)        s = (1 − e)/(a Δt)
//! ```
//!
//! The integrator takes the drag as an impulse of its own, beside the accelerations that it remembers: with its own velocity
//! v₀ + Δt [(1 − γ) a₀ + γ a₁] for v₁ without drag, e v₀ + s (that − v₀) is v₁ with it. The impulse is that of the force
//! −a m ((1 − w) v₀ + w v₁), w = 1/(1 − e) − 1/(a Δt): ½ in short steps, which is the trapezoidal rule, 1 in long ones. Free
//! decay and terminal velocity are exact, so velocities fall monotonically whatever a Δt is.

use ndda_mesh::Vec3;

use crate::integrators::time_integrator::{StepWeights, TimeIntegrator};

/// Below this a Δt, w comes from its series: the difference of its two terms would lose digits.
const SERIES_BELOW: f64 = 0.05;

/// Damping in proportion to mass in steps of one length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassDamping {
    /// a [1/s].
    rate_per_s: f64,
    /// e: what a step leaves of a velocity.
    decay: f64,
    /// s: what a step leaves of the velocity that a constant force brings.
    share: f64,
    /// 1 − w and w: weights of the velocities at the start and at the end of the step in the drag.
    old_weight: f64,
    new_weight: f64,
    /// β of the integrator over that with drag, in u = û + β Δt² a₁.
    stretch: f64,
}

impl MassDamping {
    /// Of a rate a in steps Δt of an integrator with these weights; none where a = 0.
    pub(crate) fn new(rate_per_s: f64, dt_s: f64, weights: &StepWeights) -> Option<Self> {
        let z = rate_per_s * dt_s;
        if z == 0.0 {
            return None;
        }
        let lost = -(-z).exp_m1();
        let share = lost / z;
        let (old_weight, new_weight) = if z < SERIES_BELOW {
            let beyond_half = z / 12.0 * (1.0 - z * z / 60.0 * (1.0 - z * z / 42.0));
            (0.5 - beyond_half, 0.5 + beyond_half)
        } else {
            // Each by itself: in long steps 1 − w is small, and the rate that it is multiplied by large.
            (1.0 / z - 1.0 / z.exp_m1(), 1.0 / lost - 1.0 / z)
        };
        // γ/2β: u = û + Δt² [β a₁ − ½ γ (1 − s) a₁].
        let on_end = 0.5 * weights.velocity_per_m * dt_s;
        let stretch = 1.0 / (1.0 - on_end * (1.0 - share));
        Some(Self { rate_per_s, decay: (-z).exp(), share, old_weight, new_weight, stretch })
    }

    /// The integrator's weights with drag.
    pub(crate) fn weights(&self, weights: &StepWeights) -> StepWeights {
        StepWeights {
            mass_per_s2: weights.mass_per_s2 * self.stretch,
            velocity_per_m: weights.velocity_per_m * self.stretch * self.share,
            ..*weights
        }
    }

    /// û with drag, u = û + ½ Δt (drag impulse over mass) at a₁ = 0 [m].
    pub(crate) fn predict(&self, integrator: &dyn TimeIntegrator, dt_s: f64, v: &Vec3, a: &Vec3) -> Vec3 {
        let predicted = integrator.predict(dt_s, v, a);
        let (mut velocity, mut acceleration) = (*v, *a);
        integrator.correct(dt_s, &predicted, &predicted, &mut velocity, &mut acceleration);
        predicted - 0.5 * dt_s * ((1.0 - self.decay) * v + (1.0 - self.share) * (velocity - v))
    }

    /// Velocity and acceleration at the end of the step from u and û.
    pub(crate) fn correct(
        &self,
        integrator: &dyn TimeIntegrator,
        (dt_s, increment, predicted): (f64, &Vec3, &Vec3),
        velocity: &mut Vec3,
        acceleration: &mut Vec3,
    ) {
        let (old, zero) = (*velocity, Vec3::zeros());
        let driven = self.stretch * (increment - predicted);
        integrator.correct(dt_s, &driven, &zero, velocity, acceleration);
        *velocity = self.decay * old + self.share * (*velocity - old);
    }

    /// Momentum or angular momentum that a step adds to `old` under an impulse.
    pub(crate) fn gain(&self, old: &Vec3, impulse: &Vec3) -> Vec3 {
        self.share * impulse - (1.0 - self.decay) * old
    }

    /// Acceleration by the drag, the mean of a step between two velocities [m/s²].
    pub(crate) fn drag(&self, old: &Vec3, new: &Vec3) -> Vec3 {
        -self.rate_per_s * (self.old_weight * old + self.new_weight * new)
    }

    /// Error of the mean velocity of a step over the change of velocity in it: ½ (v₀ + v₁) instead of (1 − w) v₀ + w v₁.
    pub(crate) fn mean_velocity_error(&self) -> f64 {
        self.new_weight - 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{GeneralizedAlpha, Midpoint, Newmark};

    fn integrators() -> [Box<dyn TimeIntegrator>; 6] {
        [
            Box::new(Midpoint { theta: 0.5 }),
            Box::new(Midpoint { theta: 1.0 }),
            Box::new(Newmark { alpha: 0.5, delta: 1.0 }),
            Box::new(Newmark { alpha: 0.25, delta: 0.5 }),
            Box::new(GeneralizedAlpha { radius: 0.0 }),
            Box::new(GeneralizedAlpha { radius: 0.8 }),
        ]
    }

    /// Place and velocity after some steps of a mass under a constant force, from v = 1 and a = f.
    fn run(integrator: &dyn TimeIntegrator, force: f64, rate: f64, dt_s: f64, steps: u32) -> (f64, f64) {
        let plain = integrator.weights(dt_s);
        let drag = MassDamping::new(rate, dt_s, &plain).expect("damped");
        let weights = drag.weights(&plain);
        let (mut x, mut v, mut a) = (0.0, Vec3::x(), force * Vec3::x());
        for _ in 0..steps {
            let predicted = drag.predict(integrator, dt_s, &v, &a);
            let push = force * Vec3::x() - weights.old_inertia * a;
            let increment = predicted + push / weights.mass_per_s2;
            drag.correct(integrator, (dt_s, &increment, &predicted), &mut v, &mut a);
            x += increment.x;
        }
        (x, v.x)
    }

    #[test]
    fn velocity_under_drag_and_a_constant_force_is_exact_at_any_step() {
        for integrator in integrators() {
            for z in [1e-9, 1e-4, 9e-3, 1.1e-2, 0.3, 2.0, 10.0, 1e6] {
                for force in [0.0, 3.0] {
                    let (_, v) = run(integrator.as_ref(), force, z, 1.0, 7);
                    let exact = (-7.0 * z).exp() - force / z * (-7.0 * z).exp_m1();
                    let off = (v - exact).abs() / (1.0 + exact);
                    assert!(off < 1e-13, "{} at a Δt = {z}: {v}, {exact}", integrator.name());
                }
            }
        }
    }

    #[test]
    fn places_under_drag_converge_with_the_square_of_the_step() {
        for integrator in integrators() {
            let exact = -(-2.0f64).exp_m1() / 2.0;
            let error = |steps: u32| {
                (run(integrator.as_ref(), 0.0, 2.0, 1.0 / f64::from(steps), steps).0 - exact).abs()
            };
            let order = (error(50) / error(100)).log2();
            assert!((order - 2.0).abs() < 0.05, "{}: {order}", integrator.name());
        }
    }

    #[test]
    fn the_impulse_of_drag_is_what_force_does_not_explain() {
        let integrator = Midpoint { theta: 0.5 };
        for z in [1e-6, 5e-3, 4e-2, 6e-2, 1.0, 50.0, 1e6] {
            let drag = MassDamping::new(z, 1.0, &integrator.weights(1.0)).expect("damped");
            let (old, force) = (Vec3::new(1.0, 2.0, -0.5), Vec3::new(0.3, -1.0, 0.2));
            let new = old + drag.gain(&old, &force);
            let off = new - old - force - drag.drag(&old, &new);
            // The remaining velocity is known to its rounding, which the rate multiplies.
            assert!(off.norm() < 1e-14 * (1.0 + z), "{z}: {off}");
        }
    }
}
