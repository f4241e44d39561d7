//! Stages of construction: blocks that come and go between two steps, and loads that change over a time.

use std::ops::Range;

use ndda_contact::{ContactInput, FacetContact};
use ndda_mesh::{BlockId, Vec3};

use crate::bodies::kind::BodyKind;
use crate::bodies::prototype::Prototype;
use crate::diagnostics::block_diagnostics::BlockDiagnostics;
use crate::diagnostics::energies::Sample;
use crate::error::StepError;
use crate::step::Simulation;
use crate::step::change::TakeOverError;
use crate::step::follower::Places;
use crate::step::release::ContactNow;
use crate::step::snapshot::Snapshot;
use crate::step::stage_state::StageState;
use crate::step::state::State;

/// Blocks cannot be left out.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LeaveOutError {
    /// A block that is left out would move.
    #[error("block {0} is left out, but is not Fixed: build it as a Fixed block without loads")]
    NotFixed(String),
    /// The contact model knows of no absent blocks.
    #[error("this contact model cannot leave blocks out, as stages need: use Potential contact")]
    Contact,
}

/// What a stage does to the state that it begins with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageStart {
    /// Time over which forces of removed blocks, and of loads that are taken away or added, change to what they are in the stage [s]; at once if zero.
    pub over_s: f64,
    /// Whether displacements count from here on.
    pub reset_displacements: bool,
}

impl Simulation {
    /// Leaves blocks out from now on, those that are `true`: they feel nothing, nothing feels them, and they have no energy. They are
    /// built as `Fixed` ones.
    ///
    /// # Errors
    /// [`LeaveOutError`].
    pub fn leave_out(&mut self, absent: Vec<bool>) -> Result<(), LeaveOutError> {
        let is_absent = |block: &BlockId| absent.get(block.index()) == Some(&true);
        let mut left_out = self.problem.blocks.ids().filter(is_absent);
        if let Some(block) = left_out.find(|block| self.shape(*block).kind != BodyKind::Fixed) {
            return Err(LeaveOutError::NotFixed(self.problem.blocks.names[block.index()].clone()));
        }
        if self.contact.as_mut().is_some_and(|model| !model.leave_out(&absent)) {
            return Err(LeaveOutError::Contact);
        }
        let ranges: Vec<Range<usize>> =
            self.blocks().ids().filter(is_absent).map(|block| self.blocks().nodes_of(block)).collect();
        let State { position, velocity, .. } = &self.state;
        self.loads.leave_out(&ranges, Places { position, velocity, lead_s: 0.0 });
        self.stage = Some(Box::new(StageState { absent, ..StageState::default() }));
        let present = self.blocks().ids().filter(|block| !self.is_absent(*block));
        let heights_m = present.map(|block| self.shape(block).smallest_height_m);
        let smallest_height_m = heights_m.fold(f64::INFINITY, f64::min);
        self.audit.travel.begin_anew(smallest_height_m);
        Ok(())
    }

    /// Whether a block is absent.
    pub fn is_absent(&self, block: BlockId) -> bool {
        self.stage.as_ref().is_some_and(|stage| stage.absent.get(block.index()) == Some(&true))
    }

    /// Whether blocks may come and go.
    pub fn has_stages(&self) -> bool {
        self.stage.is_some()
    }

    /// Where displacements count from [m]: the start, or where a stage set them to zero.
    pub fn counted_from(&self) -> &[Vec3] {
        match &self.stage {
            Some(stage) if !stage.counted_from.is_empty() => &stage.counted_from,
            _ => self.start_position(),
        }
    }

