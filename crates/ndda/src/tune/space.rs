//! The search space: axes, settings, and the outcome of a trial of one.

/// Choices along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// One of so many choices, in no order.
    Choice(i32),
    /// A number between two, whose neighbours are tried.
    Range(i32, i32),
}

/// The search space.
#[derive(Clone, Debug, PartialEq)]
pub struct Space {
    /// The axes, those first that change the cost and not what is computed.
    pub axes: Vec<Axis>,
    /// The order of the axes while the error is not reached: first those that decide how exact a setting can be.
    pub exact_first: Vec<usize>,
    /// The longest step.
    pub first_level: i32,
    /// The shortest.
    pub last_level: i32,
    /// The error that is to be reached.
    pub target: f64,
    /// Time that all trials together may take [s].
    pub budget_s: f64,
}

/// A setting.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Setting {
    /// The choice along each axis.
    pub at: Vec<i32>,
    /// The level of the step.
    pub level: i32,
}

/// How a trial went.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// It ended.
    Done {
        /// Cost [s].
        time_s: f64,
        /// Its relative error.
        error: f64,
    },
    /// It did not end, or cannot be run.
    Failed {
        /// Why.
        reason: String,
        /// Whether no step would change that.
        is_final: bool,
    },
}

/// A setting that was tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    /// The setting.
    pub setting: Setting,
    /// How it went.
    pub outcome: Outcome,
}

/// Runs trials.
pub trait Trials {
    /// Error that ends a search.
    type Error;
    /// Tries a setting.
    ///
    /// # Errors
    /// Any error that ends the search; a trial that fails is an outcome.
    fn run(&mut self, setting: &Setting) -> Result<Outcome, Self::Error>;
    /// Is told which settings come next, so that they can be run side by side.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    fn prepare(&mut self, _settings: &[Setting]) -> Result<(), Self::Error> {
        Ok(())
    }
}
