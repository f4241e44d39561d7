//! Quantities computed when results are written: energies, momenta, stresses.

use std::time::Instant;

use ndda_contact::{ContactInput, ContactReport, FacetContact};
use ndda_fem::frame::Frame;
use ndda_fem::stress::{cauchy_stress, largest_strain, smallest_volume_ratio};
use ndda_mesh::{BlockId, Mat3, TetId, Vec3};
use ndda_ranks::ExactSum;

use crate::bodies::kind::BodyKind;
use crate::bodies::prototype::Prototype;
use crate::diagnostics::block_sums::{SampleSums, over_blocks};
use crate::diagnostics::energies::{Sample, Vibration};
use crate::error::StepError;
use crate::integrators::time_integrator::StepWeights;
use crate::step::Simulation;
use crate::step::first_step::seen;
use crate::step::state::State;

impl Simulation {
    /// Energies and momenta now, balanced against the ledger.
    ///
    /// # Errors
    /// [`StepError::Inverted`] when an element is inside out, or as [`step`](Self::step).
    pub fn sample(&mut self) -> Result<Sample, StepError> {
        let started = Instant::now();
        let time_s = self.time_s();
        let farthest_m = self.farthest_m();
        let rounding_j = self.rounding_j() + self.rounding_of_loads_j(farthest_m);
        self.audit.ledger.watch_rounding(rounding_j);
        self.audit.ledger.watch_farthest(farthest_m);
        let mut sample = Sample { step: self.state.step, time_s, ..Sample::default() };
        sample.smallest_volume_ratio = (f64::INFINITY, 0);
        let mut vibration = Vibration::default();
        let mut sums = SampleSums::default();
        for block in self.problem.blocks.ids() {
            self.add_block_to(&mut sample, &mut sums, block)?;
            vibration = self.worse_vibration(block, vibration)?;
        }
        self.audit.ledger.watch_vibration(vibration, self.problem.integrator.damps_vibrations());
        sums.write(&mut sample);
        if let Some(model) = &mut self.contact {
            let State { position, velocity, contact_offset, .. } = &self.state;
            let position =
                seen(&self.problem.blocks, contact_offset, position, &mut self.scratch.seen_position);
            let input = ContactInput {
                affine: &self.problem.affine,
                ..ContactInput::new(&self.problem.blocks, position, velocity, self.part_s)
            };
            let energy_j = model.energy_j(&input, &self.state.contact);
            // A sum of nothing is −0 in Rust; adding 0 makes it 0, whether pairs that do not touch are listed or not.
            sample.contact_j = energy_j.map_err(|source| StepError::Contact { time_s, source })? + 0.0;
            let books = self.audit.ledger.blocks();
            books.clear_energies();
            if self.weights.forces_do_their_work() {
                model.each_energy(&mut |a, b, energy_j| books.add_energy(a, b, energy_j));
            }
        }
        let (stored_j, taken_j) = self.bolt_energies_j();
        (sample.bolt_j, sample.bolt_work_j) = (stored_j, -taken_j + 0.0);
        if !self.audit.ledger.is_open() {
            self.note_stretched_springs();
        }
        let sample = self.audit.ledger.balance(sample, self.contact_bound().is_some());
        self.audit.stages.ledger_s += started.elapsed().as_secs_f64();
        Ok(sample)
    }

    /// Notes where springs of friction, or bonds that have touched, may give back what they took before.
    pub(super) fn note_stretched_springs(&mut self) {
        let memory = &self.state.contact;
        let springs = memory.facets.iter().any(|facet| facet.shear_n != [0.0; 2]);
        if springs || !(memory.facets.is_empty() || memory.bonds.is_empty()) {
            self.audit.ledger.springs_are_stretched();
        }
    }

