//! Why a run stops.

use crate::bolts::error::BoltError;
use crate::linear::linear_solver::SolveError;
use ndda_contact::ContactError;
use ndda_fem::quiet::NoWave;
use ndda_fem::{FrameError, SupportError};
use ndda_mesh::{TetId, TriangleId};
use ndda_ranks::RanksError;

use crate::linear::linear_solver::FactorError;

/// Why a run stops.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    /// Contact could not be computed.
    #[error("at t = {} s: {source}", shown_time_s(*time_s))]
    Contact {
        /// Time [s].
        time_s: f64,
        /// The cause.
        source: ContactError,
    },
    /// The limits are violated however short the step.
    #[error(
        "at t = {} s: contact is too stiff or too fast even for steps of {step_s:e} s: reduce penalty_pa, use \
         a coarser mesh, or raise most_halvings", shown_time_s(*time_s)
    )]
    NoStepIsShortEnough {
        /// Time [s].
        time_s: f64,
        /// Δt [s].
        step_s: f64,
    },
    /// The equations of a shorter step cannot be factored.
    #[error("for steps of {step_s:e} s: {source}")]
    Factor {
        /// Δt [s].
        step_s: f64,
        /// The problem.
        source: FactorError,
    },
    /// Newton's method did not find the contact forces at the end of a step.
    #[error(
        "at t = {} s: contact at the end of the step did not converge in {iterations} evaluations \
         (residual {residual:e}): reduce step_s, or raise the tolerance", shown_time_s(*time_s)
    )]
    ContactNotSolved {
        /// Time [s].
        time_s: f64,
        /// Evaluations of contact.
        iterations: u32,
        /// Misfit of contact forces over the largest of contact forces and loads.
        residual: f64,
    },
    /// A block is past the depth at which contact pushes it out.
    #[error(
        "at t = {} s: triangle {} of block `{contactor}` is past the centroid of tetrahedron {} of block `{target}`, \
         where the contact potential no longer pushes it out: raise penalty_pa or reduce step_s", shown_time_s(*time_s), triangle.0, tet.0
    )]
    PastCentroid {
        /// Time [s].
        time_s: f64,
        /// Name of the block that went in.
        contactor: String,
        /// Its boundary triangle.
        triangle: TriangleId,
        /// Name of the block that it went into.
        target: String,
        /// The tetrahedron.
        tet: TetId,
    },
    /// A block could not take the step.
    #[error("at t = {} s: block `{block}`: {source}", shown_time_s(*time_s))]
    Block {
        /// Time [s].
        time_s: f64,
        /// Name of the block.
        block: String,
        /// The cause.
        source: BlockError,
    },
    /// A scene that was to settle first does not.
    #[error(
        "the scene has not come to rest in {steps} steps ({}{}){}. Block `{block}` has moved {} \
         towards ({:.2}, {:.2}, {:.2}), and {} at least half as far: {}",
        speed_left(*speed_ratio), no_less(*stalled), let_go(*overloaded_bonds), metres(*gone_m), towards[0], towards[1], towards[2], other_blocks(*others),
        cure_of_unrest(*stalled, *overloaded_bonds, *divide_step_by, *may_chatter)
    )]
    NotSettled {
        /// Steps done.
        steps: u64,
        /// Speed left over the largest speed.
        speed_ratio: f64,
        /// Name of the block that has gone farthest.
        block: String,
        /// How far its centre has gone [m].
        gone_m: f64,
        /// The direction in which, of length 1.
        towards: [f64; 3],
        /// Number of other blocks that have gone at least half as far.
        others: u32,
        /// Steps in which the speed left has not become less, where that was why it was given up.
        stalled: Option<u64>,
        /// Bonds that carried more than their strength at rest, and were let go.
        overloaded_bonds: u32,
        /// By how much the step has to be divided, where the stability number of contact was above its limit on the way: such steps make energy.
        divide_step_by: Option<u32>,
        /// Whether blocks deform under friction on damped contact, which may keep them vibrating.
        may_chatter: bool,
    },
    /// An element is inside out.
    #[error(
        "at t = {} s: tetrahedron {} of block `{block}` is inverted (det F = {volume_ratio:e}): reduce step_s or the load",
        shown_time_s(*time_s), tet.0
    )]
    Inverted {
        /// Time [s].
        time_s: f64,
        /// Name of the block.
        block: String,
        /// The tetrahedron.
        tet: TetId,
        /// det F.
        volume_ratio: f64,
    },
    /// The ranks that take the steps together cannot go on.
    #[error(transparent)]
    Ranks(#[from] RanksError),
}

impl StepError {
    /// That contact could not be computed, at a time [s].
    pub(crate) fn of_contact(time_s: f64, source: ContactError) -> Self {
        match source {
            ContactError::Ranks(error) => Self::Ranks(error),
            source => Self::Contact { time_s, source },
        }
    }

    /// Its section in `docs/troubleshooting.md`.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Contact { .. } => "contact-failed",
            Self::NoStepIsShortEnough { .. } => "no-step-short-enough",
            Self::Factor { .. } => "factor-failed",
            Self::ContactNotSolved { .. } => "contact-not-solved",
            Self::PastCentroid { .. } => "past-centroid",
            Self::Block { .. } => "block-failed",
            Self::NotSettled { .. } => "not-settled",
            Self::Inverted { .. } => "element-inverted",
            Self::Ranks(_) => "rank-stopped",
        }
    }
}

/// A time to show \[s\]: that of a run, without the last digits, in which adding up its steps rounds.
pub fn shown_time_s(time_s: f64) -> f64 {
    format!("{time_s:.12e}").parse().unwrap_or(time_s)
}

