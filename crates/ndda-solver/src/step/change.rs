//! Loads, supports and laws that change between two steps.

use ndda_mesh::Vec3;

use crate::error::StepError;
use crate::step::Simulation;
use crate::step::snapshot::RestoreError;

/// Why a simulation cannot take over from another.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TakeOverError {
    /// A support is new, or not the one that it was.
    #[error(
        "the supports of block {block} differ: between steps they can be removed, but not added or changed, as blocks are held where they \
         were at the start"
    )]
    Supports {
        /// Its name.
        block: String,
    },
    /// The integrator remembers accelerations, which changed loads and supports contradict.
    #[error(
        "the integrator remembers accelerations, so that loads and supports cannot change between steps: use Midpoint, or Simulation::set_force"
    )]
    RemembersAccelerations,
    /// Blocks, integrator or contact at the end of steps differ.
    #[error("it is another problem: {0}")]
    OtherProblem(#[from] RestoreError),
    /// The state cannot be sampled under the changed loads or laws, or these keep other numbers of each facet.
    #[error(transparent)]
    Step(#[from] StepError),
}

/// Totals before and after a change, whose difference is booked.
struct Totals {
    energy_j: f64,
    momentum: Vec3,
    angular_momentum: Vec3,
}

impl Simulation {
    /// Continues from the state of another simulation of the same blocks under the loads, supports and friction laws of this one.
    ///
    /// The potential energy of loads that jumps is booked as their work, so that the balances of energy and momentum hold across the change.
    ///
    /// # Errors
    /// [`TakeOverError`]; this simulation is then not to be used.
    pub fn take_over(&mut self, before: &mut Self) -> Result<(), TakeOverError> {
        self.refuse_other_supports(before)?;
        if self.weights.needs_acceleration && self.pulls_otherwise(before) {
            return Err(TakeOverError::RemembersAccelerations);
        }
        let old = before.totals()?;
        let snapshot = before.snapshot();
        self.restore(snapshot.clone())?;
        if self.has_contact() {
            // Laws that keep other numbers of each facet refuse the history here, and not in the next step.
            self.contacts_at_start()?;
            self.restore(snapshot)?;
        }
        let new = self.totals()?;
        self.audit.ledger.add_work(0.0, 0.0, new.energy_j - old.energy_j, 0.0);
        self.audit
            .ledger
            .add_whole_impulse(new.momentum - old.momentum, new.angular_momentum - old.angular_momentum);
        Ok(())
    }

    fn refuse_other_supports(&self, before: &Self) -> Result<(), TakeOverError> {
        let differs = |block: &ndda_mesh::BlockId| {
            let (new, old) = (&self.shape(*block).supports, &before.shape(*block).supports);
            let is_released = new.held.is_empty() && new.springs.is_empty() && new.motions.is_empty();
            new != old && !is_released
        };
        let names = &self.problem.blocks.names;
        match self.problem.blocks.ids().take(before.problem.blocks.len()).find(differs) {
            Some(block) => Err(TakeOverError::Supports { block: names[block.index()].clone() }),
            None => Ok(()),
        }
    }

    /// Whether loads or supports differ from those of a simulation of the same blocks.
    fn pulls_otherwise(&self, before: &Self) -> bool {
        let same_loads = self.loads.constant() == before.loads.constant()
            && self.loads.changing().is_empty() == before.loads.changing().is_empty();
        let same = |block| self.shape(block).supports == before.shape(block).supports;
        !same_loads || !self.problem.blocks.ids().all(same)
    }

    /// Energy and momentum now, without a word in the ledger.
    fn totals(&mut self) -> Result<Totals, StepError> {
        let kept = self.audit.ledger.clone();
        let sample = self.sample();
        self.audit.ledger = kept;
        let sample = sample?;
        Ok(Totals {
            energy_j: sample.total_j(),
            momentum: sample.momentum,
            angular_momentum: sample.angular_momentum,
        })
    }
}
