//! All that changes, to go on from later.

use crate::step::report::StageTimes;

use ndda_mesh::Vec3;
use serde::{Deserialize, Serialize};

use crate::diagnostics::ledger::Ledger;
use crate::integrators::time_integrator::Inertia;
use crate::step::Simulation;
use crate::step::stage_state::StageState;
use crate::step::state::State;

/// All that a run has become: what a checkpoint keeps, and a simulation of the same problem can go on from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Positions, velocities, what contact remembers.
    pub state: State,
    /// The ledger.
    pub ledger: Ledger,
    /// Seconds spent so far.
    pub stages: StageTimes,
    /// Row sums of the contact stiffness in the last step [N/m], which the next sample reads; empty where nothing acts.
    pub contact_stiffness: Vec<f64>,
    /// Balance of energy after a step \[J\], and after which, where the step is controlled.
    pub step_balance: Option<(u64, f64)>,
    /// What stages keep; none in a scene without them.
    pub stage: Option<StageState>,
}

/// A snapshot that is written but not kept: all by reference. Its encoding is that of [`Snapshot`].
#[derive(Clone, Debug, Serialize)]
pub struct SnapshotView<'a> {
    state: &'a State,
    ledger: &'a Ledger,
    stages: StageTimes,
    contact_stiffness: &'a [f64],
    step_balance: Option<(u64, f64)>,
    stage: Option<&'a StageState>,
}

/// A snapshot of another problem.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("it is of {found} nodes, the scene has {expected}: the scene or its meshes have changed")]
pub struct RestoreError {
    /// Nodes of the snapshot.
    pub found: usize,
    /// Nodes of the problem.
    pub expected: usize,
}

impl Simulation {
    /// A copy of all that changes.
    pub fn snapshot(&self) -> Snapshot {
        let contact_stiffness =
            if self.scratch.contact_has_acted { self.scratch.contact_stiffness.clone() } else { Vec::new() };
        Snapshot {
            state: self.state.clone(),
            ledger: self.audit.ledger.clone(),
            stages: self.audit.stages,
            contact_stiffness,
            step_balance: self.control.as_ref().and_then(|control| control.balance()),
            stage: self.stage.as_deref().cloned(),
        }
    }

    /// All that changes, to be written.
    pub fn snapshot_view(&self) -> SnapshotView<'_> {
        let acts = self.scratch.contact_has_acted;
        SnapshotView {
            state: &self.state,
            ledger: &self.audit.ledger,
            stages: self.audit.stages,
            contact_stiffness: if acts { &self.scratch.contact_stiffness } else { &[] },
            step_balance: self.control.as_ref().and_then(|control| control.balance()),
            stage: self.stage.as_deref(),
        }
    }

    /// Goes on from a snapshot of the same problem, bit for bit.
    ///
    /// # Errors
    /// [`RestoreError`] when it has another number of nodes.
    pub fn restore(&mut self, snapshot: Snapshot) -> Result<(), RestoreError> {
        let expected = self.problem.blocks.rest_position.len();
        let Snapshot { state, ledger, stages, contact_stiffness, step_balance, stage } = snapshot;
        let internal = self.state.internal_force.len();
        for (found, expected) in [
            (state.position.len(), expected),
            (state.velocity.len(), expected),
            (state.acceleration.len(), expected),
            (state.internal_force.len(), internal),
            (state.inertia.len(), self.state.inertia.len()),
            (
                state.driving_force.len(),
                if state.driving_force.is_empty() { 0 } else { self.problem.blocks.len() },
            ),
            (state.kept_force.len(), if state.kept_force.is_empty() { 0 } else { expected }),
            (state.contact_force.len(), self.state.contact_force.len()),
            (ledger.block_count(), self.problem.blocks.len()),
            (
                contact_stiffness.len(),
                if contact_stiffness.is_empty() { 0 } else { self.scratch.contact_stiffness.len() },
            ),
        ]
        .into_iter()
        .chain(state.bolts.sizes().into_iter().zip(self.state.bolts.sizes()))
        {
            if found != expected {
                return Err(RestoreError { found, expected });
            }
        }
        (self.state, self.audit.ledger, self.audit.stages) = (state, ledger, stages);
        self.scratch.contact_has_acted = !contact_stiffness.is_empty();
        if self.scratch.contact_has_acted {
            self.scratch.contact_stiffness = contact_stiffness;
        } else {
            self.scratch.contact_stiffness.fill(0.0);
        }
        self.scratch.friction_force.fill(Vec3::zeros());
        self.place_kept_forces();
        self.place_driving_forces();
        self.restore_stage(stage);
        self.control.iter_mut().for_each(|control| control.restore_balance(step_balance));
        Ok(())
    }

    /// Time begins where the blocks are, with these velocities.
    pub(crate) fn begin_at_rest(&mut self, velocity: Vec<Vec3>) {
        self.state.start = self.state.position.clone();
        self.state.velocity = velocity;
        self.note_blow();
        self.state.acceleration.fill(Vec3::zeros());
        self.state.inertia.fill(Inertia::default());
        self.state.step = 0;
        self.settling = None;
        self.place_loads_now();
        self.state.bolts.forget_work();
        self.audit.ledger = self.new_ledger((Vec3::zeros(), Vec3::zeros()));
    }
}
