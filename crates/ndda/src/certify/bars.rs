//! What error bars say beside the largest value of their kind.

use super::certificate::Certified;
use super::extrapolate::Behaviour;
use super::quantities::Kind;

/// Error bar over the scale from which on a run is not accurate without a word.
const WIDE: f64 = 0.01;
/// Error bar over the scale up to which differences that do not fall are rounding.
const NOTHING: f64 = 1e-7;

impl Certified {
    /// Whether the error bar of the value at the shortest step, or else at the scene's own, is more than 1 % of the scale.
    pub fn is_wide(&self, own: bool) -> bool {
        let error = if own { self.own_error } else { self.error };
        error > WIDE * self.scale
    }

    /// Differences that do not fall and are next to nothing are rounding that slip and contact have made larger.
    pub(super) fn forgive(&mut self) {
        if self.behaviour == Behaviour::Spreads && self.largest_error <= NOTHING * self.scale {
            self.behaviour = Behaviour::Rounding;
        }
    }

    /// A table turns back within the shortest step, a quarter of `step_s`: blows come up to a step too early or too late, and that alike in all runs where they fall
    /// into the same part of a step. A displacement is then wrong by the way of such a step, whatever the differences of runs.
    pub(super) fn distrust(&mut self, kind: Kind, speed_m_s: f64, step_s: f64) {
        if self.behaviour == Behaviour::Rounding {
            self.behaviour = Behaviour::Unseen;
        }
        if kind == Kind::Displacement {
            let least_m = 0.25 * speed_m_s * step_s;
            self.error = self.error.max(least_m);
            self.largest_error = self.largest_error.max(least_m);
            self.own_error = self.own_error.max(4.0 * least_m);
            self.parts.step = self.parts.step.max(least_m);
        }
    }
}
