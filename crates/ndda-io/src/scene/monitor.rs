//! Points of a scene whose motion is recorded.

use serde::{Deserialize, Serialize};

/// A point whose motion is recorded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Monitor {
    /// Name, unique in the scene.
    pub name: String,
    /// Name of the block; with `Largest`, of many blocks as in `supports`.
    pub block: String,
    /// Where on the block. Default: `Centre`.
    #[serde(default)]
    pub at: At,
}

/// A place on a block.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum At {
    /// The mass centre.
    #[default]
    Centre,
    /// The material point that is here at the start [m].
    Point([f64; 3]),
    /// Whichever node has moved farthest in a direction: another one at any time.
    Largest([f64; 3]),
}