/// Speed that is left of a scene that settles.
fn speed_left(ratio: f64) -> String {
    if ratio.is_finite() { format!("speed {ratio:.1e} of the largest") } else { "speeds still rise".into() }
}

/// For how many steps the speed left has not become less.
fn no_less(stalled: Option<u64>) -> String {
    stalled.map_or_else(String::new, |steps| format!(", and no less for {steps} steps"))
}

/// That it rested as long as all bonds held.
fn let_go(bonds: u32) -> String {
    match bonds {
        0 => String::new(),
        _ => format!(
            ", although it rested as long as its joints held: at {bonds} of their points they carry more than friction, and what they have of cohesion and \
             tensile strength, can bear"
        ),
    }
}

/// What helps a scene to come to rest.
fn cure_of_unrest(
    stalled: Option<u64>,
    overloaded_bonds: u32,
    divide_step_by: Option<u32>,
    may_chatter: bool,
) -> String {
    if let Some(parts) = divide_step_by {
        return format!(
            "steps are too long for contact, which moves blocks by itself: divide step_s by {parts}"
        );
    }
    let cure = match stalled {
        _ if overloaded_bonds > 0 => {
            "support them, give their joints more friction or cohesion, or leave out settle if they are to slide or fall"
        }
        None => {
            "hold them, leave out settle if they are to slide or fall, or raise settle.most_steps if they are only slow"
        }
        Some(_) if may_chatter => {
            "hold them, or leave out settle if they are to slide or fall; if they only vibrate, as blocks that deform may under friction on damped contact, \
             write settle: (damping: Local()), a greater contact.restitution, a smaller penalty_pa or a shorter time.step_s"
        }
        Some(_) => {
            "hold them, or leave out settle if they are to slide or fall; if they only vibrate, raise settle.tolerance"
        }
    };
    cure.into()
}

/// A length, without a power of ten where that is not needed.
fn metres(length_m: f64) -> String {
    if length_m >= 1e-3 { format!("{length_m:.3} m") } else { format!("{length_m:.2e} m") }
}

/// So many other blocks, in words.
fn other_blocks(count: u32) -> String {
    match count {
        0 => "no other block".into(),
        1 => "one other block".into(),
        _ => format!("{count} other blocks"),
    }
}

/// Why a block could not take a step.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BlockError {
    /// The shape has no rotation any more.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// Its equations were not solved.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The rotation of a rigid block in a step cannot be solved for; half a turn at most has a solution.
    #[error(
        "its rotation in this step, about {angle_rad:.3} rad, is too large to compute: reduce step_s, or penalty_pa if contact exerts the torque \
         (the torque of {torque_n_m:.3e} N m turns it by {torque_angle_rad:.3} rad; its spin at the start of the step is {spin_rad_s:.3e} rad/s)"
    )]
    TurnsTooFar {
        /// |Δt ω₀ + ½ Δt² J⁻¹ T| [rad].
        angle_rad: f64,
        /// |ω₀|, its spin at the start of the step [rad/s].
        spin_rad_s: f64,
        /// |T|, the torque of loads and contact about its mass centre [N m].
        torque_n_m: f64,
        /// |½ Δt² J⁻¹ T| [rad].
        torque_angle_rad: f64,
    },
    /// The loads and contact forces on a rigid block are infinite or not a number.
    #[error("the forces on it are not finite: reduce step_s or penalty_pa, or check the units of its loads")]
    ForceNotFinite,
    /// The stress of a nonlinear material was not found.
    #[error(
        "the stress of its material did not converge in {iterations} iterations: reduce step_s or the load; a tangent modulus must \
         stay below twice that of the undeformed material"
    )]
    Material {
        /// Iterations done.
        iterations: u32,
    },
    /// A velocity is beyond what the material can carry, or not a number.
    #[error(
        "node {node} moves at {speed_m_s:.3e} m/s, more than ten times the wave speed of its material, {wave_speed_m_s:.3e} m/s: \
         reduce step_s, or penalty_pa if contact is stiff, and check young_pa and density_kg_m3"
    )]
    TooFast {
        /// The node, counted from the block's first.
        node: usize,
        /// Its speed [m/s].
        speed_m_s: f64,
        /// Wave speed of the material [m/s].
        wave_speed_m_s: f64,
    },
}

/// Why a simulation could not be set up.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SetupError {
    /// Supports of a block cannot be imposed.
    #[error("block `{block}`: {source}")]
    Support {
        /// Name of the block.
        block: String,
        /// The problem.
        source: SupportError,
    },
    /// The equations of a block cannot be factored.
    #[error("block `{block}`: {source}")]
    Factor {
        /// Name of the block.
        block: String,
        /// The problem.
        source: FactorError,
    },
    /// Supports that a body of this kind cannot have.
    #[error("block `{block}`: {reason}")]
    Kind {
        /// Name of the block.
        block: String,
        /// The conflict and its remedy.
        reason: &'static str,
    },
    /// A wave that the rock beyond a quiet face does not carry.
    #[error("block `{block}`: {source}")]
    Wave {
        /// Name of the block.
        block: String,
        /// The problem.
        source: Box<NoWave>,
    },
    /// A bolt cannot be set.
    #[error("bolt `{bolt}`: {source}")]
    Bolt {
        /// Name of the bolt.
        bolt: String,
        /// The problem.
        source: BoltError,
    },
    /// Contact at the start cannot be computed.
    #[error(transparent)]
    Contact(#[from] Box<StepError>),
    /// The accelerations at the start of a block cannot be solved for.
    #[error("block `{block}`: {source}")]
    Solve {
        /// Name of the block.
        block: String,
        /// How far the solver came.
        source: SolveError,
    },
}
