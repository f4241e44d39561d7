//! What a step sees while a scene settles.

/// Tolerance of friction over the present speed relative to the largest, and its upper limit, which holds while blocks still fall.
const FRICTION: f64 = 0.01;
const MOST_FRICTION: f64 = 1e-3;

/// What a step sees while a scene settles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SettlingStep {
    /// Time of loads and prescribed motions [s].
    pub at_s: f64,
    /// Change of friction that does not matter, as a fraction of the largest friction on a block.
    pub friction_tolerance: f64,
    /// Whether bonds hold whatever they carry.
    pub bonds_hold: bool,
}

impl SettlingStep {
    /// A step at a time [s], with the present speed over the largest so far. That may be as little as loads bring in a single step, and errors of friction must not
    /// keep blocks moving: friction is found to a hundredth of the speed.
    pub(crate) fn new(at_s: f64, speed_ratio: f64, bonds_hold: bool) -> Self {
        Self { at_s, friction_tolerance: (FRICTION * speed_ratio).min(MOST_FRICTION), bonds_hold }
    }
}

/// Times of loads on the way to rest: of so many steps, one after the other, then that at which these end.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Ramp {
    pub start_s: f64,
    pub step_s: f64,
    pub steps: u64,
}

impl Ramp {
    /// Time of the loads in the step after `steps` [s]: the middle of a step of the ramp.
    pub(crate) fn at_s(&self, steps: u64) -> f64 {
        self.start_s + self.step_s * (steps as f64 + 0.5).min(self.steps as f64)
    }
}