    /// Continues from the state of another simulation of the same blocks, of which others are absent, under the loads, supports and laws of this one.
    ///
    /// Forces of blocks that are taken out act on and ramp down, and so does the difference of the loads, over `start.over_s`. Blocks that are
    /// added are where they were meshed, at rest and without stress. Bolts are installed in the rock as it lies now, strained by their pretension only. The energy of what is taken out, added, and of their contact is in the
    /// balance as energy removed, and so is that of bolts that are released, less that of those installed; what else changes at once is work of loads.
    ///
    /// # Errors
    /// [`TakeOverError`]; this simulation is then not to be used.
    pub fn begin_stage(&mut self, before: &mut Self, start: &StageStart) -> Result<(), TakeOverError> {
        if self.weights.needs_acceleration {
            return Err(TakeOverError::RemembersAccelerations);
        }
        self.refuse_other_supports(before)?;
        self.share_steps(before.ranks().clone());
        // A run that goes on from here has no step behind it that would have placed them elsewhere.
        before.place_loads_now();
        let (old, _) = before.look()?;
        let released = self.changing_blocks(before, |new, old| new && !old);
        let added = self.changing_blocks(before, |new, old| !new && old);
        let mut removed_j = self.energy_of(before, &released)?;
        let contact = before.contact_now()?;
        let snapshot = before.snapshot();
        self.enter((before, &contact), snapshot.clone(), (&released, &added), start)?;
        let rest = self.contact_now()?;
        // Undoes what this evaluation of contact has changed.
        self.enter((before, &contact), snapshot, (&released, &added), start)?;
        self.stop_held_nodes(before);
        if start.over_s > 0.0 {
            let pairs = before.contact_between(&contact, &released);
            self.release(before, (&contact, &rest, &pairs), start.over_s);
        }
        let scales = self.problem.blocks.ids().map(|block| self.shape(block).scale()).collect();
        self.audit.ledger.blocks().weigh_anew(scales);
        let (new, books) = self.look()?;
        self.audit.ledger.blocks().rebase(&books);
        for block in &added {
            removed_j -= self.block_energy_j(*block)?;
        }
        removed_j += old.contact_j - new.contact_j + (old.bolt_j - new.bolt_j);
        self.audit.ledger.add_work(0.0, 0.0, new.total_j() - old.total_j() + removed_j, 0.0);
        self.audit.ledger.add_removed(removed_j);
        self.audit.ledger.add_jump_of_momentum(&old, &new);
        self.note_stretched_springs();
        self.audit.ledger.blocks().watch_rebounds_anew();
        Ok(())
    }

    /// Takes over the state of the simulation before, with its blocks and bolts in their new places.
    fn enter(
        &mut self,
        (before, contact): (&mut Self, &ContactNow),
        snapshot: Snapshot,
        changed: (&[BlockId], &[BlockId]),
        start: &StageStart,
    ) -> Result<(), TakeOverError> {
        self.restore(snapshot)?;
        self.change_places(before, changed, start);
        self.install_bolts(before);
        Ok(self.take_over_contact(before, &contact.facets)?)
    }

    /// Blocks that are absent now and were absent before as asked for.
    fn changing_blocks(&self, before: &Self, asked: impl Fn(bool, bool) -> bool) -> Vec<BlockId> {
        let blocks = self.problem.blocks.ids();
        blocks.filter(|&block| asked(self.is_absent(block), before.is_absent(block))).collect()
    }

    /// Energy of some blocks as they were before [J].
    fn energy_of(&self, before: &mut Self, blocks: &[BlockId]) -> Result<f64, StepError> {
        let mut total_j = 0.0;
        for block in blocks {
            total_j += before.block_energy_j(*block)?;
        }
        Ok(total_j)
    }

