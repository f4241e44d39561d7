//! Pressure of explosions on the walls of holes.

use serde::{Deserialize, Serialize};

use super::Region;

/// Pressure of an explosion on faces, along their inward normals as they are at any time.
///
/// ```text
/// blasts: [
///     (block: "bench_*", on: Hole(from_m: (0, 3, 0), to_m: (0, 3, 8), within_m: 0.2),
///      pressure: Duvall(peak_pa: Megapascal(200), alpha_per_s: 1200, beta_per_s: 12000), start_s: 0.025),
/// ],
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Blast {
    /// Name of the block; in `bench_*` the star stands for anything, and all such blocks with faces there count.
    pub block: String,
    /// Which faces.
    pub on: BlastWall,
    /// Pressure over the time since the detonation.
    pub pressure: BlastPressure,
    /// When it detonates [s]. Default: 0.
    #[serde(default)]
    pub start_s: f64,
}

/// Faces that an explosion presses on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum BlastWall {
    /// Boundary triangles of which all corners are in a region.
    Part(Region),
    /// The charged part of a hole: boundary triangles of which all corners are near its axis, and not beyond its ends by more than 1 % of that distance.
    Hole {
        /// One end of the charge [m].
        from_m: [f64; 3],
        /// Its other end [m].
        to_m: [f64; 3],
        /// Largest distance of a corner from the axis [m]: a little more than the radius of the meshed hole.
        within_m: f64,
    },
}

/// A pressure over time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum BlastPressure {
    /// (time [s], pressure [Pa]), linear between rows, and nothing before the first and after the last.
    Rows(Vec<(f64, f64)>),
    /// p₀ ξ (exp(−α t) − exp(−β t)) with ξ such that p₀ is the peak (Duvall 1953), which comes after ln(β/α)/(β − α).
    Duvall {
        /// p₀ [Pa].
        peak_pa: f64,
        /// α, which says how fast it falls [1/s].
        alpha_per_s: f64,
        /// β, which says how fast it rises, above α [1/s].
        beta_per_s: f64,
    },
}
