//! What a simulation is asked for when results are written: energies, momenta, stresses.

use std::time::Instant;

use ndda_contact::{ContactInput, ContactReport, FacetContact};
use ndda_fem::stress::{cauchy_stress, smallest_volume_ratio};
use ndda_mesh::{BlockId, TetId, Vec3};

use crate::ledger::Sample;
use crate::simulation::Simulation;
use crate::step_error::StepError;

impl Simulation {
    /// Energies and momenta now, balanced against the books.
    ///
    /// # Errors
    /// [`StepError::Inverted`] when an element is inside out (invariant I7), or as [`step`](Self::step).
    pub fn sample(&mut self) -> Result<Sample, StepError> {
        let started = Instant::now();
        let time_s = self.time_s();
        let mut sample = Sample { step: self.state.step, time_s, ..Sample::default() };
        sample.smallest_volume_ratio = (f64::INFINITY, 0);
        for block in self.blocks.ids() {
            self.add_block_to(&mut sample, block)?;
        }
        let loads = self.loads.constant().iter().zip(&self.state.position).zip(self.start_position());
        sample.load_j = -loads.map(|((f, x), rest)| f.dot(&(x - rest))).sum::<f64>();
        if let Some(model) = &mut self.contact {
            let (position, velocity) = (&self.state.position, &self.state.velocity);
            let input = ContactInput::new(&self.blocks, position, velocity, self.part_s);
            let energy_j = model.energy_j(&input, &self.state.contact);
            sample.contact_j = energy_j.map_err(|source| StepError::Contact { time_s, source })?;
        }
        let sample = self.ledger.balance(sample, self.contact_bound().is_some());
        self.stages.ledger_s += started.elapsed().as_secs_f64();
        Ok(sample)
    }

    fn add_block_to(&mut self, sample: &mut Sample, block: BlockId) -> Result<(), StepError> {
        let (range, time_s) = (self.blocks.nodes_of(block), sample.time_s);
        let body = &mut self.bodies[block.index()];
        let shape = &self.shapes[body.shape];
        let (position, velocity) = (&self.state.position[range.clone()], &self.state.velocity[range]);
        sample.kinetic_j += shape.operator.kinetic_energy_j(velocity);
        sample.momentum += shape.operator.momentum(velocity);
        sample.angular_momentum += shape.operator.angular_momentum(&Vec3::zeros(), position, velocity);
        for ((x, v), &m) in position.iter().zip(velocity).zip(&shape.operator.node_mass) {
            sample.momentum_scale += m * v.norm();
            sample.angular_scale += m * x.norm() * v.norm();
        }
        let Some(elastic) = body.elastic() else { return Ok(()) };
        let name = || self.blocks.names[block.index()].clone();
        let (volume_ratio, tet) = smallest_volume_ratio(&shape.operator, position);
        let tet = self.blocks.tets_of(block).start + tet;
        if volume_ratio.is_nan() || volume_ratio <= 0.0 {
            let tet = TetId(tet as u32);
            return Err(StepError::Inverted { time_s, block: name(), tet, volume_ratio });
        }
        if volume_ratio < sample.smallest_volume_ratio.0 {
            sample.smallest_volume_ratio = (volume_ratio, tet);
        }
        sample.strain_j += elastic.strain_energy_j(shape, position).map_err(|source| StepError::Block {
            time_s,
            block: name(),
            source: source.into(),
        })?;
        sample.spring_j += elastic.spring_energy_j(shape, position, time_s);
        Ok(())
    }

    /// Whether the next steps note what each facet does.
    pub fn watch_contacts(&mut self, wanted: bool) {
        if wanted != self.contacts.is_some() {
            self.contacts = wanted.then(Vec::new);
        }
    }

    /// What facets did in the last step, where contact was evaluated in it; none unless it was
    /// [watched](Self::watch_contacts), nor before the first step.
    pub fn contacts(&self) -> &[FacetContact] {
        self.contacts.as_deref().unwrap_or(&[])
    }

    /// What facets do to each other where the blocks are now; nothing of it is remembered.
    ///
    /// # Errors
    /// [`StepError::Contact`] when contact cannot be computed.
    pub fn contacts_at_start(&mut self) -> Result<(ContactReport, Vec<FacetContact>), StepError> {
        let (remembered, force) = (self.state.contact.clone(), self.force.clone());
        self.contact_position.copy_from_slice(&self.state.position);
        let found = self.add_contact_forces(None);
        let mut facets = Vec::new();
        if let Some(model) = &self.contact {
            let input =
                ContactInput::new(&self.blocks, &self.contact_position, &self.state.velocity, self.part_s);
            model.add_facets(&input, &self.state.contact, &mut facets);
        }
        (self.state.contact, self.force) = (remembered, force);
        found.map(|report| (report, facets))
    }

    /// Contact force on each node in the last step [N], friction included; zero before the first step.
    pub fn contact_forces_n(&self) -> impl ExactSizeIterator<Item = Vec3> {
        let begun = self.state.step > 0;
        let contact = move |(force, load): (&Vec3, &Vec3)| if begun { force - load } else { Vec3::zeros() };
        self.force.iter().zip(self.loads.total()).map(contact)
    }

    /// Asks contact what it just did, before anything else asks it for something.
    pub(crate) fn note_contacts(&mut self) {
        let (Some(contacts), Some(model)) = (&mut self.contacts, &self.contact) else { return };
        contacts.clear();
        let input =
            ContactInput::new(&self.blocks, &self.contact_position, &self.state.velocity, self.part_s);
        model.add_facets(&input, &self.state.contact, contacts);
    }

    /// Cauchy stress per tetrahedron, global axes, (xx, yy, zz, xy, yz, zx) [Pa].
    ///
    /// # Errors
    /// [`StepError::Block`] when a block has no rotation any more.
    pub fn recover_stress(&mut self, out: &mut [[f64; 6]]) -> Result<(), StepError> {
        let time_s = self.time_s();
        for block in self.blocks.ids() {
            let body = &mut self.bodies[block.index()];
            let shape = &self.shapes[body.shape];
            let position = &self.state.position[self.blocks.nodes_of(block)];
            let out = &mut out[self.blocks.tets_of(block)];
            let Some(body) = body.elastic() else {
                out.fill([0.0; 6]);
                continue;
            };
            let rotation = body.recover_displacement(shape, position).map_err(|source| StepError::Block {
                time_s,
                block: self.blocks.names[block.index()].clone(),
                source: source.into(),
            })?;
            let (material, initial) = (shape.material.as_ref(), &body.initial_stress_pa);
            let displacement = body.displacement_in_frame();
            cauchy_stress(&shape.operator, material, initial, &rotation, displacement, out);
        }
        Ok(())
    }
}