    /// Takes removed blocks to rest, and added ones to where they were meshed.
    fn change_places(&mut self, before: &Self, changed: (&[BlockId], &[BlockId]), start: &StageStart) {
        let (removed, added) = changed;
        if let Some(stage) = &mut self.stage {
            stage.release = None;
            if start.reset_displacements {
                stage.counted_from = before.state.position.clone();
            }
        }
        self.place_release();
        for &block in removed.iter().chain(added) {
            let nodes = self.problem.blocks.nodes_of(block);
            self.state.velocity[nodes.clone()].fill(Vec3::zeros());
            self.note_blow();
            let State { acceleration, internal_force, contact_force, .. } = &mut self.state;
            for values in [acceleration, internal_force, contact_force] {
                values.get_mut(nodes.clone()).into_iter().flatten().for_each(|value| *value = Vec3::zeros());
            }
        }
        for &block in added {
            let nodes = self.problem.blocks.nodes_of(block);
            let rest = &self.problem.blocks.rest_position[nodes.clone()];
            let counted_from = self.stage.as_mut().map(|stage| &mut stage.counted_from);
            let places = [&mut self.state.position, &mut self.state.start].into_iter().chain(counted_from);
            for place in places.filter_map(|all| all.get_mut(nodes.clone())) {
                place.copy_from_slice(rest);
            }
        }
        let (blocks, absent) = (&self.problem.blocks, self.stage.as_ref().map_or(&[][..], |s| &s.absent));
        self.state.contact.forget_bonds(blocks, |block| absent.get(block.index()) == Some(&true));
    }

    /// Takes over what contact remembers, under the laws of this stage.
    fn take_over_contact(&mut self, before: &Self, carried: &[FacetContact]) -> Result<(), StepError> {
        let time_s = self.time_s();
        let (Some(model), Some(old)) = (&mut self.contact, &before.contact) else { return Ok(()) };
        let State { position, velocity, contact, .. } = &mut self.state;
        let input = ContactInput {
            affine: &self.problem.affine,
            ..ContactInput::new(&self.problem.blocks, position, velocity, self.part_s)
        };
        let taken = model.take_over(&input, (&**old, carried), contact);
        taken.map_err(|source| StepError::of_contact(time_s, source))
    }

    /// Takes over what stages keep; which blocks are absent is known from the start.
    pub(super) fn restore_stage(&mut self, saved: Option<StageState>) {
        let Some(saved) = saved else { return };
        let absent = self.stage.take().map_or(saved.absent, |own| own.absent);
        self.stage = Some(Box::new(StageState { absent, ..saved }));
        self.place_release();
    }

    /// Energies now, and those of pairs of blocks, without a word in the ledger.
    pub(super) fn look(&mut self) -> Result<(Sample, BlockDiagnostics), StepError> {
        let kept = self.audit.ledger.clone();
        let sample = self.sample();
        let books = self.audit.ledger.blocks().clone();
        self.audit.ledger = kept;
        Ok((sample?, books))
    }

    /// Kinetic, elastic, spring and load energy of a block [J].
    fn block_energy_j(&mut self, block: BlockId) -> Result<f64, StepError> {
        let time_s = self.time_s();
        let nodes = self.problem.blocks.nodes_of(block);
        let start =
            if self.state.start.is_empty() { &self.problem.blocks.rest_position } else { &self.state.start };
        let (position, velocity) = (&self.state.position[nodes.clone()], &self.state.velocity[nodes.clone()]);
        let loads = self.loads.constant()[nodes.clone()].iter().zip(position).zip(&start[nodes]);
        let load_j = -loads.map(|((f, x), start)| f.dot(&(x - start))).sum::<f64>();
        let mut borrowed = self.problem.lend_memory(std::slice::from_mut(&mut self.bodies[block.index()]));
        let body = borrowed.one();
        let shape: &Prototype = &self.problem.shapes[body.shape];
        let rigid_j = shape.operator.kinetic_energy_j(velocity) + load_j;
        let Some(elastic) = body.elastic() else { return Ok(rigid_j) };
        let strain_j = elastic.strain_energy_j(shape, position).map_err(|source| StepError::Block {
            time_s,
            block: self.problem.blocks.names[block.index()].clone(),
            source: source.into(),
        })?;
        Ok(rigid_j + strain_j + elastic.spring_energy_j(shape, position, time_s))
    }
}
