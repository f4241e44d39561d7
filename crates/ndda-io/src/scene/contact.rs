//! Contact of a scene: potential, friction, and laws of joints.

use serde::{Deserialize, Serialize};

/// Contact between blocks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
#[expect(clippy::large_enum_variant, reason = "a scene has one contact")]
pub enum Contact {
    /// Blocks do not feel each other.
    Off,
    /// A contact potential: energy of the volume that blocks share.
    Potential {
        /// Normal penalty k_n [Pa]. With `Smooth`, contact is as compliant as E L₀/(2 k_n) of rock. The error of settlements and waves is about
        /// that length relative to the block size; rebound hardly depends on it. Nor does sliding, except near the limit
        /// of friction, where blocks also slip while they sink in: a penalty ten times as large shows by how much. Default: chosen from the size of
        /// blocks, their loads and speeds so that contact is at most `depth_ratio` deep, and said with its reason. Under loads that press soft or large blocks deeper
        /// than that even where contact is as stiff as half a block, it is as stiff as that, and the reason says how deep blocks then overlap.
        #[serde(default = "super::unset", skip_serializing_if = "super::is_unset")]
        penalty_pa: f64,
        /// Depth of contact at rest over the size of small blocks, from which `penalty_pa` is chosen where it is left out. Default: 1e-4.
        #[serde(default = "depth_ratio")]
        depth_ratio: f64,
        /// The contact potential inside a block. Default: `Element`, the paper's.
        #[serde(default)]
        potential: Potential,
        /// Friction between all blocks. Default: none.
        #[serde(default)]
        friction: Option<Friction>,
        /// Coefficient of restitution e of all contacts, from 0 to 1: speed at which two blocks part after a central impact over that at which they met, whatever the
        /// penalty, where the steps resolve it; near 0 blocks that deform part faster. Below 1, what rings comes to rest; 0 counts as 0.005. Needs `contact_at: Predicted`. Default: 1, undamped.
        #[serde(default = "one")]
        restitution: f64,
        /// Coefficient of restitution along the face, from 0 to 1: speed that half an oscillation on a shear spring leaves, over that before, while the spring sticks. Needs
        /// friction with `shear_penalty_pa_m`. Default: springs are damped as contact is along its normal.
        #[serde(default)]
        shear_restitution: Option<f64>,
        /// Tolerance of friction on velocities: change of the friction of a face that does not matter, as a part of the largest μN on its blocks, from 1e-10 to
        /// 1e-2. It is an error of slips, which the next step finds anew. Piles of rigid cubes visit their faces a quarter to a half as often with 1e-4 as
        /// they do without it. `contact_at: End` has a tolerance of its own. Default: 1e-7, and more with more than 1000 faces in contact.
        #[serde(default)]
        friction_tolerance: Option<f64>,
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
    /// Hyperbolic closure after Bandis, by the same depth: flat joints have σ = k_ni V/(1 − V/V_m), V being their closure and k_ni = 2 k_n/L₀; from 0.99 V_m
    /// on along the tangent. Integrated by quadrature, which takes longer.
    Closure {
        /// L₀ [m]: k_ni is 2 penalty_pa / L₀. Default: 1.
        #[serde(default = "one_metre")]
        reference_m: f64,
        /// Largest closure V_m [m].
        max_closure_m: f64,
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

impl Potential {
    /// L₀ [m], of which joints have 2 k_n/L₀ of stiffness per area; none where their stiffness depends on the mesh or on the overlap.
    pub fn reference_m(&self) -> Option<f64> {
        match *self {
            Self::Smooth { reference_m } | Self::Closure { reference_m, .. } => Some(reference_m),
            Self::Element | Self::Volume { .. } => None,
        }
    }
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
    /// Tensile strength σ_t [Pa], until the joint opens; beyond c/tan φ it holds only without shear; needs `shear_penalty_pa_m`. Default: 0.
    #[serde(default)]
    pub tension_pa: f64,
    /// Values to which friction and cohesion fall while the joint slips, instead of cohesion that breaks at once; with the same values as the peak
    /// the joint is perfectly plastic. Needs `shear_penalty_pa_m`. Default: none.
    #[serde(default)]
    pub residual: Option<Residual>,
    /// Roughness after Barton and Bandis: shear strength σ tan(φ_r + JRC log₁₀(JCS/σ)), `friction_deg` being the residual angle φ_r, and
    /// the whole angle at most 70°. Needs `shear_penalty_pa_m`, and no cohesion, tension or `residual`. Default: none.
    #[serde(default)]
    pub roughness: Option<Roughness>,
    /// Energies that the joint takes to break, in place of bonds that break at once: tension and cohesion fall gradually, in mixed mode
    /// (δ_n/δ_nc)² + (δ_s/δ_sc)² = 1, and friction acts on what is broken. Needs `shear_penalty_pa_m`, cohesion and tension, and no `residual`, `roughness` or
    /// `dilation`. Default: none.
    #[serde(default)]
    pub fracture: Option<FractureEnergy>,
    /// How the joint opens while it slips. Needs `shear_penalty_pa_m`, the potential `Smooth` or `Closure`, `memory: Body`, and no `roughness`, which dilates by half of its
    /// own angle. Default: none.
    #[serde(default)]
    pub dilation: Option<Dilation>,
}

/// Energies that it takes to break a joint: its stress falls linearly to nothing at an opening of 2 G_I/σ_t or a slip of 2 G_II/c.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FractureEnergy {
    /// Fracture energy G_I in tension [J/m²], at least σ_t²/2k_s.
    pub tension_j_m2: f64,
    /// Fracture energy G_II in shear without normal stress [J/m²], at least c²/2k_s.
    pub shear_j_m2: f64,
}

/// Roughness of a joint after Barton and Bandis (1982).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Roughness {
    /// Joint roughness coefficient JRC [-], from 0 (smooth) to 20.
    pub jrc: f64,
    /// Compressive strength of the walls JCS [Pa].
    pub jcs_pa: f64,
    /// Length that JRC and JCS were measured on [m]. Default: 0.1.
    #[serde(default = "sample_length")]
    pub sample_m: f64,
    /// Length of the joint between its crossings with others [m]: JRC and JCS are corrected to it. Default: `sample_m`.
    #[serde(default)]
    pub length_m: Option<f64>,
    /// Whether roughness is mobilised and worn off by slip, from no strength at no slip over the peak at (L/500) (JRC/L)^0.33 to φ_r at a hundred
    /// times that; else the strength is that of the peak at any slip. Default: false.
    #[serde(default)]
    pub mobilised: bool,
    /// Whether the joint opens by half of its roughness angle while it slips; `ndda joint` tests it in any case. Needs `mobilised`, which ends it, the potential
    /// `Smooth` or `Closure`, and `memory: Body`. Default: false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub dilates: bool,
    /// Factor of the shear strength, which `ndda safety` divides. Default: 1.
    #[serde(default = "one")]
    pub strength_factor: f64,
}

/// Dilation of a joint: v = tan ψ min(|u_p|, u_zd), u_p being its slip beyond the stretch of its spring; it closes again where slip is reversed. Faces of blocks are
/// moved out by v before contact is found between them, so that blocks are pushed apart.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Dilation {
    /// Dilation angle ψ [°], at most the friction angle, also the residual one: a joint cannot give energy.
    pub psi_deg: f64,
    /// Slip u_zd at which dilation ends [m].
    pub to_slip_m: f64,
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
    /// What is left of the tensile strength where the joint has slipped and not opened [Pa]. With c/tan φ, at the peak and here, Mohr and Coulomb's line holds up to its apex, as
    /// limit equilibrium assumes. Default: 0.
    #[serde(default)]
    pub tension_pa: f64,
    /// Slip over which strength falls linearly [m]. Default: 0, at once.
    #[serde(default)]
    pub over_m: f64,
    /// How far the joint opens at its tensile strength, which it keeps until then with its cohesion, as limit equilibrium of perfectly plastic joints assumes [m]. Default: 0, a
    /// joint that opens is broken.
    #[serde(default)]
    pub opening_m: f64,
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
    /// Coefficient of restitution there. Default: that of all contacts.
    #[serde(default)]
    pub restitution: Option<f64>,
    /// Coefficient of restitution along the face there. Default: that of all contacts, or of the normal where `restitution` is given here.
    #[serde(default)]
    pub shear_restitution: Option<f64>,
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
    /// Coefficient of restitution there. Default: that of the two materials.
    #[serde(default)]
    pub restitution: Option<f64>,
    /// Coefficient of restitution along the face there; needs `restitution` beside it. Default: springs are damped as contact is along its normal.
    #[serde(default)]
    pub shear_restitution: Option<f64>,
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

fn sample_length() -> f64 {
    0.1
}

fn one() -> f64 {
    1.0
}

fn depth_ratio() -> f64 {
    1e-4
}

fn one_metre() -> f64 {
    1.0
}

fn two() -> f64 {
    2.0
}
