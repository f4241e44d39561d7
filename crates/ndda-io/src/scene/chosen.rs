//! Values that a scene leaves out.

use serde::{Deserialize, Serialize};

/// A value that a scene leaves out and that was chosen for it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Chosen {
    /// Its path in the scene, as `time.step_s`.
    pub path: String,
    /// The value, in the unit of its field.
    pub value: f64,
    /// Why it was chosen.
    pub reason: String,
}

impl std::fmt::Display for Chosen {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let Self { path, value, reason } = self;
        write!(f, "chosen: {path} = {value:e} ({reason})")
    }
}