    fn add_block_to(
        &mut self,
        sample: &mut Sample,
        sums: &mut SampleSums,
        block: BlockId,
    ) -> Result<(), StepError> {
        let (range, time_s, contact_offset) =
            (self.problem.blocks.nodes_of(block), sample.time_s, self.state.contact_offset_of(block));
        sums.load_j.add(-self.load_work_j(range.clone()));
        let mut borrowed = self.problem.lend_memory(std::slice::from_mut(&mut self.bodies[block.index()]));
        let body = borrowed.one();
        let shape = &self.problem.shapes[body.shape];
        let (position, velocity) = (&self.state.position[range.clone()], &self.state.velocity[range]);
        sums.kinetic_j.add(shape.operator.kinetic_energy_j(velocity));
        let momentum = shape.operator.momentum(velocity);
        sums.momentum.add(&momentum);
        // Where contact sees the block: there its forces have no torque on all blocks together.
        let offset_moment = contact_offset.cross(&momentum);
        let angular_momentum = shape.operator.angular_momentum(&Vec3::zeros(), position, velocity);
        sums.angular_momentum.add(&(angular_momentum + offset_moment));
        let (mut momentum_scale, mut angular_scale) = (0.0, 0.0);
        for ((x, v), &m) in position.iter().zip(velocity).zip(&shape.operator.node_mass) {
            momentum_scale += m * v.norm();
            angular_scale += m * x.norm() * v.norm();
        }
        sums.momentum_scale.add(momentum_scale);
        sums.angular_scale.add(angular_scale);
        let since_s = self.audit.ledger.since_sample_s(time_s);
        let (spin_rad_s, rate_rad_s) = lag_rate(shape, &self.weights, self.part_s, position, velocity);
        self.audit.ledger.blocks().add_lag(block, since_s, spin_rad_s, rate_rad_s);
        let error = shape.rotation_error();
        if error > 0.0 {
            let spin = shape.operator.rigid_motion(position, velocity).spin_rad_s;
            self.audit.ledger.blocks().add_lumped_turn(block, since_s, spin, error);
        }
        let Some(elastic) = body.elastic() else { return Ok(()) };
        if shape.supports.frame == Frame::Held {
            let motion = shape.operator.rigid_motion(position, velocity);
            let turn = Frame::free(&shape.operator).rotation(&shape.operator, position, &motion.center);
            let turn_rad = turn.map_or(0.0, |turn| nalgebra::Rotation3::from_matrix_unchecked(turn).angle());
            self.audit.ledger.blocks().add_kept_turn(block, turn_rad, motion.spin_rad_s.norm());
        }
        let name = || self.problem.blocks.names[block.index()].clone();
        let (volume_ratio, tet) = smallest_volume_ratio(&shape.operator, position);
        let tet = self.problem.blocks.tets_of(block).start + tet;
        if volume_ratio.is_nan() || volume_ratio <= 0.0 {
            let tet = TetId(tet as u32);
            return Err(StepError::Inverted { time_s, block: name(), tet, volume_ratio });
        }
        if volume_ratio < sample.smallest_volume_ratio.0 {
            sample.smallest_volume_ratio = (volume_ratio, tet);
        }
        let failed = |source| StepError::Block { time_s, block: name(), source };
        let strain = elastic.strain_energy_j(shape, position);
        let strain_j = strain.map_err(|source| failed(source.into()))?;
        sums.strain_j.add(strain_j);
        self.audit.ledger.blocks().note_strain(block, strain_j);
        let displacement = elastic.displacement_in_frame();
        if strain_bound(shape, displacement) > self.audit.ledger.largest_strain() {
            self.audit.ledger.watch_strain(largest_strain(&shape.operator, displacement), block);
        }
        sums.spring_j.add(elastic.spring_energy_j(shape, position, time_s));
        Ok(())
    }

    /// Work of constant loads on some nodes on their way from where they started [J].
    fn load_work_j(&self, nodes: std::ops::Range<usize>) -> f64 {
        let moved = self.state.position[nodes.clone()].iter().zip(&self.start_position()[nodes.clone()]);
        self.loads.constant()[nodes].iter().zip(moved).map(|(f, (x, start))| f.dot(&(x - start))).sum()
    }

    /// Vibrations of a block that a step turns over, if they are worse than those found so far, those of before, and rounding.
    fn worse_vibration(&mut self, block: BlockId, found: Vibration) -> Result<Vibration, StepError> {
        let die_out = self.problem.integrator.damps_vibrations();
        let largest_m_s = self.audit.ledger.largest_speed_m_s();
        let known = self.audit.ledger.known_vibration(die_out).max(found.over(largest_m_s));
        let borne_m2_s2 = self.audit.ledger.blocks().strain_speed2(block, die_out);
        let known_m_s = known * (largest_m_s * largest_m_s + borne_m2_s2).sqrt();
        let (range, time_s) = (self.problem.blocks.nodes_of(block), self.time_s());
        let mut borrowed = self.problem.lend_memory(std::slice::from_mut(&mut self.bodies[block.index()]));
        let body = borrowed.one();
        let shape = &self.problem.shapes[body.shape];
        let Some(elastic) = body.elastic() else { return Ok(found) };
        let motion = (&self.state.position[range.clone()], &self.state.velocity[range]);
        let weights = shape.weights(&self.weights);
        let speed_m_s = match elastic.vibration_m_s(shape, (&weights, self.part_s), motion, known_m_s) {
            Ok(speed_m_s) => speed_m_s,
            Err(source) => {
                let block = self.problem.blocks.names[block.index()].clone();
                return Err(StepError::Block { time_s, block, source });
            }
        };
        let energy_j = 0.5 * shape.operator.mass_kg * speed_m_s * speed_m_s;
        let worse = speed_m_s > known_m_s && energy_j > self.audit.ledger.rounding_j();
        Ok(if worse { Vibration { speed_m_s, borne_m2_s2 } } else { found })
    }

