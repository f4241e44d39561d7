//! The state: everything that changes from step to step, and nothing else.

use ndda_contact::ContactHistory;
use ndda_mesh::{BlockId, Vec3};
use serde::{Deserialize, Serialize};

use crate::bolts::memory::BoltMemory;
use crate::integrators::time_integrator::Inertia;

/// The changing state of all blocks; a checkpoint, a rollback and a determinism test all work on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Steps done; the time is `step · Δt`, never summed.
    pub step: u64,
    /// How steps are divided.
    pub control: StepState,
    /// Where each node was when time began [m]; empty while that is its place at rest.
    pub start: Vec<Vec3>,
    /// Position x per node [m], relative to the origin of the block set.
    pub position: Vec<Vec3>,
    /// Velocity v per node [m/s].
    pub velocity: Vec<Vec3>,
    /// Acceleration a per node [m/s²].
    pub acceleration: Vec<Vec3>,
    /// Internal force R (K w + ∫Bᵀσ₀) per node [N]; empty for integrators that take elasticity at the end only.
    pub internal_force: Vec<Vec3>,
    /// M a of each block as a whole; empty for integrators to which the start's acceleration does not matter.
    pub inertia: Vec<Inertia>,
    /// Contact force per node at the end of the last step [N]; empty where contact is taken at predicted positions.
    pub contact_force: Vec<Vec3>,
    /// Contact offset of each block [m]: contact is evaluated at x* plus this; empty where all are zero (`first_step.rs`).
    pub contact_offset: Vec<Vec3>,
    /// Force that a caller has set on each block [N]; empty while none was ever set.
    pub driving_force: Vec<Vec3>,
    /// Static reactions of quiet faces, per node [N]; empty where no block has any.
    pub kept_force: Vec<Vec3>,
    /// Contact history.
    pub contact: ContactHistory,
    /// What bolts remember.
    pub bolts: BoltMemory,
}

impl State {
    /// Contact offset of a block [m].
    pub(crate) fn contact_offset_of(&self, block: BlockId) -> Vec3 {
        self.contact_offset.get(block.index()).copied().unwrap_or_default()
    }
}

/// State of step control; part of the state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepState {
    /// n: a step is done in 2ⁿ parts.
    pub halvings: u32,
    /// Parts done of the present step.
    pub part: u32,
    /// Steps in a row that could have done with fewer parts.
    pub(super) relax_streak: u32,
    /// Steps that still skip the energy criterion.
    pub(super) energy_check_cooldown: u32,
    /// The most that a step may have gained by what is known without its balance of energy, over what it may gain: about the largest where the balance was taken lately.
    pub(super) checked_excess: f64,
    /// Part of such a bound that a step gained or lost there, about the largest.
    pub(super) gained_part: f64,
}
