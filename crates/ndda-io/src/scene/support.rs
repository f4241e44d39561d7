//! Where blocks of a scene are held or moved.

use serde::{Deserialize, Serialize};

use super::Component;

/// Part of a block.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Region {
    /// All nodes of the block.
    All,
    /// The boundary nodes on a plane, to within 1e-6 of the block's size.
    Plane {
        /// A point on the plane [m].
        point_m: [f64; 3],
        /// Its normal; its length does not matter.
        normal: [f64; 3],
    },
    /// A named node set of the mesh.
    Set(String),
}

/// A part of a block that is held or moved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Support {
    /// Name of the block; in `base_*` the star stands for anything, and all such blocks with a part in the region count.
    pub block: String,
    /// Which part of it.
    pub on: Region,
    /// The constraint.
    pub hold: Hold,
    /// How it is imposed. Default: `Elimination`.
    #[serde(default)]
    pub by: By,
}

/// The constraint of a support.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Hold {
    /// All three components.
    Fixed,
    /// The component along the normal of the region's plane.
    Normal,
    /// The component along a direction.
    Direction([f64; 3]),
    /// All three components follow a displacement: zero up to the first row, linear between rows, constant after the last.
    Motion(Vec<MotionRow>),
    /// All three components follow a record of accelerations, from rest: a shaken base. Acceleration is linear between rows
    /// and zero after the last.
    Acceleration {
        /// CSV file with the columns `time_s` and `acceleration_m_s2`; its path counts from the scene file.
        file: String,
        /// Direction of the motion; its length does not matter.
        direction: [f64; 3],
        /// Factor on the accelerations. Default: 1.
        #[serde(default = "super::one")]
        factor: f64,
    },
    /// All three components follow records of accelerations, from rest, which add up: a base that is shaken along one, two or three directions.
    Shaking(Vec<Component>),
}

impl Hold {
    /// Whether it moves what it holds.
    pub fn is_moved(&self) -> bool {
        matches!(self, Self::Motion(_) | Self::Acceleration { .. } | Self::Shaking(_))
    }
}

/// One row of a prescribed motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MotionRow {
    /// Time [s].
    pub time_s: f64,
    /// Displacement since the start [m]; zero in the first row.
    pub displacement_m: [f64; 3],
}

/// How a support is imposed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum By {
    /// The unknowns are taken out of the equations.
    #[default]
    Elimination,
    /// A spring per node, as in the paper's §4.1.
    Springs {
        /// Stiffness per node [N/m]. Default: 1e6 · E · 1 m.
        #[serde(default)]
        stiffness_n_m: Option<f64>,
    },
}
