//! Pressure of water in joints.

use serde::{Deserialize, Serialize};

use super::{FactorRow, Region};

/// Pressure of water on faces, along their inward normals as they are at any time, over the whole wet area, whether blocks touch there or not.
///
/// Contact then carries the effective stress. Weights stay those of the rock. Where a pressure would be negative there is none. The faces
/// of two blocks on one joint are both wet; those on the surface of a joint that no other block covers are, too.
///
/// ```text
/// water: [
///     // A tension crack filled to z = 10.65 m.
///     (on: Joint("crack"), pressure: Level(at_m: (0, 0, 10.65))),
///     // 29.43 kPa at the foot of the crack, nothing at the toe.
///     (on: Joint("slide"), pressure: Points(along: (-0.819, 0, -0.574), at_m: (10.9, 0, 7.65), rows: [(0, 29430), (13.34, 0)])),
/// ],
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Water {
    /// Which faces are wet.
    pub on: Wet,
    /// The pressure there; that of several entries adds up.
    pub pressure: Pressure,
    /// Factor over time, linear between rows and constant outside. Default: 1.
    #[serde(default)]
    pub factor: Vec<FactorRow>,
}

/// Faces that are wet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Wet {
    /// All faces that joints of this name made, or of many as in a support.
    Joint(String),
    /// Part of the surface of a block.
    Part {
        /// Name of the block, or of many as in `supports`.
        block: String,
        /// Which part: triangles whose three nodes are all in the region.
        region: Region,
    },
}

/// A pressure in space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Pressure {
    /// Water at rest below a level, across gravity: ρ g times the depth.
    Level {
        /// A point of the level [m].
        at_m: [f64; 3],
        /// Density of the water [kg/m³]. Default: 1000.
        #[serde(default = "thousand")]
        density_kg_m3: f64,
    },
    /// Linear in space.
    Linear {
        /// Pressure at `at_m` [Pa].
        pressure_pa: f64,
        /// Where it is that [m]. Default: (0, 0, 0).
        #[serde(default)]
        at_m: [f64; 3],
        /// Its change per metre along x, y and z [Pa/m]. Default: none.
        #[serde(default)]
        gradient_pa_m: [f64; 3],
    },
    /// A table of points along a direction: linear between them, constant beyond the first and the last.
    Points {
        /// The direction; its length does not matter.
        along: [f64; 3],
        /// Where distances count from [m]. Default: (0, 0, 0).
        #[serde(default)]
        at_m: [f64; 3],
        /// Distance along the direction [m], ascending, and pressure [Pa].
        rows: Vec<(f64, f64)>,
    },
    /// The least of several linear pressures: largest in the middle of a joint, none at its edges that drain, for instance.
    Least(Vec<LinearPressure>),
}

/// One of several linear pressures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct LinearPressure {
    /// Pressure at `at_m` [Pa].
    pub pressure_pa: f64,
    /// Where it is that [m]. Default: (0, 0, 0).
    #[serde(default)]
    pub at_m: [f64; 3],
    /// Its change per metre along x, y and z [Pa/m]. Default: none.
    #[serde(default)]
    pub gradient_pa_m: [f64; 3],
}

impl Pressure {
    /// The present pressure, kept when gravity, now `gravity_m_s2`, changes.
    pub fn held(&self, gravity_m_s2: [f64; 3]) -> Self {
        match *self {
            Self::Level { at_m, density_kg_m3 } => Self::Linear {
                pressure_pa: 0.0,
                at_m,
                gradient_pa_m: gravity_m_s2.map(|g| density_kg_m3 * g),
            },
            _ => self.clone(),
        }
    }
}

fn thousand() -> f64 {
    1000.0
}
