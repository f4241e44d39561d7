//! A figure of a test beside its closed form.

use serde::Serialize;

/// A computed value beside that of the closed form.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Of what.
    pub what: String,
    /// Its unit.
    pub unit: &'static str,
    /// Found by the test.
    pub measured: f64,
    /// By the closed form.
    pub exact: f64,
    /// |measured/exact − 1|, or |measured| where the closed form is zero.
    pub error: f64,
}

impl Comparison {
    pub(super) fn new(what: impl Into<String>, unit: &'static str, measured: f64, exact: f64) -> Self {
        let error = if exact == 0.0 { measured.abs() } else { (measured / exact - 1.0).abs() };
        Self { what: what.into(), unit, measured, exact, error }
    }
}
