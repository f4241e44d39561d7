//! Loads, supports and laws that change between two steps.

use nalgebra::Rotation3;
use ndda_contact::ContactError;
use ndda_fem::supports::{BlockSupports, HeldNode, Spring};
use ndda_mesh::BlockId;

use crate::bodies::kind::BodyKind;
use crate::error::StepError;
use crate::step::Simulation;
use crate::step::follower::Places;
use crate::step::snapshot::RestoreError;
use crate::step::state::State;

/// A block that has turned by more [rad] than this cannot be held in a way that stops its turning: its strains would be measured without the
/// turn, which changes them by half its square, 5e-7.
const TURNED_RAD: f64 = 1e-3;

/// Why a simulation cannot take over from another.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TakeOverError {
    /// A new support pulls to where its nodes were when time began.
    #[error(
        "block {block} gets a spring or a prescribed motion, which count from where the block was at the start: between steps, only supports \
         that hold nodes where they are (Fixed, Normal, Direction) can be added; any support can be removed"
    )]
    Supports {
        /// Its name.
        block: String,
    },
    /// A new support stops the turning of a block that has turned.
    #[error(
        "block {block} has rotated by {turn_deg:.3}°, and nodes that prevent all rotation can be held only up to 0.057°: hold fewer of its nodes, or hold it earlier"
    )]
    Turned {
        /// Its name.
        block: String,
        /// Turn that the new supports would take out of its strains [°].
        turn_deg: f64,
    },
    /// The integrator remembers accelerations, which changed loads and supports contradict.
    #[error(
        "the integrator remembers accelerations, so that loads and supports cannot change between steps: use Midpoint, or Simulation::set_force"
    )]
    RemembersAccelerations,
    /// Blocks, integrator or contact at the end of steps differ.
    #[error("more differs than can change between steps: {0}")]
    OtherProblem(#[from] RestoreError),
    /// The changed laws keep other numbers of each facet than those so far.
    #[error(
        "the friction laws so far keep {kept} numbers per facet, and the changed ones {wanted}: laws that remember slip, such as those with a residual or \
         a roughness, begin and end with a simulation. Begin a new one with them, or give such a law from the start and change its values"
    )]
    Laws {
        /// Numbers that are kept.
        kept: usize,
        /// Numbers that the changed laws keep.
        wanted: usize,
    },
    /// A stage of construction cannot be built.
    #[error("{0}")]
    Stage(String),
    /// The state cannot be sampled under the changed loads or laws.
    #[error(transparent)]
    Step(#[from] StepError),
}

impl Simulation {
    /// Continues from the state of another simulation of the same blocks under the loads, supports and friction laws of this one.
    ///
    /// Nodes that are held from now on stop where they are. What changes at once, the potential energy of loads and the kinetic energy and
    /// momentum of nodes that stop, is booked as work and impulse of loads, so that the balances hold across the change.
    ///
    /// # Errors
    /// [`TakeOverError`]; this simulation is then not to be used.
    pub fn take_over(&mut self, before: &mut Self) -> Result<(), TakeOverError> {
        self.refuse_other_supports(before)?;
        if self.weights.needs_acceleration && self.pulls_otherwise(before) {
            return Err(TakeOverError::RemembersAccelerations);
        }
        let (old, _) = before.look()?;
        let snapshot = before.snapshot();
        self.restore(snapshot.clone())?;
        if self.has_contact() {
            // Laws that keep other numbers of each facet refuse the history here, and not in the next step.
            self.contacts_at_start().map_err(of_laws)?;
            self.restore(snapshot)?;
        }
        self.stop_held_nodes(before);
        let (new, _) = self.look()?;
        self.audit.ledger.add_work(0.0, 0.0, new.total_j() - old.total_j(), 0.0);
        self.audit.ledger.add_jump_of_momentum(&old, &new);
        self.note_stretched_springs();
        self.audit.ledger.blocks().watch_rebounds_anew();
        Ok(())
    }

