//! Blocks of a scene, and the stress that they begin with.

use serde::{Deserialize, Serialize};

use super::shape::Shape;

/// How a block may move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Body {
    /// Deforms as its mesh lets it.
    #[default]
    Elastic,
    /// Deforms uniformly, 12 unknowns: the first-order block of classic DDA.
    Affine,
    /// Does not deform, 6 unknowns; cannot be held in parts.
    Rigid,
    /// Stays where it is, or goes where one support with a `Motion`, an `Acceleration` or a `Shaking` takes it as a whole; no unknowns.
    Fixed,
}

/// One block of rock.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// Name, unique in the scene.
    pub name: String,
    /// Name of its material.
    pub material: String,
    /// Its shape and mesh.
    pub shape: Shape,
    /// How it may move. Default: `Elastic`.
    #[serde(default)]
    pub body: Body,
    /// Turns applied one after the other about the shape's own origin, before `at_m`. Default: none.
    #[serde(default)]
    pub turns: Vec<Turn>,
    /// Position of the shape's origin [m]. Default: (0, 0, 0).
    #[serde(default)]
    pub at_m: [f64; 3],
    /// Initial velocity of the mass centre [m/s]. Default: at rest.
    #[serde(default)]
    pub velocity_m_s: [f64; 3],
    /// Initial rate of rotation about the mass centre [rad/s]. Default: none.
    #[serde(default)]
    pub spin_rad_s: [f64; 3],
    /// Uniform initial stress σ₀ [Pa], tension positive. Default: none.
    #[serde(default)]
    pub initial_stress_pa: Option<Stress>,
}

/// A turn about an axis through the origin of the shape.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Turn {
    /// Direction of the axis; its length does not matter.
    pub axis: [f64; 3],
    /// Angle, right-handed [°].
    pub angle_deg: f64,
}

/// A stress that changes linearly over the scene, σ₀ = σ + Σ g (n·(x − at)).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct InSitu {
    /// The stress at `at_m` [Pa], tension positive.
    pub stress_pa: Stress,
    /// Where it is that [m]. Default: (0, 0, 0).
    #[serde(default)]
    pub at_m: [f64; 3],
    /// How it changes along directions; several add up. Default: not at all.
    #[serde(default)]
    pub gradients: Vec<StressGradient>,
}

/// A change of stress along a direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct StressGradient {
    /// The direction; its length does not matter.
    pub along: [f64; 3],
    /// Change per metre along it [Pa/m].
    pub stress_pa_m: Stress,
}

/// A symmetric stress [Pa], tension positive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Stress {
    /// σ_xx [Pa]. Default: 0.
    #[serde(default)]
    pub xx: f64,
    /// σ_yy [Pa]. Default: 0.
    #[serde(default)]
    pub yy: f64,
    /// σ_zz [Pa]. Default: 0.
    #[serde(default)]
    pub zz: f64,
    /// σ_xy [Pa]. Default: 0.
    #[serde(default)]
    pub xy: f64,
    /// σ_yz [Pa]. Default: 0.
    #[serde(default)]
    pub yz: f64,
    /// σ_zx [Pa]. Default: 0.
    #[serde(default)]
    pub zx: f64,
}
