//! Tractions and forces of a scene.

use serde::{Deserialize, Serialize};

use super::support::Region;

/// A traction on part of a block's surface, constant in direction, per area at rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Traction {
    /// Name of the block, or of many as in `supports`.
    pub block: String,
    /// Which part of its surface: triangles whose three nodes are all in the region.
    pub on: Region,
    /// Traction [Pa].
    pub traction_pa: [f64; 3],
    /// Factor over time, linear between rows and constant outside. Default: 1.
    #[serde(default)]
    pub factor: Vec<FactorRow>,
}

/// A force on a block, constant in direction: on a point, or through the mass centre.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Force {
    /// Name of the block, or of many as in a support; each takes the whole force.
    pub block: String,
    /// The point [m], whose force the corners of its tetrahedron share (outside of the block, the nearest node takes it; farther than a tenth of the diagonal of the block's box from that box, it is refused); of many blocks, those that have it take the force. Default: through the mass centre, shared among
    /// all nodes by volume.
    #[serde(default)]
    pub at_m: Option<[f64; 3]>,
    /// Force [N].
    pub force_n: [f64; 3],
    /// Factor over time, linear between rows and constant outside. Default: 1.
    #[serde(default)]
    pub factor: Vec<FactorRow>,
}

/// One row of a load's factor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FactorRow {
    /// Time [s].
    pub time_s: f64,
    /// Factor [-].
    pub factor: f64,
}
