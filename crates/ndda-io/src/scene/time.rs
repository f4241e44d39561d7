//! Time of a scene: the step, the integrator, and what is solved how.

use serde::{Deserialize, Serialize};

/// Time stepping.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// Time step Δt [s]. Default: chosen from the stability of contact, speeds and loads, and said with its reason.
    #[serde(default = "super::unset", skip_serializing_if = "super::is_unset")]
    pub step_s: f64,
    /// End of the run, or of what comes before the first of `stages` [s]; rounded to a whole number of steps.
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
    /// Speed left over the largest speed on the way, and with `Adaptive` and `Local` damping unbalanced forces over loads, or over the largest unbalanced forces on the way where loads cancel or there are none [-]. Default: 1e-4.
    pub tolerance: f64,
    /// Steps after which it is given up. Default: 1000000.
    pub most_steps: u64,
    /// Damping on the way to rest. Default: `Adaptive` where blocks deform; `Kinetic` where none does, where friction acts on velocities, and where contact is taken at the end of the step.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping: Option<SettleDamping>,
    /// Whether blocks have the inertia on the way to rest with which their contacts make all of them oscillate as fast as the step allows (weights stay as they
    /// are). Rest is reached in fewer steps, and as many whatever the step; where friction leaves several equilibria, another one may be found. Default: true, but for
    /// contact at the end of the step and for `ndda safety`, which take true masses, as rigid blocks do in `then: Settle()` of stages.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_scaling: Option<bool>,
}

impl Default for Settle {
    fn default() -> Self {
        Self { tolerance: 1e-4, most_steps: 1_000_000, damping: None, mass_scaling: None }
    }
}

/// Damping on the way to rest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum SettleDamping {
    /// All blocks are stopped whenever the kinetic energy of the scene begins to fall (Cundall 1976; Barnes 1999).
    Kinetic,
    /// All velocities are damped in proportion, critically for the slowest oscillation that is left (adaptive dynamic relaxation, Underwood 1983).
    Adaptive,
    /// Each block loses a part of what a step has changed its velocity by, in proportion to its unbalanced force (Cundall 1987).
    Local {
        /// The part, above 0 and at most 1 [-]. Default: 0.8.
        #[serde(default = "local_factor")]
        factor: f64,
    },
}

fn local_factor() -> f64 {
    0.8
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

/// Whether steps may be shorter. A step that violates a limit is discarded, contact history included, and repeated
/// again in more parts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub enum Step {
    /// All are `step_s`.
    #[default]
    Fixed,
    /// Each is done in as many parts, 1, 2, 4, …, as contact, speed and energy require.
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
    /// At the positions that the integrator predicts; a step must be short: ω_c Δt < 2.
    #[default]
    Predicted,
    /// At the end of the step, solved for: stable for any step, and damps what a step does not resolve.
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
        /// Spectral radius: the part of the highest modes that remains after a step, 0 to 1 (no damping). Default: 0.8.
        #[serde(default = "radius")]
        radius: f64,
    },
    /// The paper's eqs (7)–(13); contact at the positions of the previous step.
    Newmark {
        /// The paper's α (β elsewhere). Default: 0.5.
        #[serde(default = "half")]
        alpha: f64,
        /// The paper's δ (γ elsewhere). Default: 1.0.
        #[serde(default = "super::one")]
        delta: f64,
    },
}

impl Default for Integrator {
    fn default() -> Self {
        Self::Midpoint { theta: half() }
    }
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

fn fine() -> f64 {
    1e-12
}
