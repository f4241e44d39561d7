//! Contact of a scene: potential, friction, and laws of joints.

use serde::{Deserialize, Serialize};

/// Contact between blocks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Contact {
    /// Blocks do not feel each other.
    Off,
    /// A contact potential: energy of the volume that blocks share.
    Potential {
        /// Normal penalty k_n [Pa]. With `Smooth`, contact is as compliant as E L₀/(2 k_n) of rock. The error of settlements and waves is about
        /// that length relative to the block size; sliding and rebound are almost unaffected.
        penalty_pa: f64,
        /// The contact potential inside a block. Default: `Element`, the paper's.
        #[serde(default)]
        potential: Potential,
        /// Friction between all blocks. Default: none.
        #[serde(default)]
        friction: Option<Friction>,
        /// Friction between blocks of two materials, in place of `friction`; a later entry counts more. Default: none.
        #[serde(default)]
        material_pairs: Vec<MaterialPair>,
        /// Friction on the faces of joints that cut rock, in place of all other; a later entry counts more. Default: none.
        #[serde(default)]
        rock_joints: Vec<JointLaw>,
        /// The owner of friction history. Default: `Body`.
        #[serde(default)]
        memory: Memory,
    },
}

/// The potential φ inside a block; the pressure is k_n φ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Potential {
    /// The paper's: 4 min λᵢ in every tetrahedron. Its stiffness depends on the mesh.
    #[default]
    Element,
    /// Depth below the block's nearest face: stiffness k_n / L₀ per area whatever the mesh.
    Smooth {
        /// L₀ [m]: the pressure is k_n at this depth. Default: 1.
        #[serde(default = "one_metre")]
        reference_m: f64,
    },
    /// One pressure for the whole patch, k_n (V/V₀)^(m − 1), from the volume V that two blocks share.
    Volume {
        /// m, above 1. Default: 2.
        #[serde(default = "two")]
        exponent: f64,
        /// V₀ [m³].
        reference_m3: f64,
    },
}

/// Friction of a joint. Without `shear_penalty_pa_m` it acts on velocities: at once when blocks slide, and without any
/// displacement while they stick. With it, shear is a spring (the paper's eqs (17)–(19)), and may hold together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Friction angle φ [°]; μ = tan φ.
    pub friction_deg: f64,
    /// Shear penalty k_s [Pa/m]; the paper's "0.1 E" is 0.1 · E / 1 m. Default: no spring.
    #[serde(default)]
    pub shear_penalty_pa_m: Option<f64>,
    /// Cohesion c [Pa]: shear strength max(0, c + σ tan φ), compression positive, until it breaks for good; needs `shear_penalty_pa_m`. Default: 0.
    #[serde(default)]
    pub cohesion_pa: f64,
    /// Tensile strength σ_t [Pa], until it breaks for good; beyond c/tan φ it holds only without shear; needs `shear_penalty_pa_m`. Default: 0.
    #[serde(default)]
    pub tension_pa: f64,
    /// Values to which friction and cohesion fall while the joint slips, instead of cohesion that breaks at once; with the same values as the peak
    /// the joint is perfectly plastic. Needs `shear_penalty_pa_m`, and no tension. Default: none.
    #[serde(default)]
    pub residual: Option<Residual>,
}

/// Strength of a joint that has slipped.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Residual {
    /// Residual friction angle φ_r [°].
    pub friction_deg: f64,
    /// Residual cohesion c_r [Pa]. Default: 0.
    #[serde(default)]
    pub cohesion_pa: f64,
    /// Slip over which strength falls linearly [m]. Default: 0, at once.
    #[serde(default)]
    pub over_m: f64,
}

/// Friction between two materials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MaterialPair {
    /// Names of the two materials, or of one twice.
    pub between: (String, String),
    /// Friction there. Default: none.
    #[serde(default)]
    pub friction: Option<Friction>,
}

/// Friction on the faces that a named joint made.
///
/// Friction on each side of a contact follows the law of its own face: that of the joint, if it has one here, else that of the two
/// materials. Where faces of different joints meet, each law acts on the pressure that its side carries, about half.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct JointLaw {
    /// Name of the joint in `rock`, or of many as in a support; `cells` is that between Voronoi cells.
    pub joint: String,
    /// Friction there. Default: none.
    #[serde(default)]
    pub friction: Option<Friction>,
}

/// The owner of friction history.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Memory {
    /// The facet and the block that it touches.
    #[default]
    Body,
    /// The facet and the element that it touches, as in the paper: lost on every element border.
    Element,
}

fn one_metre() -> f64 {
    1.0
}

fn two() -> f64 {
    2.0
}
