//! The parts of a run and whether they are used, reported by the code that decides it.

use serde::Serialize;

/// A part of a run that may be left out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// Name of the part.
    pub name: &'static str,
    /// Whether it is in.
    pub included: bool,
    /// Why, or what it does.
    pub reason: String,
}

impl Part {
    /// A part that is in, with what it does.
    pub fn included(name: &'static str, what: impl Into<String>) -> Self {
        Self { name, included: true, reason: what.into() }
    }

    /// A part that is left out, with the reason.
    pub fn left_out(name: &'static str, why: impl Into<String>) -> Self {
        Self { name, included: false, reason: why.into() }
    }

    /// A part that is in or left out.
    pub fn of(
        name: &'static str,
        included: bool,
        what: impl Into<String>,
        why_not: impl Into<String>,
    ) -> Self {
        if included { Self::included(name, what) } else { Self::left_out(name, why_not) }
    }
}
