//! Contact forces at the places that the integrator requires.

use std::mem::take;

use ndda_contact::{ContactInput, ContactOutput, ContactReport, Deformation};
use ndda_mesh::{BlockId, Vec3};
use rayon::prelude::*;

use crate::bodies::kind::BodyKind;
use crate::bodies::record::end_velocity;
use crate::error::StepError;
use crate::step::deformation::StepDeformation;
use crate::step::first_step::seen;
use crate::step::report::Iterations;
use crate::step::state::State;
use crate::step::{MANY_NODES, Simulation};

impl Simulation {
    /// f ← loads and contact, at predicted positions or at the end of the step.
    pub(super) fn gather_contact(&mut self) -> Result<(ContactReport, Iterations), StepError> {
        let Some(mut newton) = self.newton.take() else {
            self.place_contact();
            let report = self.add_contact_forces(None)?;
            self.carry_contact_forces();
            self.stop_past_centroid(&report)?;
            return Ok((report, Iterations::default()));
        };
        let report = self.solve_contact(&mut newton);
        let iterations = newton.iterations;
        self.newton = Some(newton);
        Ok((report?, iterations))
    }

    /// x* = x + lead · Δt v + lead₂ · Δt² a.
    pub(super) fn place_contact(&mut self) {
        let lead = self.weights.contact_lead * self.part_s;
        let State { position, velocity, .. } = &self.state;
        let places = &mut self.scratch.contact_position;
        if places.len() > MANY_NODES {
            let moving = position.par_iter().zip(velocity);
            let each = places.par_iter_mut().zip(moving).with_min_len(MANY_NODES / 2);
            each.for_each(|(place, (x, v))| *place = x + lead * v);
        } else {
            let moving = position.iter().zip(velocity);
            places.iter_mut().zip(moving).for_each(|(place, (x, v))| *place = x + lead * v);
        }
        let lead = self.weights.contact_lead_acceleration * self.part_s * self.part_s;
        if lead != 0.0 {
            let accelerations = self.scratch.contact_position.iter_mut().zip(&self.state.acceleration);
            accelerations.for_each(|(place, a)| *place += lead * a);
        }
        self.place_moved_bases();
    }

    /// x* of blocks that move as prescribed: where they are at that time.
    pub(super) fn place_moved_bases(&mut self) {
        let (now_s, then_s) = (self.clock_s(0.0), self.clock_s(self.weights.contact_lead));
        for (block, body) in self.problem.blocks.ids().zip(&self.bodies) {
            let shape = &self.problem.shapes[body.shape];
            if shape.kind != BodyKind::Fixed || shape.supports.motions.is_empty() {
                continue;
            }
            let gone = shape.displacement_as_a_whole(then_s) - shape.displacement_as_a_whole(now_s);
            let nodes = self.problem.blocks.nodes_of(block);
            let (places, start) =
                (&mut self.scratch.contact_position[nodes.clone()], &self.state.position[nodes]);
            places.iter_mut().zip(start).for_each(|(place, x)| *place = x + gone);
        }
    }

    /// Rigid motion and loads of the blocks, where contact needs them.
    pub(super) fn place_bodies(&mut self) {
        let (now_s, end_s) = (self.clock_s(0.0), self.clock_s(1.0));
        for (index, body) in self.scratch.contact_bodies.iter_mut().enumerate() {
            let (held, shape) = (body.mass_kg.is_infinite(), &self.problem.shapes[self.bodies[index].shape]);
            if held && shape.supports.motions.is_empty() {
                continue;
            }
            let range = self.problem.blocks.nodes_of(BlockId(index as u32));
            let (position, velocity) =
                (&self.scratch.contact_position[range.clone()], &self.state.velocity[range.clone()]);
            let motion = shape.operator.rigid_motion(position, velocity);
            let contact_offset = self.state.contact_offset_of(BlockId(index as u32));
            body.center = motion.center + contact_offset;
            body.velocity_m_s = motion.velocity_m_s;
            body.spin_rad_s = motion.spin_rad_s;
            if held {
                if shape.kind == BodyKind::Fixed {
                    let end_m_s = end_velocity(shape, shape.motion_as_a_whole(), (now_s, end_s));
                    body.prescribed_change_m_s = end_m_s - motion.velocity_m_s;
                }
                continue;
            }
            body.inverse_inertia =
                shape.rigid_inverse_inertia(position, &motion).unwrap_or(motion.inverse_inertia);
            if let Some(masses) = &self.scratch.scaled_masses {
                let factor = masses.factor_of(index);
                body.mass_kg = factor * shape.operator.mass_kg;
                body.inverse_inertia /= factor;
            }
            (body.load_n, body.torque_n_m) = (Vec3::zeros(), Vec3::zeros());
            for (x, load) in position.iter().zip(&self.loads.total()[range]) {
                body.push(&(x + contact_offset), load);
            }
            if let Some(bolts) = &self.bolts {
                let range = self.problem.blocks.nodes_of(BlockId(index as u32));
                for (x, pull) in position.iter().zip(&bolts.force[range]) {
                    body.push(&(x + contact_offset), pull);
                }
            }
        }
    }

