//! Contact offset of free blocks at the start.
//!
//! A scheme that takes contact at x* = x + ½ Δt v leaps from one x* to the next, by Δt v: these follow the motion, and x, the mean of
//! two of them, is off by ⅛ Δt² a. A block that begins at x itself has its x* beside its course: where contact of frequency ω is to
//! carry a load all at once, it oscillates by (ω Δt)²/8 of that too much. With contact o = ⅛ Δt² a further ahead, a being the acceleration of the
//! block as a whole at the start, that is (ω Δt)⁴/128. o never changes: x + o is what moves by the scheme and keeps its
//! energy and angular momentum, while x falls by ½ g t² from where it was put.

use ndda_contact::ContactReport;
use ndda_mesh::{BlockSet, Vec3};

use crate::error::StepError;
use crate::step::Simulation;
use crate::step::report::StepReport;

impl Simulation {
    /// Sets the contact offsets in the first step, where the scheme needs them.
    pub(super) fn offset_contact_in_the_first_step(&mut self) -> Result<(), StepError> {
        if self.needs_offset() { self.set_contact_offsets() } else { Ok(()) }
    }

    /// Takes blocks for being on their course: they go on from where another simulation has brought them, and contact has no offset in the first step.
    pub fn go_on_course(&mut self) {
        self.state.start.clone_from(&self.problem.blocks.rest_position);
    }

    /// Whether this is the first step, and one by a scheme of that kind. A scene that settled is on its course, with no load to carry all at
    /// once.
    fn needs_offset(&self) -> bool {
        let is_settled = self.settling.is_some() || !self.state.start.is_empty();
        let first = self.state.step == 0 && self.state.control.part == 0 && !is_settled;
        first
            && (self.contact.is_some() || self.has_bolts())
            && self.newton.is_none()
            && self.weights.contact_in_the_middle()
    }

    /// o ← ⅛ Δt² a, by loads and contact where the blocks are put.
    fn set_contact_offsets(&mut self) -> Result<(), StepError> {
        self.state.contact_offset.clear();
        let force = self.force_at_start()?;
        for block in self.problem.blocks.ids() {
            let (shape, nodes) = (self.shape(block), self.problem.blocks.nodes_of(block));
            let total: Vec3 = force[nodes.clone()].iter().sum();
            let acceleration = if shape.is_free() { total / shape.operator.mass_kg } else { Vec3::zeros() };
            let contact_offset = 0.125 * self.part_s * self.part_s * acceleration;
            let momentum = shape.operator.momentum(&self.state.velocity[nodes]);
            self.audit.ledger.add_whole_impulse(Vec3::zeros(), contact_offset.cross(&momentum));
            self.state.contact_offset.push(contact_offset);
        }
        if self.state.contact_offset.iter().all(|contact_offset| *contact_offset == Vec3::zeros()) {
            self.state.contact_offset.clear();
        }
        self.scratch.force.copy_from_slice(self.loads.total());
        Ok(())
    }

    /// What is known before the first step: contact at rest where a scene has settled; nothing where blocks are as drawn, since contact is evaluated in
    /// steps. Facets are noted if they are [watched](Self::watch_contacts).
    ///
    /// # Errors
    /// [`StepError::Contact`] when contact cannot be computed.
    pub fn report_at_start(&mut self) -> Result<StepReport, StepError> {
        if self.state.step > 0 || !self.began_at_rest() || self.contact.is_none() {
            return Ok(StepReport::default());
        }
        self.gather_loads();
        let (force, contact) = self.contact_where_placed()?;
        self.scratch.force = force;
        self.audit.contact_is_known = true;
        self.note_contacts();
        let rates2 = self.problem.blocks.ids().map(|block| self.contact_rate2(block));
        let h = self.part_s * rates2.fold(0.0, f64::max).sqrt();
        Ok(StepReport { contact, h, ..StepReport::default() })
    }

    /// Loads and contact where the blocks are now [N], and the report on contact; nothing of it is remembered.
    fn contact_where_placed(&mut self) -> Result<(Vec<Vec3>, ContactReport), StepError> {
        self.without_memory(|simulation| {
            simulation.scratch.force.copy_from_slice(simulation.loads.total());
            simulation.scratch.contact_position.copy_from_slice(&simulation.state.position);
            let report = simulation.add_contact_forces(None)?;
            Ok((simulation.scratch.force.clone(), report))
        })
    }

    /// Loads and contact where the blocks are now [N], which are then the forces of the step, too; nothing else of it is remembered.
    pub(crate) fn force_at_start(&mut self) -> Result<Vec<Vec3>, StepError> {
        let (force, _) = self.contact_where_placed()?;
        self.scratch.force.copy_from_slice(&force);
        Ok(force)
    }
}

/// Positions at which contact is evaluated for nodes at `places`: those, or with the contact offsets, in `room`.
pub(crate) fn seen<'a>(
    blocks: &BlockSet,
    contact_offset: &[Vec3],
    places: &'a [Vec3],
    room: &'a mut Vec<Vec3>,
) -> &'a [Vec3] {
    if contact_offset.is_empty() {
        return places;
    }
    room.resize(places.len(), Vec3::zeros());
    for (block, contact_offset) in blocks.ids().zip(contact_offset) {
        let nodes = blocks.nodes_of(block);
        // Two at a time fill vectors.
        let ((seen, last_seen), (at, last_at)) =
            (room[nodes.clone()].as_chunks_mut(), places[nodes].as_chunks());
        seen.iter_mut().zip(at).for_each(|(seen, [x, y])| *seen = [x + contact_offset, y + contact_offset]);
        last_seen.iter_mut().zip(last_at).for_each(|(seen, x)| *seen = x + contact_offset);
    }
    room
}