    /// Energy that rounding alone may have brought by now [J]: what it takes to move every node by the last digit of its place
    /// against elasticity and contact, once in each step.
    fn rounding_j(&self) -> f64 {
        let last_digit = |x: &Vec3| f64::EPSILON * x.amax();
        let elastic = self.problem.blocks.ids().map(|block| {
            let position = &self.state.position[self.problem.blocks.nodes_of(block)];
            let digit_m = position.iter().map(last_digit).fold(0.0, f64::max);
            self.shape(block).stiffness_n_m * digit_m * digit_m
        });
        let contact_stiffness = &self.scratch.contact_stiffness;
        let of_nodes = |nodes: std::ops::Range<usize>| {
            let contact = contact_stiffness[nodes.clone()].iter().zip(&self.state.position[nodes]);
            contact.map(|(stiffness, x)| stiffness * last_digit(x).powi(2)).sum()
        };
        let has_contact = !contact_stiffness.is_empty();
        let contact =
            if has_contact { over_blocks(self.problem.blocks.node_starts(), of_nodes) } else { 0.0 };
        0.5 * (elastic.collect::<ExactSum>().value() + contact) * self.state.step as f64
    }

    /// Blocks that are not fixed.
    fn moving(&self) -> impl Iterator<Item = BlockId> {
        self.problem.blocks.ids().filter(|&block| self.shape(block).kind != BodyKind::Fixed)
    }

    /// Energy that loads which balance may have brought by rounding [J]: what is left of them in a step is some last digits of their sum, or of their moment about the origin,
    /// and moves or turns the blocks.
    fn rounding_of_loads_j(&self, farthest_m: f64) -> f64 {
        /// Last digits of the sum of all loads.
        const DIGITS: f64 = 4.0 * f64::EPSILON;
        let mass_kg =
            self.moving().map(|block| self.shape(block).operator.mass_kg).collect::<ExactSum>().value();
        let least_m =
            self.moving().map(|block| self.shape(block).smallest_height_m).fold(f64::INFINITY, f64::min);
        let impulse = DIGITS * self.audit.ledger.load_impulse() * (farthest_m / least_m).max(1.0);
        if mass_kg > 0.0 { 0.5 * impulse * impulse / mass_kg } else { 0.0 }
    }

    /// Distance from the origin of the farthest node of a block that is not fixed [m].
    fn farthest_m(&self) -> f64 {
        let nodes = self.moving().flat_map(|block| self.problem.blocks.nodes_of(block));
        nodes.map(|node| self.state.position[node].norm()).fold(0.0, f64::max)
    }

    /// Whether the next steps note what each facet does.
    pub fn watch_contacts(&mut self, wanted: bool) {
        if wanted != self.audit.contacts.is_some() {
            self.audit.contacts = wanted.then(Vec::new);
        }
    }

    /// Facets in contact in the last step, where contact was evaluated in it; none unless they were
    /// [watched](Self::watch_contacts), nor before the first step.
    pub fn contacts(&self) -> &[FacetContact] {
        self.audit.contacts.as_deref().unwrap_or(&[])
    }

    /// Puts noted facets in the place of the present ones, which are returned; none stands for contacts that are not watched.
    pub fn replace_contacts(&mut self, contacts: Option<Vec<FacetContact>>) -> Option<Vec<FacetContact>> {
        std::mem::replace(&mut self.audit.contacts, contacts)
    }

    /// Facets in contact at the present positions of the blocks; the history of contact is not changed.
    ///
    /// # Errors
    /// [`StepError::Contact`] when contact cannot be computed.
    pub fn contacts_at_start(&mut self) -> Result<(ContactReport, Vec<FacetContact>), StepError> {
        self.without_memory(|simulation| {
            simulation.scratch.contact_position.copy_from_slice(&simulation.state.position);
            let found = simulation.add_contact_forces(None);
            let mut facets = Vec::new();
            simulation.add_facets(&mut facets);
            found.map(|report| (report, facets))
        })
    }

