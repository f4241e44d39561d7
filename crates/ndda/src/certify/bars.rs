//! What error bars say beside the largest value of their kind.

use super::certificate::Certified;
use super::extrapolate::Behaviour;

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
}