    pub(super) fn refuse_other_supports(&self, before: &Self) -> Result<(), TakeOverError> {
        for block in self.held_anew(before) {
            let (new, old) = (&self.shape(block).supports, &before.shape(block).supports);
            let name = || self.problem.blocks.names[block.index()].clone();
            if !is_known(new, old) {
                return Err(TakeOverError::Supports { block: name() });
            }
            let turn_rad = self.turn_between_frames(before, block);
            if turn_rad > TURNED_RAD {
                return Err(TakeOverError::Turned { block: name(), turn_deg: turn_rad.to_degrees() });
            }
        }
        Ok(())
    }

    /// Blocks that deform, were there before, and whose supports are others than then.
    fn held_anew(&self, before: &Self) -> Vec<BlockId> {
        let is_other = |block: &BlockId| {
            let shape = self.shape(*block);
            shape.kind != BodyKind::Fixed
                && !before.is_absent(*block)
                && shape.supports != before.shape(*block).supports
        };
        self.problem.blocks.ids().take(before.problem.blocks.len()).filter(is_other).collect()
    }

    /// Angle between the frames that the supports of now and of before give a block where it is [rad].
    fn turn_between_frames(&self, before: &Self, block: BlockId) -> f64 {
        let shape = self.shape(block);
        let position = &before.state.position[self.problem.blocks.nodes_of(block)];
        let center = shape.operator.center(position);
        let [new, old] = [&shape.supports, &before.shape(block).supports]
            .map(|supports| supports.frame.rotation(&shape.operator, position, &center));
        match (new, old) {
            (Ok(new), Ok(old)) => Rotation3::from_matrix_unchecked(new.transpose() * old).angle(),
            _ => f64::INFINITY,
        }
    }

    /// Velocities that new supports leave.
    pub(super) fn stop_held_nodes(&mut self, before: &Self) {
        for block in self.held_anew(before) {
            let nodes = self.problem.blocks.nodes_of(block);
            let shape = &self.problem.shapes[self.bodies[block.index()].shape];
            let position = &self.state.position[nodes.clone()];
            let center = shape.operator.center(position);
            let rotation = shape.supports.frame.rotation(&shape.operator, position, &center);
            let rotation = rotation.expect("its turn was compared before");
            shape.stop_held(&rotation, &mut self.state.velocity[nodes]);
            self.note_blow();
        }
    }

    /// Whether loads at the present time, or supports, differ from those of a simulation of the same blocks.
    fn pulls_otherwise(&self, before: &Self) -> bool {
        let (now_s, State { position, velocity, .. }) = (before.clock_s(0.0), &before.state);
        let [new, old] = [self, before]
            .map(|simulation| simulation.loads.at(now_s, Places { position, velocity, lead_s: 0.0 }));
        let same_loads = new == old;
        let same = |block| self.shape(block).supports == before.shape(block).supports;
        !same_loads || !self.problem.blocks.ids().all(same)
    }
}

/// The error of a state under changed laws.
fn of_laws(error: StepError) -> TakeOverError {
    match error {
        StepError::Contact { source: ContactError::OtherLaws { kept, expected }, .. } => {
            TakeOverError::Laws { kept, wanted: expected }
        }
        other => other.into(),
    }
}

/// Whether springs and prescribed motions of a block are some of those that it had before.
fn is_known(new: &BlockSupports, old: &BlockSupports) -> bool {
    let moved = |supports: &BlockSupports, held: &HeldNode| held.motion.map(|m| supports.motions[m].clone());
    let had = |held: &HeldNode| {
        let same = old.held.iter().find(|one| one.node == held.node);
        same.is_some_and(|one| moved(old, one) == moved(new, held))
    };
    let sprung = |spring: &Spring| (spring.node, spring.along, spring.stiffness_n_m.to_bits());
    let pulled = |one: &Spring, other: &Spring| {
        sprung(one) == sprung(other)
            && one.motion.map(|m| &new.motions[m]) == other.motion.map(|m| &old.motions[m])
    };
    new.held.iter().filter(|held| held.motion.is_some()).all(had)
        && new.springs.iter().all(|spring| old.springs.iter().any(|other| pulled(spring, other)))
}
