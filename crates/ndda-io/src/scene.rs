//! The scene: everything a run needs, as a person writes it in RON. Every quantity is SI with its unit in the key.

pub mod check;
pub mod code;
pub mod diagnostic;
pub mod locate;
mod output;
pub mod outside_files;
pub mod overrides;
pub mod read;
pub mod record;
mod rock;
#[cfg(feature = "schema")]
pub mod schema;
mod shape;
pub mod study;
mod suggest;
pub mod units;

use serde::{Deserialize, Serialize};

pub use output::{Field, FieldFormat, Output, Precision, TableFormat};
pub use rock::{Axis, DiscRule, Discontinuity, Domain, OrientationScatter};
pub use rock::{Rock, SpacingScatter, Voronoi, Whereabouts};
pub use shape::{Fill, Grading, Pattern, Shape, Towards};

/// A complete scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// One line that says what the scene shows.
    pub title: String,
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
    /// Materials, referred to by name.
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
    /// Forces on points of blocks. Default: none.
    #[serde(default)]
    pub forces: Vec<Force>,
    /// Contact between blocks. Must be said when there is more than one block.
    #[serde(default)]
    pub contact: Option<Contact>,
    /// Points whose motion is recorded. Default: none.
    #[serde(default)]
    pub monitors: Vec<Monitor>,
    /// What is written and how often.
    #[serde(default)]
    pub output: Output,
    /// The closed form that the result is compared with. Default: none.
    #[serde(default)]
    pub reference: Option<Reference>,
}

/// Time stepping.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// Time step Δt [s].
    pub step_s: f64,
    /// End of the run [s]; rounded to a whole number of steps.
    pub end_s: f64,
    /// Time integrator. Default: `Midpoint(theta: 0.5)`.
    #[serde(default)]
    pub integrator: Integrator,
    /// Whether steps may be shorter than `step_s`. Default: `Fixed`.
    #[serde(default)]
    pub step: Step,
    /// Where in a step contact is taken. Default: `Predicted`.
    #[serde(default)]
    pub contact_at: ContactAt,
    /// How mass is shared among the nodes of an element. Default: `Consistent`.
    #[serde(default)]
    pub mass: Mass,
    /// How a block's equations are solved. Default: `Cholesky`.
    #[serde(default)]
    pub solver: Solver,
}

/// A phase before time begins: loads, initial stress and contact are brought to equilibrium, then displacements are set
/// to zero; initial velocities come after it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Settle {
    /// Speed left over the largest speed on the way [-]. Default: 1e-4.
    pub tolerance: f64,
    /// Steps after which it is given up. Default: 1000000.
    pub most_steps: u64,
}

impl Default for Settle {
    fn default() -> Self {
        Self { tolerance: 1e-4, most_steps: 1_000_000 }
    }
}

/// How a block's equations are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Solver {
    /// Factored once (up to 100 unknowns inverted): quickest while the factor fits in memory.
    #[default]
    Cholesky,
    /// Iterated anew in every step: little memory, for blocks too large to factor.
    ConjugateGradients {
        /// Residual over right-hand side at which to stop [-]. Default: 1e-12.
        #[serde(default = "fine")]
        tolerance: f64,
    },
}

/// Whether steps may be shorter. A step that asks for too much is taken back whole, contact's memory included, and done
/// again in more parts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Step {
    /// All are `step_s`.
    #[default]
    Fixed,
    /// Each is done in as many parts, 1, 2, 4, …, as contact, speed and energy ask for.
    Auto {
        /// Part of the integrator's bound on ω_c Δt that may be used. Default: 0.5.
        #[serde(default = "half")]
        safety: f64,
        /// Energy that a step may gain, over the largest energy so far. Default: 1e-4.
        #[serde(default = "step_energy")]
        energy: f64,
        /// Halvings beyond which a run stops. Default: 12.
        #[serde(default = "halvings")]
        most_halvings: u32,
    },
}

/// Where in a step contact is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum ContactAt {
    /// Where the integrator predicts blocks to be; a step must be short: ω_c Δt < 2.
    #[default]
    Predicted,
    /// Where blocks are at the end, solved for: stable for any step, and damps what a step does not resolve.
    End {
        /// Largest misfit of contact forces over the largest of contact forces and loads. Default: 1e-8.
        #[serde(default = "newton_tolerance")]
        tolerance: f64,
        /// Evaluations of contact after which a run stops. Default: 100.
        #[serde(default = "newton_iterations")]
        most_iterations: u32,
    },
}

/// How mass is shared among nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Mass {
    /// By the shape functions: the most accurate.
    #[default]
    Consistent,
    /// A quarter of an element to each of its nodes, in elastic blocks: waves a little slower, no overshoot beside a loaded node. Their inertia
    /// of rotation is too large: 3.5 times the true one in a cube of six tetrahedra, 1.16 times in one of 4³ cells; `ndda check` tells by how much.
    Lumped,
}