    /// force ← force + contact and bolts at x*; slip is by the velocities of the nodes, or by others where laws of facets ask.
    pub(crate) fn add_contact_forces(
        &mut self,
        facet_velocity: Option<&[Vec3]>,
    ) -> Result<ContactReport, StepError> {
        self.find_bolt_forces();
        self.place_bodies();
        let report = self.add_forces_of_contact(facet_velocity);
        self.add_bolt_forces();
        report
    }

    fn add_forces_of_contact(&mut self, facet_velocity: Option<&[Vec3]>) -> Result<ContactReport, StepError> {
        let time_s = self.time_s();
        let Some(mut model) = self.contact.take() else { return Ok(ContactReport::default()) };
        if std::mem::replace(&mut self.scratch.contact_has_acted, true) {
            self.scratch.friction_force.fill(Vec3::zeros());
            self.scratch.contact_stiffness.fill(0.0);
        }
        // The output of contact is taken out, so that contact may query how the blocks answer.
        let (mut force, mut history) = (take(&mut self.scratch.force), take(&mut self.state.contact));
        let mut friction_force = take(&mut self.scratch.friction_force);
        let mut stiffness = take(&mut self.scratch.contact_stiffness);
        let (mut bodies, mut seen_position) = (take(&mut self.bodies), take(&mut self.scratch.seen_position));
        let deformation = StepDeformation::new(self, &mut bodies);
        let velocity = facet_velocity.filter(|_| !model.needs_bodies()).unwrap_or(&self.state.velocity);
        let input = ContactInput {
            blocks: &self.problem.blocks,
            position: seen(
                &self.problem.blocks,
                &self.state.contact_offset,
                &self.scratch.contact_position,
                &mut seen_position,
            ),
            velocity,
            dt_s: self.part_s,
            affine: &self.problem.affine,
            bodies: &self.scratch.contact_bodies,
            // While the end of the step is being found, how blocks answer to that is part of what is looked for.
            deformation: facet_velocity.is_none().then_some(&deformation as &dyn Deformation),
            is_iterated: facet_velocity.is_some(),
            without_friction: self.scratch.is_without_friction,
            bonds_hold: self.settling.is_some_and(|settling| settling.bonds_hold),
            friction_tolerance: self.settling.map_or(0.0, |settling| settling.friction_tolerance),
            ranks: self.ranks.partners(),
        };
        let mut output = ContactOutput {
            force: &mut force,
            friction_force: &mut friction_force,
            stiffness: &mut stiffness,
        };
        let mut report = model.add_forces(&input, &mut history, &mut output);
        if let Some(error) = deformation.stopped() {
            report = Err(error.into());
        }
        if let Ok(ContactReport { action_reaction_error: error @ None, .. }) = &mut report {
            let before = if facet_velocity.is_none() { self.loads.total() } else { &[] };
            *error = Some(imbalance(&force, before));
        }
        self.scratch.contact_has_acted = report.is_err() || model.has_acted();
        (self.scratch.force, self.state.contact, self.scratch.friction_force) =
            (force, history, friction_force);
        (self.scratch.contact_stiffness, self.bodies, self.scratch.seen_position) =
            (stiffness, bodies, seen_position);
        self.contact = Some(model);
        report.map_err(|source| StepError::of_contact(time_s, source))
    }

    /// Stops where contact has lost its grip.
    pub(crate) fn stop_past_centroid(&self, report: &ContactReport) -> Result<(), StepError> {
        let Some((triangle, tet)) = report.past_centroid else { return Ok(()) };
        let name = |block: BlockId| self.problem.blocks.names[block.index()].clone();
        Err(StepError::PastCentroid {
            time_s: self.time_s(),
            contactor: name(self.problem.blocks.triangle_block[triangle.index()]),
            triangle,
            target: name(self.problem.blocks.tet_block[tet.index()]),
            tet,
        })
    }
}

/// |Σ f| / Σ |f| of the forces that contact added to what was there before, or to nothing; zero to the rounding of the sums.
fn imbalance(force: &[Vec3], before: &[Vec3]) -> f64 {
    let (mut sum, mut size, mut rounding) = (Vec3::zeros(), 0.0, 0.0);
    for (i, total) in force.iter().enumerate() {
        let old = before.get(i).copied().unwrap_or_default();
        let added = total - old;
        sum += added;
        size += added.norm();
        rounding += f64::EPSILON * (total.norm() + old.norm());
    }
    let unequal = (sum.norm() - 8.0 * rounding).max(0.0);
    if size > 0.0 { unequal / size } else { 0.0 }
}
