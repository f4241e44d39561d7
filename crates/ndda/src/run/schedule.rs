//! When evenly spaced events of a run are due.

/// Whether one of `count` evenly spaced events falls on `step` of `steps`; the first and last steps always count.
pub fn is_due(step: u64, steps: u64, count: u64) -> bool {
    let passed = |s: u64| u128::from(s) * u128::from(count.min(steps)) / u128::from(steps.max(1));
    step == 0 || step >= steps || passed(step) != passed(step - 1)
}

/// How many times [`is_due`] says yes in a run of `steps`.
pub fn events(steps: u64, count: u64) -> u64 {
    count.clamp(1, steps.max(1)) + 1
}

/// When something is written in a run: evenly spaced, and at the ends of stages.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Schedule {
    /// Steps of the run.
    pub steps: u64,
    /// How many times it is to be written.
    pub count: u64,
    /// The last steps of stages.
    pub ends: Vec<u64>,
}

impl Schedule {
    /// Whether it is due at a step.
    pub fn is_due(&self, step: u64) -> bool {
        is_due(step, self.steps, self.count) || self.ends.contains(&step)
    }
}
