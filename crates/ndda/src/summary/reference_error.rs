//! Comparison of a run with a closed form.

use serde::{Deserialize, Serialize};

/// Error against a closed form, relative to its magnitude.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReferenceError {
    /// Which closed form, by its name in the scene.
    pub kind: String,
    /// Relative error at the end.
    pub error_end: f64,
    /// Largest relative error after `after_s`.
    pub error_max: f64,
    /// After a collision, how far the blocks are from where hard ones would be, over the smallest tetrahedron height.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place_end: Option<f64>,
    /// From when on the largest error is taken \[s\].
    pub after_s: f64,
    /// Relative error at the end against the closed form with the shear spring's stick stage.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stick_stage_end: Option<f64>,
    /// Largest relative error after `after_s` against the closed form with the stick stage.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stick_stage_max: Option<f64>,
}
