//! Quiet boundaries and the waves that arrive through them.

use serde::{Deserialize, Serialize};

use super::{Record, Region};

/// Faces behind which rock goes on for ever: waves leave through them, and may arrive through them (Lysmer & Kuhlemeyer 1969).
///
/// They bear −ρ c_p v_n − ρ c_s v_s beside what holds the rock up when time begins: while the scene settles they rest on springs of ρ c/2Δt per area, and
/// what these, or an initial stress, bear then stays as a constant force. Only elastic blocks have such faces.
///
/// ```text
/// quiet: [
///     // Rock goes on below; an S wave comes up, from a record on outcropping rock.
///     (block: "ground", on: Set("z_min"), incident: [(wave: S((1, 0, 0)), motion: Outcrop, record: (file: "quake.at2"))]),
///     // A side beyond which the ground is level, of 6 m of clay on rock: it moves as that ground does, far away.
///     (block: "*", on: Set("x_min"), layers: [(material: "clay", top_m: (0, 0, 20)), (material: "rock", top_m: (0, 0, 14))],
///      incident: [(wave: S((1, 0, 0)), motion: Outcrop, record: (file: "quake.at2"), from_m: (0, 0, 0))]),
/// ],
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Quiet {
    /// Name of the block; in `base_*` the star stands for anything, and all such blocks with faces in the region count.
    pub block: String,
    /// Its faces: boundary triangles of which all corners are in the region.
    pub on: Region,
    /// Material of the rock beyond the faces. Default: that of the block.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beyond: Option<String>,
    /// Layers of level ground beyond the faces, whose uppermost border is the ground; the lowest goes on below. Waves go straight up and down in them, are
    /// reflected at their borders and by the ground, and so move the faces as the ground far away moves. Each face is beside the layer that its middle
    /// is in. In the place of `beyond`, and of `along` and `ground_m` of the waves. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<GroundLayer>,
    /// Plane waves that arrive from beyond. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub incident: Vec<IncidentWave>,
}

/// A layer of level ground.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct GroundLayer {
    /// Its material.
    pub material: String,
    /// A place on its upper border [m]; only its height counts.
    pub top_m: [f64; 3],
}

/// A plane wave that arrives from beyond quiet faces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct IncidentWave {
    /// Its kind.
    pub wave: WaveKind,
    /// Its motion over time.
    pub record: Record,
    /// Where the record was measured. Default: `Upgoing`.
    #[serde(default)]
    pub motion: RecordedAs,
    /// Direction in which it travels; its length does not matter. Default: against gravity, (0, 0, 1) without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub along: Option<[f64; 3]>,
    /// A place that it passes at the times of the record [m]. Default: the node of these faces that it meets first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from_m: Option<[f64; 3]>,
    /// A place on level ground, across the way of the wave, that sends it back [m]: its echo arrives at these faces, too. For faces at the
    /// sides of uniform ground, which then move as the ground far away does, and for a record `Within`. Default: no echo.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ground_m: Option<[f64; 3]>,
}

/// The kind of a plane wave.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum WaveKind {
    /// It moves the rock along its way.
    P,
    /// It moves the rock along this direction, across its way.
    S([f64; 3]),
}

/// Where the motion of a record was measured, or what was computed from it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum RecordedAs {
    /// The wave that arrives.
    #[default]
    Upgoing,
    /// Rock that crops out, which moves twice as much as the wave that arrives.
    Outcrop,
    /// Rock at `from_m` below level ground at `ground_m`: the wave that arrives and its echo. The echo is taken out exactly for uniform ground without
    /// damping, so that the record must not hold the frequencies at which such a place stands still.
    Within,
}

/// Nodes at equal height that move alike: the sides of level ground, which are those of ground that goes on as it is.
///
/// The nodes of all regions at the same place along a direction are one group. Between blocks nothing can be tied.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Tie {
    /// Name of the block, which must be elastic; in `base_*` the star stands for anything, and all such blocks with nodes in the regions count, each by
    /// itself.
    pub block: String,
    /// Regions of which all nodes of one height move alike, such as both sides: `[Set("x_min"), Set("x_max")]`.
    pub on: Vec<Region>,
    /// Direction of the height; its length does not matter. Default: against gravity, (0, 0, 1) without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub along: Option<[f64; 3]>,
}
