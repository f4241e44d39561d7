//! The scene: everything a run needs, as a person writes it in RON. Every quantity is SI with its unit in the key.

mod blast;
mod block;
mod bolt;
pub(crate) mod check;
mod chosen;
pub mod code;
mod contact;
pub mod diagnostic;
mod expression;
mod include;
pub mod joint_table;
mod load;
pub mod locate;
mod material;
mod monitor;
mod output;
pub mod outside_files;
pub mod override_files;
pub(crate) mod overrides;
mod parameter_values;
mod parameters;
pub(crate) mod parse;
mod pieces;
mod quiet;
pub mod read;
pub mod record;
mod reference;
mod renamed;
mod rock;
mod rock_names;
mod rockfall;
#[cfg(feature = "schema")]
pub mod schema;
mod shaking;
mod shape;
mod stage;
pub mod study;
pub mod suggest;
mod support;
mod time;
mod turning;
mod units;
mod water;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub use blast::{Blast, BlastPressure, BlastWall};
pub use block::{Block, Body, InSitu, Stress, StressGradient, Turn};
pub use bolt::{Bolt, BoltDowel, BoltGrout, BoltPlace, BoltPlate, BoltSteel};
pub use contact::{
    Contact, Dilation, FractureEnergy, Friction, JointLaw, MaterialPair, Memory, Potential, Residual,
    Roughness,
};
pub use load::{FactorRow, Force, Traction};
pub use material::{Bedding, Damping, Material};
pub use monitor::{At, Monitor};
pub use output::{Field, FieldFormat, Output, Precision, TableFormat};
pub use pieces::Pieces;
pub use quiet::{IncidentWave, Quiet, RecordedAs, Tie, WaveKind};
pub use reference::Reference;
pub use rock::{Axis, DiscRule, Discontinuity, Domain, Excavation, OrientationScatter};
pub use rock::{Rock, Slivers, SpacingScatter, Voronoi, Whereabouts};
pub use rockfall::{BoulderShape, BoulderSize, Boulders, CountingLine, Ground, GroundLaw, Release};
pub use rockfall::{ReleasePlace, Rockfall, RockfallDetail, RockfallRest, Scatter, Zone};
pub use shaking::{AccelerationUnit, Baseline, Component, Record};
pub use shape::{Fill, Grading, Pattern, Shape, Towards};
pub use stage::{Ramp, Stage, StageLaws, Then};
pub use support::{By, Hold, MotionRow, Region, Support};
pub use time::{ContactAt, Integrator, Mass, Settle, SettleDamping, Solver, Step, Time};
pub use turning::Turning;
pub use water::{LinearPressure, Pressure, Water, Wet};

/// A complete scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// One line that says what the scene shows.
    pub title: String,
    /// Numbers with a name, from which others are computed: `parameters: (dip_deg: 35)`, and `Calc(90 - dip_deg)` where a number
    /// stands. Default: none.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub parameters: BTreeMap<String, f64>,
    /// Step, end and integrator.
    pub time: Time,
    /// Acceleration of gravity [m/s²]. Default: none.
    #[serde(default)]
    pub gravity_m_s2: [f64; 3],
    /// Time over which gravity grows from nothing [s]; 0 applies it suddenly. Default: 0.
    #[serde(default)]
    pub gravity_ramp_s: f64,
    /// Stress in the ground before anything moves, for blocks that have no `initial_stress_pa` and can deform. Default: none.
    #[serde(default)]
    pub in_situ: Option<InSitu>,
    /// Brings the scene to rest before time begins. Default: it begins as it is written.
    #[serde(default)]
    pub settle: Option<Settle>,
    /// Files with more materials; their paths count from the scene, and one alone needs no brackets. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub include: Vec<String>,
    /// Materials, referred to by name. Must be written unless there is `include`.
    #[cfg_attr(feature = "schema", schemars(default))]
    pub materials: Vec<Material>,
    /// Blocks, in the order of the output. Default: none.
    #[serde(default)]
    pub blocks: Vec<Block>,
    /// Rock that is cut into more blocks, which come after `blocks`. Default: none.
    #[serde(default)]
    pub rock: Vec<Rock>,
    /// Where blocks are held or moved. Default: nowhere.
    #[serde(default)]
    pub supports: Vec<Support>,
    /// Surface tractions. Default: none.
    #[serde(default)]
    pub tractions: Vec<Traction>,
    /// Pressure of water in joints and on faces. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub water: Vec<Water>,
    /// Faces behind which rock goes on, and waves that arrive through them. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub quiet: Vec<Quiet>,
    /// Nodes of equal height that move alike, as at the sides of level ground. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ties: Vec<Tie>,
    /// Pressure of explosions on the walls of holes. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub blasts: Vec<Blast>,
    /// Rock bolts and anchors. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bolts: Vec<Bolt>,
    /// Forces on points of blocks. Default: none.
    #[serde(default)]
    pub forces: Vec<Force>,
    /// Contact between blocks. Must be said when there is more than one block.
    #[serde(default)]
    pub contact: Option<Contact>,
    /// Stages of construction, one after the other from `time.end_s` on. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stages: Vec<Stage>,
    /// Boulders that fall over terrain, one by one, in the place of blocks and rock; `ndda rockfall` runs them. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rockfall: Option<Rockfall>,
    /// Points whose motion is recorded. Default: none.
    #[serde(default)]
    pub monitors: Vec<Monitor>,
    /// The output: which files, which fields, how often.
    #[serde(default)]
    pub output: Output,
    /// The closed form that the result is compared with. Default: none.
    #[serde(default)]
    pub reference: Option<Reference>,
}

/// Whether a name is that of a pattern, in which `*` stands for anything.
pub fn matches(pattern: &str, name: &str) -> bool {
    let Some((head, tail)) = pattern.split_once('*') else { return pattern == name };
    let Some(rest) = name.strip_prefix(head) else { return false };
    rest.char_indices().map(|(i, _)| i).chain([rest.len()]).any(|i| matches(tail, &rest[i..]))
}

/// The value of a field that is left out, and chosen before a run.
fn unset() -> f64 {
    f64::NAN
}

/// Whether a field is left out.
pub fn is_unset(value: &f64) -> bool {
    value.is_nan()
}

fn one() -> f64 {
    1.0
}
