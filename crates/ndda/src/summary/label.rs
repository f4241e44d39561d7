//! The label of a run.

use serde::{Deserialize, Serialize};

/// A run's judgement of its own result, and why.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Label {
    /// Whether its motion is to be trusted.
    pub word: LabelWord,
    /// Why it is not; empty for an accurate run.
    pub reasons: Vec<String>,
}

/// Whether the motion of a run is to be trusted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LabelWord {
    /// Speeds are right to 1 % of the largest, places to a fifth of the height of the tetrahedra in contact, or of the width of a rigid or affine convex block with `Smooth`: to a tenth, but for a blow on a block that is held or far heavier.
    #[default]
    Accurate,
    /// Accurate, but a slightly different start leads to other positions: only statistics of several runs are meaningful.
    Sensitive,
    /// They may not be.
    Inaccurate,
    /// It ended before it could be wrong.
    Stopped,
}

impl LabelWord {
    /// The word itself.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Accurate => "accurate",
            Self::Sensitive => "sensitive",
            Self::Inaccurate => "inaccurate",
            Self::Stopped => "stopped",
        }
    }
}