    /// Takes contact's information on the step just done, before contact is evaluated again.
    pub(crate) fn note_contacts(&mut self) {
        let Some(mut contacts) = self.audit.contacts.take() else { return };
        contacts.clear();
        self.add_facets(&mut contacts);
        self.audit.contacts = Some(contacts);
    }

    pub(super) fn add_facets(&mut self, facets: &mut Vec<FacetContact>) {
        let Some(model) = &self.contact else { return };
        let State { velocity, contact_offset, contact, .. } = &self.state;
        let position = seen(
            &self.problem.blocks,
            contact_offset,
            &self.scratch.contact_position,
            &mut self.scratch.seen_position,
        );
        model.add_facets(
            &ContactInput::new(&self.problem.blocks, position, velocity, self.part_s),
            contact,
            facets,
        );
    }

    /// Cauchy stress per tetrahedron, global axes, (xx, yy, zz, xy, yz, zx) [Pa].
    ///
    /// # Errors
    /// [`StepError::Block`] when a block has no rotation any more.
    pub fn recover_stress(&mut self, out: &mut [[f64; 6]]) -> Result<(), StepError> {
        let time_s = self.time_s();
        for block in self.problem.blocks.ids() {
            let mut borrowed =
                self.problem.lend_memory(std::slice::from_mut(&mut self.bodies[block.index()]));
            let body = borrowed.one();
            let shape = &self.problem.shapes[body.shape];
            let position = &self.state.position[self.problem.blocks.nodes_of(block)];
            let out = &mut out[self.problem.blocks.tets_of(block)];
            let Some(body) = body.elastic() else {
                out.fill([0.0; 6]);
                continue;
            };
            let rotation = body.recover_displacement(shape, position).map_err(|source| StepError::Block {
                time_s,
                block: self.problem.blocks.names[block.index()].clone(),
                source: source.into(),
            })?;
            let (material, initial) = (shape.material.as_ref(), &body.kept.initial_stress_pa);
            let displacement = body.displacement_in_frame();
            cauchy_stress(&shape.operator, material, initial, &rotation, displacement, out);
        }
        Ok(())
    }
}

/// A bound of all strains: |∇w| ≤ Σₐ |wₐ − w|/hₐ over the four nodes of an element with heights hₐ.
fn strain_bound(shape: &Prototype, displacement: &[Vec3]) -> f64 {
    let farthest = displacement.iter().map(|w| w.norm_squared()).fold(0.0, f64::max).sqrt();
    8.0 * farthest / shape.smallest_height_m
}

/// Rate of rotation of a block [rad/s], and how fast its turn falls behind it [rad/s].
///
/// Nodes that deform go along chords: in a steady turn by φ per step the integrator has ω Δt = 2 tan ½φ (1 + (β − ½ γ) φ²), so φ is
/// less by (1/12 + β − ½ γ) φ³. Rigid blocks turn by ω Δt exactly as long as their spin keeps its axis; where it does not, a
/// step takes its mean for its course, which leaves up to ¼ Δt³ |ω| |dω/dt|: Δt³/12 of the second derivative of the spin,
/// about 2 |ω| |dω/dt|, and of the commutator ω × dω/dt.
fn lag_rate(
    shape: &Prototype,
    weights: &StepWeights,
    dt_s: f64,
    position: &[Vec3],
    velocity: &[Vec3],
) -> (f64, f64) {
    if shape.kind == BodyKind::Fixed {
        return (0.0, 0.0);
    }
    let motion = shape.operator.rigid_motion(position, velocity);
    let spin = motion.spin_rad_s;
    let rate = if let Some(inertia) = &shape.rigid {
        let rotation = shape.supports.frame.rotation(&shape.operator, position, &motion.center);
        let rotation = rotation.unwrap_or_else(|_| Mat3::identity());
        0.25 * spin.norm() * inertia.change_of_spin(&rotation.tr_mul(&spin)).norm()
    } else {
        let chord = weights.new_force * (1.0 / (weights.velocity_per_m * dt_s) - 0.5);
        (1.0 / 12.0 + chord).abs() * spin.norm().powi(3)
    };
    (spin.norm(), rate * dt_s * dt_s)
}