/// Choice of time integrator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Integrator {
    /// Second order; elasticity weighted by θ, contact at x + ½ Δt v.
    Midpoint {
        /// Weight θ of the end of the step, ½ (no damping) to 1. Default: 0.5.
        #[serde(default = "half")]
        theta: f64,
    },
    /// Second order; damps elastic modes far above 1/Δt, contact neither way.
    GeneralizedAlpha {
        /// What is left of the highest modes after a step, 0 to 1 (no damping). Default: 0.8.
        #[serde(default = "radius")]
        radius: f64,
    },
    /// The paper's eqs (7)–(13); contact at the positions of the previous step.
    Newmark {
        /// The paper's α (β elsewhere). Default: 0.5.
        #[serde(default = "half")]
        alpha: f64,
        /// The paper's δ (γ elsewhere). Default: 1.0.
        #[serde(default = "one")]
        delta: f64,
    },
}

impl Default for Integrator {
    fn default() -> Self {
        Self::Midpoint { theta: half() }
    }
}

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

/// What a bedded rock is across its beds (transverse isotropy).
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
    /// Stays where it is, or goes where one support with a `Motion` or an `Acceleration` takes it as a whole; no unknowns.
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
    /// Where the shape's origin is placed [m]. Default: (0, 0, 0).
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
    /// What is held.
    pub hold: Hold,
    /// How it is imposed. Default: `Elimination`.
    #[serde(default)]
    pub by: By,
}

/// What a support holds.
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
        #[serde(default = "one")]
        factor: f64,
    },
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

/// A traction on part of a block's surface, constant in direction, per area at rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Traction {
    /// Name of the block, or of many as in `supports`.
    pub block: String,
    /// Which part of its surface: triangles whose three nodes are all in the region.
    pub on: Region,
    /// Traction [Pa].
    pub traction_pa: [f64; 3],
    /// Factor over time, linear between rows and constant outside. Default: 1.
    #[serde(default)]
    pub factor: Vec<FactorRow>,
}

/// A force on a block, constant in direction: on the node nearest to a point, or through the mass centre.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Force {
    /// Name of the block, or of many as in a support; each takes the whole force.
    pub block: String,
    /// The point [m]; of many blocks, those that have it take the force. Default: through the mass centre, shared among
    /// all nodes by volume.
    #[serde(default)]
    pub at_m: Option<[f64; 3]>,
    /// Force [N].
    pub force_n: [f64; 3],
    /// Factor over time, linear between rows and constant outside. Default: 1.
    #[serde(default)]
    pub factor: Vec<FactorRow>,
}

/// One row of a load's factor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FactorRow {
    /// Time [s].
    pub time_s: f64,
    /// Factor [-].
    pub factor: f64,
}

/// Contact between blocks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Contact {
    /// Blocks do not feel each other.
    Off,
    /// A contact potential: energy of the volume that blocks share.
    Potential {
        /// Normal penalty k_n [Pa]. Contact gives way as E L₀/2k_n of rock does with `Smooth`; settlements and waves are
        /// wrong by that over the size of the blocks, slides and rebounds hardly.
        penalty_pa: f64,
        /// What the potential is inside a block. Default: `Element`, the paper's.
        #[serde(default)]
        potential: Potential,
        /// Friction between all blocks. Default: none.
        #[serde(default)]
        friction: Option<Friction>,
        /// Friction between blocks of two materials, in place of `friction`; a later entry counts more. Default: none.
        #[serde(default)]
        joints: Vec<Joint>,
        /// Friction on the faces of joints that cut rock, in place of all other; a later entry counts more. Default: none.
        #[serde(default)]
        laws: Vec<JointLaw>,
        /// What a friction force is remembered with. Default: `Body`.
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
    /// What friction and cohesion fall to while the joint slips, instead of cohesion that breaks at once; with the same values as the peak
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
pub struct Joint {
    /// Names of the two materials, or of one twice.
    pub between: (String, String),
    /// Friction there. Default: none.
    #[serde(default)]
    pub friction: Option<Friction>,
}

/// Friction on the faces that a named joint made.
///
/// Each side of a contact rubs by the law of its own face: that of the joint, if it has one here, else that of the two
/// materials. Where faces of different joints meet, each law acts on the pressure that its side bears, about half.
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

/// What a friction force is remembered with.
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

/// A point whose motion is recorded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Monitor {
    /// Name, unique in the scene.
    pub name: String,
    /// Name of the block; with `Largest`, of many blocks as in `supports`.
    pub block: String,
    /// Where on the block. Default: `Centre`.
    #[serde(default)]
    pub at: At,
}

/// A place on a block.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum At {
    /// The mass centre.
    #[default]
    Centre,
    /// The material point that is here at the start [m].
    Point([f64; 3]),
    /// Whichever node has moved farthest in a direction: another one at any time.
    Largest([f64; 3]),
}

/// Whether a name is that of a pattern, in which `*` stands for anything.
pub fn matches(pattern: &str, name: &str) -> bool {
    let Some((head, tail)) = pattern.split_once('*') else { return pattern == name };
    let Some(rest) = name.strip_prefix(head) else { return false };
    rest.char_indices().map(|(i, _)| i).chain([rest.len()]).any(|i| matches(tail, &rest[i..]))
}

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

fn step_energy() -> f64 {
    1e-4
}

fn halvings() -> u32 {
    12
}

fn newton_tolerance() -> f64 {
    1e-8
}

fn newton_iterations() -> u32 {
    100
}

fn radius() -> f64 {
    0.8
}

fn half() -> f64 {
    0.5
}

fn one() -> f64 {
    1.0
}

fn fine() -> f64 {
    1e-12
}
