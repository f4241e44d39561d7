//! Closed forms that a run is compared with.

use serde::{Deserialize, Serialize};

/// A closed form that the run is compared with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Reference {
    /// Rigid block on a ramp, the paper's eq (20): S = ½ (sin α − tan φ cos α) g t².
    SlidingBlock {
        /// Monitor on the block.
        monitor: String,
        /// Direction down the slope; its length does not matter.
        downhill: [f64; 3],
        /// Slope angle α [°].
        slope_deg: f64,
        /// Friction angle φ [°]. Default: 0.
        #[serde(default)]
        friction_deg: f64,
        /// Thickness of the block normal to the slope [m]; adds the closed form of the shear spring's stick
        /// stage to the report. Default: none.
        #[serde(default)]
        thickness_m: Option<f64>,
        /// `error_max` is taken from here on [s].
        after_s: f64,
    },
    /// Two blocks that meet once, centrally and elastically: final velocities from momentum and energy.
    Collision {
        /// The block that moves at the start.
        first: String,
        /// The block that it hits.
        second: String,
        /// Line of motion; its length does not matter.
        along: [f64; 3],
        /// `error_max` is taken from here on, after the blocks have parted [s].
        after_s: f64,
    },
    /// Free flight of a point under gravity: x = x₀ + v₀ t + ½ g t².
    FreeFall {
        /// Monitor on the block.
        monitor: String,
        /// `error_max` is taken from here on [s].
        after_s: f64,
    },
    /// Torque-free rotation: the angular momentum of the block stays what it was.
    FreeSpin {
        /// The block.
        block: String,
    },
    /// An elastic bar without lateral strain (ν = 0) that flies along its axis, hits a rigid wall and rebounds (Doyen, Ern
    /// & Piperno 2011): its mean velocity turns from v₀ to −v₀ in 2 L/c, at a constant rate.
    BarImpact {
        /// The bar.
        block: String,
        /// Its axis; its length does not matter.
        along: [f64; 3],
        /// Its length L [m].
        length_m: f64,
        /// Its way to the wall [m]. Default: 0.
        #[serde(default)]
        gap_m: f64,
        /// `error_max` is taken from here on [s].
        after_s: f64,
    },
    /// A displacement that is known, that of a structure at rest under its load for instance.
    Displacement {
        /// The monitor.
        monitor: String,
        /// Its displacement [m].
        displacement_m: [f64; 3],
        /// `error_max` is taken from here on, when all has come to rest [s].
        after_s: f64,
    },
}
