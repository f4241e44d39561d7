//! Blocks that moved, and where they are at the end.

use serde::{Deserialize, Serialize};

/// State of a monitor at the end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MonitorEnd {
    /// Displacement since the start \[m\].
    pub displacement: [f64; 3],
    /// Velocity [m/s].
    pub velocity: [f64; 3],
}

/// Motion of the blocks in a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// Blocks that are not fixed.
    pub can_move: usize,
    /// Blocks of which a point has gone, by the end, farther than 1 % of the distance from their mass centre to their farthest node.
    pub moved: usize,
    /// The block of which a point has gone farthest.
    pub farthest: String,
    /// How far that was at the end \[m\].
    pub farthest_m: f64,
    /// Speed of its mass centre at the end [m/s].
    pub speed_m_s: f64,
    /// Whether it moves at the end.
    pub course: Course,
    /// Blocks that fall freely below all others at the end, so that nothing is left on which they could land.
    #[serde(default)]
    pub fallen_out: Vec<String>,
}

/// How a block moves at the end of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Course {
    /// At less than 1 % of its largest speed.
    #[default]
    AtRest,
    /// More slowly than it did.
    Moving,
    /// At its largest speed.
    Accelerating,
}

/// How far a block has gone at the end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BlockMotion {
    /// Displacement of its mass centre since the start \[m\].
    pub displacement_m: [f64; 3],
    /// How far its farthest node has gone \[m\].
    pub farthest_m: f64,
    /// The largest of that in the rows of the history \[m\].
    pub largest_m: f64,
    /// Angle by which it has turned, from 0 to 180 \[°\].
    pub rotation_deg: f64,
}

/// State of a block at the end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BlockEnd {
    /// How far it has gone.
    #[serde(flatten)]
    pub motion: BlockMotion,
    /// Mass \[kg\].
    pub mass: f64,
    /// Mass-mean velocity [m/s].
    pub velocity: [f64; 3],
    /// Linear momentum [kg m/s].
    pub momentum: [f64; 3],
    /// Angular momentum about the origin of the scene's coordinates [kg m²/s].
    pub angular_momentum: [f64; 3],
    /// Volume over volume at rest.
    pub volume_ratio: f64,
}
