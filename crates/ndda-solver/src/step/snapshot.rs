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
#[error(
    "it keeps {found} {what}, where the scene has {expected}: the scene, its meshes or its bolts have changed"
)]
pub struct RestoreError {
    /// Of what there are too many or too few.
    pub what: &'static str,
    /// How many the snapshot has.
    pub found: usize,
    /// How many the problem has.
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
    /// [`RestoreError`] when it has another number of nodes, blocks, or parts of bolts, or was taken with another integrator.
    pub fn restore(&mut self, snapshot: Snapshot) -> Result<(), RestoreError> {
        self.compare_sizes(&snapshot)?;
        let Snapshot { state, ledger, stages, contact_stiffness, step_balance, stage } = snapshot;
        (self.state, self.audit.ledger, self.audit.stages) = (state, ledger, stages);
        self.scratch.contact_has_acted = !contact_stiffness.is_empty();
        if self.scratch.contact_has_acted {
            self.scratch.contact_stiffness = contact_stiffness;
        } else {
            self.scratch.contact_stiffness.fill(0.0);
        }
        self.scratch.friction_force.fill(Vec3::zeros());
        self.forget_contact();
        self.place_kept_forces();
        self.place_driving_forces();
        self.restore_stage(stage);
        self.control.iter_mut().for_each(|control| control.restore_balance(step_balance));
        Ok(())
    }

    /// Forgets contact of a step that is not the last one of the present state.
    fn forget_contact(&mut self) {
        self.audit.contact_is_known = false;
        self.audit.contacts.iter_mut().for_each(Vec::clear);
    }

    /// Refuses a snapshot of which something has another size than here.
    fn compare_sizes(&self, snapshot: &Snapshot) -> Result<(), RestoreError> {
        let (nodes, blocks) = (self.problem.blocks.rest_position.len(), self.problem.blocks.len());
        let Snapshot { state, ledger, contact_stiffness, .. } = snapshot;
        let optional = |found: usize, expected: usize| (found, if found == 0 { 0 } else { expected });
        let sizes = [
            ("nodes", (state.position.len(), nodes)),
            ("velocities of nodes", (state.velocity.len(), nodes)),
            ("accelerations of nodes", (state.acceleration.len(), nodes)),
            ("internal forces of nodes", (state.internal_force.len(), self.state.internal_force.len())),
            ("inertial forces of blocks", (state.inertia.len(), self.state.inertia.len())),
            ("driving forces of blocks", optional(state.driving_force.len(), blocks)),
            ("static reactions of nodes", optional(state.kept_force.len(), nodes)),
            ("contact forces of nodes", (state.contact_force.len(), self.state.contact_force.len())),
            ("blocks", (ledger.block_count(), blocks)),
            (
                "contact stiffnesses of nodes",
                optional(contact_stiffness.len(), self.scratch.contact_stiffness.len()),
            ),
        ];
        let of_bolts = state.bolts.sizes().into_iter().zip(self.state.bolts.sizes());
        let of_bolts = of_bolts.map(|((what, found), (_, expected))| (what, (found, expected)));
        let differs = |(_, (found, expected)): &(&str, (usize, usize))| found != expected;
        match sizes.into_iter().chain(of_bolts).find(differs) {
            Some((what, (found, expected))) => Err(RestoreError { what, found, expected }),
            None => Ok(()),
        }
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
        self.forget_contact();
        self.place_loads_now();
        self.state.bolts.forget_work();
        self.audit.ledger = self.new_ledger((Vec3::zeros(), Vec3::zeros()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::kind::BodyKind;
    use crate::step::test_boxes::boxes;

    #[test]
    fn a_snapshot_that_does_not_fit_is_refused_with_what_does_not() {
        let cube = |at_m: f64| (BodyKind::Rigid, [1.0; 3], [at_m, 0.0, 0.0]);
        let mut simulation = Simulation::new(boxes(&[cube(0.0), cube(2.0)])).unwrap();
        let mut snapshot = simulation.snapshot();
        snapshot.state.driving_force = vec![Vec3::zeros()];
        let message = simulation.restore(snapshot).unwrap_err().to_string();
        assert!(message.contains("1 driving forces of blocks, where the scene has 2"), "{message}");
        let one = Simulation::new(boxes(&[cube(0.0)])).unwrap();
        let message = simulation.restore(one.snapshot()).unwrap_err().to_string();
        assert!(message.contains("8 nodes, where the scene has 16"), "{message}");
    }
}
