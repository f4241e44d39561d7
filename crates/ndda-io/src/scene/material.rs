//! Materials of a scene.

use serde::{Deserialize, Serialize};

/// Linear elastic rock, isotropic or bedded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Name that blocks refer to.
    pub name: String,
    /// Young's modulus E [Pa].
    pub young_pa: f64,
    /// Poisson's ratio ν [-].
    pub poisson: f64,
    /// Density ρ [kg/m³].
    pub density_kg_m3: f64,
    /// Beds, across which it is another rock than `young_pa` and `poisson` say. Default: none.
    #[serde(default)]
    pub bedding: Option<Bedding>,
    /// Rayleigh damping. Default: none.
    #[serde(default)]
    pub damping: Damping,
}

/// Rayleigh damping: a mode of frequency ω [rad/s] is damped by a/2ω + b ω/2 of critical.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Damping {
    /// a [1/s], on mass: drags on every motion, that of a block as a whole, too. Default: 0.
    pub mass_per_s: f64,
    /// b [s], on stiffness: resists deformation. Default: 0.
    pub stiffness_s: f64,
}

/// Moduli of a bedded rock across its beds (transverse isotropy).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Bedding {
    /// Normal of the beds in the scene's axes, whatever turns a block has; its length does not matter.
    pub normal: [f64; 3],
    /// Young's modulus E′ across the beds [Pa].
    pub young_across_pa: f64,
    /// Poisson's ratio ν′ [-]: strain along the beds over that across, under a stress across.
    pub poisson_across: f64,
    /// Shear modulus G′ across the beds [Pa].
    pub shear_across_pa: f64,
}
