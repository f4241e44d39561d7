//! The problem, the state, and the step that joins them.

use std::mem::take;
use std::time::Instant;

use ndda_contact::{
    Body as ContactBody, ContactInput, ContactModel, ContactOutput, ContactReport, Deformation, FacetContact,
};
use ndda_mesh::{BlockId, BlockSet, Vec3};
use serde::{Deserialize, Serialize};

use crate::batch::solve_together;
use crate::block_books::Worst;
use crate::body::{Body, BodyKind, StepContext};
use crate::contact_moments::ContactMoments;
use crate::deformation::StepDeformation;
use crate::end_contact::{Iterations, Newton};
use crate::first_step::seen;
use crate::for_each_block::{NodeSlices, Runs, each_of_run, for_each_run};
use crate::ledger::{Invariants, Ledger};
use crate::loads::Loads;
use crate::ringing::Quadrature;
use crate::shape::Shape;
use crate::state::State;
use crate::step_control::{Control, StepState};
use crate::step_error::StepError;
use crate::time_integrator::{Inertia, StepWeights, TimeIntegrator};
use crate::travel::Travel;

/// Nodes per half below which a second thread costs more than it brings.
pub(crate) const GRAIN_NODES: usize = 400;

/// What one step found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Contact at x*.
    pub contact: ContactReport,
    /// h = ω_c Δt, ω_c² taken as the largest row sum of contact's stiffness over the node's lumped mass.
    pub h: f64,
    /// Largest relative travel of two blocks that may meet in the step over the width of the thinner one, and which that is; only
    /// bounded from above where it is below a quarter of what is allowed.
    pub travel: Worst,
    /// Work of normal contact, the sum over facets without sign; only where steps are controlled [J].
    pub contact_work_j: f64,
    /// What solving for contact took; none where it is taken at predicted positions.
    pub iterations: Iterations,
}

/// Seconds spent per stage of the step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StageTimes {
    /// Contact forces.
    pub contact_s: f64,
    /// Block solves.
    pub blocks_s: f64,
    /// Bookkeeping and energies.
    pub ledger_s: f64,
}

/// All that a run has become: what a checkpoint keeps, and a simulation of the same problem can go on from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Positions, velocities, what contact remembers.
    pub state: State,
    /// The books.
    pub ledger: Ledger,
    /// Seconds spent so far.
    pub stages: StageTimes,
    /// Row sums of the contact stiffness in the last step [N/m], which the next sample reads; empty where nothing acts.
    pub contact_stiffness: Vec<f64>,
    /// Balance of energy after a step \[J\], and after which, where the step is controlled.
    pub step_balance: Option<(u64, f64)>,
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

/// A problem on its way through time.
pub struct Simulation {
    pub(crate) blocks: BlockSet,
    pub(crate) shapes: Vec<Shape>,
    pub(crate) travel: Travel,
    pub(crate) bodies: Vec<Body>,
    pub(crate) runs: Runs,
    pub(crate) state: State,
    /// Δt of a whole step, and of the parts that it is done in.
    pub(crate) base_step_s: f64,
    pub(crate) part_s: f64,
    pub(crate) control: Option<Box<Control>>,
    pub(crate) settling: bool,
    pub(crate) integrator: Box<dyn TimeIntegrator>,
    pub(crate) weights: StepWeights,
    pub(crate) contact: Option<Box<dyn ContactModel>>,
    pub(crate) newton: Option<Box<Newton>>,
    pub(crate) ledger: Ledger,
    pub(crate) stages: StageTimes,
    pub(crate) loads: Loads,
    pub(crate) force: Vec<Vec3>,
    pub(crate) friction_force: Vec<Vec3>,
    pub(crate) contact_stiffness: Vec<f64>,
    /// Whether forces of friction and stiffness of contact may be other than zero.
    pub(crate) contact_has_acted: bool,
    pub(crate) contact_position: Vec<Vec3>,
    /// Room for places that contact sees further ahead.
    pub(crate) seen_position: Vec<Vec3>,
    /// Whether blocks are damped, or nodes of them follow a prescribed motion.
    pub(crate) has_impulses: bool,
    /// Part of contact forces whose direction is not known in this step, and that no friction bears.
    pub(crate) loose: f64,
    pub(crate) min_friction_coefficient: f64,
    /// Where nodes were before the step, later how far it moved them [m]; empty without contact.
    pub(crate) moved: Vec<Vec3>,
    /// Which blocks move by an affine map; empty without contact.
    pub(crate) affine: Vec<bool>,
    pub(crate) contact_bodies: Vec<ContactBody>,
    /// Moments of contact forces, for schemes that take them elsewhere than in the middle of a step.
    pub(crate) contact_moments: Option<Box<ContactMoments>>,
    /// What facets did in the last step, if somebody wants to know.
    pub(crate) contacts: Option<Vec<FacetContact>>,
}

impl Simulation {
    /// One step. The order is the paper's; what differs is where contact and rotation are taken.
    ///
    /// # Errors
    /// [`StepError`] naming time, block and element; the state is then not to be used.
    pub fn step(&mut self) -> Result<StepReport, StepError> {
        let Some(mut control) = self.control.take() else { return self.part_step() };
        let report = self.controlled_step(&mut control);
        self.control = Some(control);
        report
    }

    /// One step, or one part of a step that is done in several.
    pub(crate) fn part_step(&mut self) -> Result<StepReport, StepError> {
        let started = Instant::now();
        self.gather_loads();
        if self.begins() {
            self.begin_ahead()?;
        }
        let (contact, iterations) = self.gather_contact()?;
        let depth = contact.max_penetration_ratio;
        self.loose = if depth > self.min_friction_coefficient { depth } else { 0.0 };
        self.note_contacts();
        if self.contact_does_work(&contact) {
            self.moved.copy_from_slice(&self.state.position);
        }
        let contact_done = Instant::now();
        self.solve_blocks()?;
        let solved = Instant::now();
        let report = self.keep_books(contact, iterations);
        self.stages.contact_s += (contact_done - started).as_secs_f64();
        self.stages.blocks_s += (solved - contact_done).as_secs_f64();
        self.stages.ledger_s += solved.elapsed().as_secs_f64();
        Ok(report)
    }

    /// f ← gravity, tractions and forces, as their mean over a step about the time at which the integrator takes them.
    fn gather_loads(&mut self) {
        let lead = self.weights.load_lead;
        self.loads.place(self.clock_s(lead - 0.5), self.clock_s(lead + 0.5));
        self.force.copy_from_slice(self.loads.total());
    }

    /// f ← loads and contact, at predicted positions or at the end of the step.
    fn gather_contact(&mut self) -> Result<(ContactReport, Iterations), StepError> {
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
    fn place_contact(&mut self) {
        let lead = self.weights.contact_lead * self.part_s;
        let moving = self.state.position.iter().zip(&self.state.velocity);
        for (place, (x, v)) in self.contact_position.iter_mut().zip(moving) {
            *place = x + lead * v;
        }
        let lead = self.weights.contact_lead_acceleration * self.part_s * self.part_s;
        if lead != 0.0 {
            let accelerations = self.contact_position.iter_mut().zip(&self.state.acceleration);
            accelerations.for_each(|(place, a)| *place += lead * a);
        }
        self.place_moved_bases();
    }

    /// x* of blocks that go where they are told to: where they are at that time.
    fn place_moved_bases(&mut self) {
        let (now_s, then_s) = (self.clock_s(0.0), self.clock_s(self.weights.contact_lead));
        for (block, body) in self.blocks.ids().zip(&self.bodies) {
            let shape = &self.shapes[body.shape];
            if shape.kind != BodyKind::Fixed || shape.supports.motions.is_empty() {
                continue;
            }
            let gone = shape.displacement_as_a_whole(then_s) - shape.displacement_as_a_whole(now_s);
            let nodes = self.blocks.nodes_of(block);
            let (places, start) = (&mut self.contact_position[nodes.clone()], &self.state.position[nodes]);
            places.iter_mut().zip(start).for_each(|(place, x)| *place = x + gone);
        }
    }

    /// Rigid motion and loads of the blocks, where contact asks for them.
    fn place_bodies(&mut self) {
        let (now_s, end_s) = (self.clock_s(0.0), self.clock_s(1.0));
        for (index, body) in self.contact_bodies.iter_mut().enumerate() {
            let (held, shape) = (body.mass_kg.is_infinite(), &self.shapes[self.bodies[index].shape]);
            if held && shape.supports.motions.is_empty() {
                continue;
            }
            let range = self.blocks.nodes_of(BlockId(index as u32));
            let (position, velocity) =
                (&self.contact_position[range.clone()], &self.state.velocity[range.clone()]);
            let motion = shape.operator.rigid_motion(position, velocity);
            let ahead = self.state.ahead_of(BlockId(index as u32));
            body.center = motion.center + ahead;
            body.velocity_m_s = motion.velocity_m_s;
            body.spin_rad_s = motion.spin_rad_s;
            if held {
                if shape.kind == BodyKind::Fixed {
                    // Where it goes in this step is known already.
                    let increment =
                        shape.displacement_as_a_whole(end_s) - shape.displacement_as_a_whole(now_s);
                    body.velocity_m_s = increment / self.part_s;
                }
                continue;
            }
            body.inverse_inertia =
                shape.rigid_inverse_inertia(position, &motion).unwrap_or(motion.inverse_inertia);
            (body.load_n, body.torque_n_m) = (Vec3::zeros(), Vec3::zeros());
            for (x, load) in position.iter().zip(&self.loads.total()[range]) {
                body.push(&(x + ahead), load);
            }
        }
    }

    /// force ← force + contact at x*; slip is by the velocities of the nodes, or by others where laws of facets ask.
    pub(crate) fn add_contact_forces(
        &mut self,
        facet_velocity: Option<&[Vec3]>,
    ) -> Result<ContactReport, StepError> {
        self.place_bodies();
        let time_s = self.time_s();
        let Some(mut model) = self.contact.take() else { return Ok(ContactReport::default()) };
        if std::mem::replace(&mut self.contact_has_acted, true) {
            self.friction_force.fill(Vec3::zeros());
            self.contact_stiffness.fill(0.0);
        }
        // What contact writes is taken out, so that it may ask how the blocks answer.
        let (mut force, mut history) = (take(&mut self.force), take(&mut self.state.contact));
        let mut friction_force = take(&mut self.friction_force);
        let mut stiffness = take(&mut self.contact_stiffness);
        let (mut bodies, mut seen_position) = (take(&mut self.bodies), take(&mut self.seen_position));
        let deformation = StepDeformation::new(self, &mut bodies);
        let velocity = facet_velocity.filter(|_| !model.needs_bodies()).unwrap_or(&self.state.velocity);
        let input = ContactInput {
            blocks: &self.blocks,
            position: seen(&self.blocks, &self.state.ahead, &self.contact_position, &mut seen_position),
            velocity,
            dt_s: self.part_s,
            affine: &self.affine,
            bodies: &self.contact_bodies,
            // While the end of the step is being found, how blocks answer to that is part of what is looked for.
            deformation: facet_velocity.is_none().then_some(&deformation as &dyn Deformation),
            is_iterated: facet_velocity.is_some(),
        };
        let mut output = ContactOutput {
            force: &mut force,
            friction_force: &mut friction_force,
            stiffness: &mut stiffness,
        };
        let report = model.add_forces(&input, &mut history, &mut output);
        self.contact_has_acted = report.is_err() || model.has_acted();
        (self.force, self.state.contact, self.friction_force) = (force, history, friction_force);
        (self.contact_stiffness, self.bodies, self.seen_position) = (stiffness, bodies, seen_position);
        self.contact = Some(model);
        report.map_err(|source| StepError::Contact { time_s, source })
    }

    /// Stops where contact has lost its grip.
    pub(crate) fn stop_past_centroid(&self, report: &ContactReport) -> Result<(), StepError> {
        let Some((triangle, tet)) = report.past_centroid else { return Ok(()) };
        let name = |block: BlockId| self.blocks.names[block.index()].clone();
        Err(StepError::PastCentroid {
            time_s: self.time_s(),
            contactor: name(self.blocks.triangle_block[triangle.index()]),
            triangle,
            target: name(self.blocks.tet_block[tet.index()]),
            tet,
        })
    }

    /// What block `index` of a shape needs to know of a step.
    pub(crate) fn context(&self, index: usize, shape: &Shape) -> StepContext<'_> {
        let range = self.blocks.nodes_of(BlockId(index as u32));
        self.context_under(index, shape, &self.force[range])
    }

    /// The same with other forces on its nodes.
    pub(crate) fn context_under<'a>(
        &'a self,
        index: usize,
        shape: &Shape,
        force: &'a [Vec3],
    ) -> StepContext<'a> {
        let range = self.blocks.nodes_of(BlockId(index as u32));
        let acted = if self.contact_has_acted { range.clone() } else { 0..0 };
        StepContext {
            integrator: self.integrator.as_ref(),
            drag: shape.damping.mass,
            weights: shape.weights(&self.weights),
            dt_s: self.part_s,
            time_s: self.clock_s(0.0),
            end_s: self.clock_s(1.0),
            contact_position: &self.contact_position[range.clone()],
            ahead: self.state.ahead_of(BlockId(index as u32)),
            force,
            external: &self.loads.total()[range.clone()],
            changing: self.loads.changing().get(range.clone()).unwrap_or(&[]),
            friction_force: self.friction_force.get(acted.clone()).unwrap_or(&[]),
            contact_stiffness: self.contact_stiffness.get(acted).unwrap_or(&[]),
            loose: self.loose,
            inertia: self.state.inertia.get(index).copied().unwrap_or_default(),
            carried: self.contact_moments.as_ref().map_or(Vec3::zeros(), |moments| moments.carried[index]),
        }
    }

    /// Works on blocks and their nodes while the rest is read.
    pub(crate) fn with_bodies(&mut self, work: impl FnOnce(&Self, &mut [Body], NodeSlices)) {
        let mut bodies = take(&mut self.bodies);
        let (mut position, mut velocity) = (take(&mut self.state.position), take(&mut self.state.velocity));
        let mut acceleration = take(&mut self.state.acceleration);
        let mut internal_force = take(&mut self.state.internal_force);
        let slices = NodeSlices {
            position: &mut position,
            velocity: &mut velocity,
            acceleration: &mut acceleration,
            internal_force: &mut internal_force,
        };
        work(self, &mut bodies, slices);
        self.bodies = bodies;
        (self.state.position, self.state.velocity) = (position, velocity);
        (self.state.acceleration, self.state.internal_force) = (acceleration, internal_force);
    }

    /// Each block alone, in parallel.
    fn solve_blocks(&mut self) -> Result<(), StepError> {
        self.with_bodies(|simulation, bodies, slices| {
            let starts = simulation.blocks.node_starts();
            for_each_run(&simulation.runs, bodies, starts, slices, GRAIN_NODES, &|first, run, slices| {
                simulation.step_run(first, run, slices);
            });
        });
        for (inertia, body) in self.state.inertia.iter_mut().zip(&self.bodies) {
            *inertia = body.report.inertia;
        }
        self.stop_if_a_block_failed()
    }

    /// The step of a run: congruent blocks are solved for together, others one by one; the bits are the same.
    fn step_run(&self, first: usize, run: &mut [Body], mut slices: NodeSlices) {
        let starts = self.blocks.node_starts();
        let together = run[0].batch.is_some();
        if together {
            each_of_run(first, run, starts, slices.again(), |index, body: &mut Body, nodes| {
                let shape = &self.shapes[body.shape];
                body.prepare(shape, &self.context(index, shape), &nodes.view());
            });
            solve_together(&self.shapes[run[0].shape], run);
        }
        each_of_run(first, run, starts, slices, |index, body: &mut Body, nodes| {
            let shape = &self.shapes[body.shape];
            let context = self.context(index, shape);
            if together { body.finish(shape, &context, nodes) } else { body.step(shape, &context, nodes) }
        });
    }

    /// The first error of a block, if there is any.
    pub(crate) fn stop_if_a_block_failed(&mut self) -> Result<(), StepError> {
        let time_s = self.clock_s(1.0);
        for (index, body) in self.bodies.iter_mut().enumerate() {
            if let Some(source) = body.error.take() {
                let block = self.blocks.names[index].clone();
                return Err(StepError::Block { time_s, block, source });
            }
        }
        Ok(())
    }

    /// Impulses, work and extremes of the step; t advances.
    fn keep_books(&mut self, contact: ContactReport, iterations: Iterations) -> StepReport {
        let (mut force, mut torque) = (self.loads.force(), Vec3::zeros());
        self.ledger.watch_load(force.norm());
        let (mut impulse, mut orbital) = (Vec3::zeros(), Vec3::zeros());
        let (mut rate2, mut speed_m_s) = (0.0f64, 0.0f64);
        let quadrature = self.quadrature();
        let (mut friction_j, mut motion_j, mut load_j, mut damping_j) = (0.0, 0.0, 0.0, 0.0);
        for (k, body) in self.bodies.iter().enumerate() {
            let report = &body.report;
            self.ledger.blocks().add_ringing(k, &quadrature, &report.drive);
            force += report.reaction - report.motion_impulse / self.part_s;
            torque += report.outside_torque;
            impulse += report.motion_impulse;
            orbital += report.orbital_impulse;
            friction_j += report.friction_work_j;
            motion_j += report.motion_work_j;
            load_j += report.load_work_j;
            damping_j += report.damping_work_j;
            rate2 = rate2.max(report.contact_rate2);
            speed_m_s = speed_m_s.max(report.speed_m_s);
        }
        let travel = self.travel_of_step(speed_m_s);
        let h = self.part_s * rate2.sqrt();
        self.ledger.add_impulse(self.part_s, &self.weights, force, torque);
        self.ledger.add_whole_impulse(impulse, orbital);
        self.ledger.add_work(friction_j, motion_j, load_j, damping_j);
        if self.has_impulses {
            self.book_impulses();
        }
        let contact_work_j = self.book_work_of_contact(&contact);
        if self.loose > 0.0 {
            self.book_squeezing();
        }
        self.book_springs(&contact);
        self.ledger.watch_speeds(speed_m_s, self.unseen_m_s());
        let report = StepReport { contact, h, travel, contact_work_j, iterations };
        self.ledger.watch(&report);
        self.advance_clock();
        report
    }

    /// How this step takes forces.
    fn quadrature(&self) -> Quadrature {
        Quadrature {
            dt_s: self.part_s,
            is_one_sided: self.newton.is_some() || self.integrator.contact_bound().is_none(),
            elastic_lag: self.weights.elastic_lag(),
            judges_pairs: self.weights.forces_do_their_work(),
            is_first: self.steps_done(0.0) == 0.0,
        }
    }

    /// Whether anything touches, and the work of its forces is what changes the energy of blocks.
    fn contact_does_work(&self, contact: &ContactReport) -> bool {
        contact.contact_pairs > 0 && self.weights.forces_do_their_work()
    }

    /// Books what normal contact did in the step on both blocks of each pair; returns the sum of what single facets did, without
    /// sign, where steps are controlled [J].
    fn book_work_of_contact(&mut self, contact: &ContactReport) -> f64 {
        let works = self.contact_does_work(contact);
        let mut contact_work_j = 0.0;
        self.travel.touching.clear();
        let Some(model) = self.contact.as_mut().filter(|_| works) else { return contact_work_j };
        for (moved, x) in self.moved.iter_mut().zip(&self.state.position) {
            *moved = x - *moved;
        }
        let (books, travel) = (self.ledger.blocks(), &mut self.travel);
        model.each_work(&self.blocks, &self.moved, &mut |a, b, work_j| {
            books.add_work(a, b, work_j);
            if travel.notes_touching {
                travel.note_touching(a, b);
                contact_work_j += work_j.abs();
            }
        });
        model.each_coulomb_gap(&self.blocks, &self.moved, &mut |a, b, gap_j| {
            books.add_coulomb_gap(a, b, gap_j);
        });
        books.close_step();
        contact_work_j
    }

    /// Books the slip that shear springs lost in the step.
    fn book_springs(&mut self, contact: &ContactReport) {
        let Some(model) = self.contact.as_ref() else { return };
        let books = self.ledger.blocks();
        if contact.contact_pairs > 0 {
            model.each_spring_slip(&mut |owner, target, spring| {
                books.add_spring_slip(owner, target, spring);
            });
        }
        books.close_springs(self.part_s);
    }

    /// Books the impulses of damping and of prescribed velocities, and how well the step resolves damping.
    fn book_impulses(&mut self) {
        for report in self.bodies.iter().map(|body| &body.report) {
            self.ledger.add_impulses(report.impulse, report.impulse_moment, report.damping_error_m_s);
        }
    }

    /// Books what the step gave blocks that are squeezed.
    fn book_squeezing(&mut self) {
        let books = self.ledger.blocks();
        for (block, body) in self.blocks.ids().zip(&self.bodies) {
            books.add_sideways(block, self.part_s, &body.report.sideways);
        }
    }

    /// Speed that loads and motions bring and take back within the step, where nobody sees it [m/s].
    fn unseen_m_s(&self) -> f64 {
        let (now_s, end_s) = (self.clock_s(0.0), self.clock_s(1.0));
        let motions = self.shapes.iter().flat_map(|shape| &shape.supports.motions);
        let fastest = motions.map(|motion| motion.unseen_m_s(now_s, end_s)).fold(0.0, f64::max);
        self.loads.unseen_m_s().max(fastest)
    }

    /// Where each node was when time began [m].
    pub fn start_position(&self) -> &[Vec3] {
        if self.state.start.is_empty() { &self.blocks.rest_position } else { &self.state.start }
    }

    /// Time begins where the blocks are, with these velocities.
    pub(crate) fn begin_at_rest(&mut self, velocity: Vec<Vec3>) {
        self.state.start = self.state.position.clone();
        self.state.velocity = velocity;
        self.state.acceleration.fill(Vec3::zeros());
        self.state.inertia.fill(Inertia::default());
        self.state.step = 0;
        self.settling = false;
        self.loads.place(0.0, 0.0);
        self.ledger = self.new_ledger((Vec3::zeros(), Vec3::zeros()));
    }

    /// A copy of all that changes.
    pub fn snapshot(&self) -> Snapshot {
        let contact_stiffness =
            if self.contact_has_acted { self.contact_stiffness.clone() } else { Vec::new() };
        Snapshot {
            state: self.state.clone(),
            ledger: self.ledger.clone(),
            stages: self.stages,
            contact_stiffness,
            step_balance: self.control.as_ref().and_then(|control| control.balance()),
        }
    }

    /// Goes on from a snapshot of the same problem, bit for bit.
    ///
    /// # Errors
    /// [`RestoreError`] when it has another number of nodes.
    pub fn restore(&mut self, snapshot: Snapshot) -> Result<(), RestoreError> {
        let expected = self.blocks.rest_position.len();
        let Snapshot { state, ledger, stages, contact_stiffness, step_balance } = snapshot;
        let internal = self.state.internal_force.len();
        for (found, expected) in [
            (state.position.len(), expected),
            (state.velocity.len(), expected),
            (state.acceleration.len(), expected),
            (state.internal_force.len(), internal),
            (state.inertia.len(), self.state.inertia.len()),
            (state.contact_force.len(), self.state.contact_force.len()),
            (ledger.block_count(), self.blocks.len()),
            (
                contact_stiffness.len(),
                if contact_stiffness.is_empty() { 0 } else { self.contact_stiffness.len() },
            ),
        ] {
            if found != expected {
                return Err(RestoreError { found, expected });
            }
        }
        (self.state, self.ledger, self.stages) = (state, ledger, stages);
        self.contact_has_acted = !contact_stiffness.is_empty();
        if self.contact_has_acted {
            self.contact_stiffness = contact_stiffness;
        } else {
            self.contact_stiffness.fill(0.0);
        }
        self.friction_force.fill(Vec3::zeros());
        self.control.iter_mut().for_each(|control| control.restore_balance(step_balance));
        Ok(())
    }

    /// Time [s]: steps done times Δt, never summed.
    pub fn time_s(&self) -> f64 {
        self.steps_done(0.0) * self.base_step_s
    }

    /// Steps done, parts of the present one and some parts ahead included.
    fn steps_done(&self, ahead: f64) -> f64 {
        let StepState { halvings, part, .. } = self.state.control;
        self.state.step as f64 + (f64::from(part) + ahead) * 0.5f64.powi(halvings as i32)
    }

    fn advance_clock(&mut self) {
        let control = &mut self.state.control;
        control.part += 1;
        if control.part == 1 << control.halvings {
            control.part = 0;
            self.state.step += 1;
        }
    }

    /// The integrator's weights for a step Δt [s].
    pub(crate) fn weights_of(&self, dt_s: f64) -> StepWeights {
        step_weights(self.integrator.as_ref(), dt_s, self.newton.is_some())
    }

    /// Time that loads and prescribed motions see, some steps ahead [s]: it stands still while a scene settles.
    pub(crate) fn clock_s(&self, ahead: f64) -> f64 {
        if self.settling { 0.0 } else { self.steps_done(ahead) * self.base_step_s }
    }

    /// Δt [s], the longest where it is controlled.
    pub fn step_s(&self) -> f64 {
        self.base_step_s
    }

    /// Topology and rest shape.
    pub fn blocks(&self) -> &BlockSet {
        &self.blocks
    }

    /// The changing state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Force of the supports on a block in the last step [N]; that of what holds it, for a fixed block.
    pub fn reaction_n(&self, block: BlockId) -> Vec3 {
        self.bodies[block.index()].report.reaction
    }

    /// The shape of a block: operator, supports, factor.
    pub fn shape(&self, block: BlockId) -> &Shape {
        &self.shapes[self.bodies[block.index()].shape]
    }

    /// Number of factored matrices: distinct blocks with unknowns.
    pub fn factors(&self) -> usize {
        self.shapes.iter().filter(|shape| shape.factor.is_some()).count()
    }

    /// Number of unknowns over all blocks.
    pub fn unknowns(&self) -> usize {
        self.blocks.ids().map(|block| self.shape(block).unknowns.len()).sum()
    }

    /// Whether no block is supported, so that momentum can only come from loads.
    pub fn is_closed(&self) -> bool {
        self.shapes.iter().all(Shape::is_free)
    }

    /// The block of each distinct shape whose rotation is inexact because masses are lumped, with the largest part by which its inertia is
    /// too large.
    pub fn lumped_inertia_errors(&self) -> Vec<(BlockId, f64)> {
        let mut seen = vec![false; self.shapes.len()];
        let firsts = self.blocks.ids().zip(&self.bodies);
        let firsts = firsts.filter(|(_, body)| !std::mem::replace(&mut seen[body.shape], true));
        let errors = firsts.map(|(block, body)| (block, self.shapes[body.shape].rotation_error()));
        errors.filter(|(_, error)| *error > 0.0).collect()
    }

    /// Whether any block turns with the inexact inertia of lumped masses.
    pub fn has_lumped_rotation(&self) -> bool {
        self.shapes.iter().any(|shape| shape.rotation_error() > 0.0)
    }

    /// Whether blocks feel each other.
    pub fn has_contact(&self) -> bool {
        self.contact.is_some()
    }

    /// Largest stable h = ω_c Δt; none where contact is solved for, or never stable.
    pub fn contact_bound(&self) -> Option<f64> {
        if self.newton.is_some() { None } else { self.integrator.contact_bound() }
    }

    /// Largest h at which steps resolve contact at predicted positions: the bound, or a third of a contact's half period where
    /// no step is stable; none where contact is solved for.
    pub fn resolved_h(&self) -> Option<f64> {
        if self.newton.is_some() { None } else { Some(self.integrator.contact_bound().unwrap_or(1.0)) }
    }

    /// Whether a loss of energy is wrong: not where an integrator is asked to damp what elastic blocks do, unless contact at
    /// the end of steps takes energy, too.
    pub fn should_keep_energy(&self) -> bool {
        let asked = self.integrator.damps_elasticity();
        let rigid = |shape: &Shape| matches!(shape.kind, BodyKind::Rigid | BodyKind::Fixed);
        self.newton.is_some() || !asked || self.shapes.iter().all(rigid)
    }

    /// Largest speed of the run so far [m/s].
    pub fn largest_speed_m_s(&self) -> f64 {
        self.ledger.largest_speed_m_s()
    }

    /// The worst of the run so far.
    pub fn invariants(&self) -> Invariants {
        self.ledger.invariants()
    }

    /// Seconds per stage so far.
    pub fn stages(&self) -> StageTimes {
        self.stages
    }
}

/// The integrator's weights for a step, contact being taken at its end where it is solved for.
pub(crate) fn step_weights(integrator: &dyn TimeIntegrator, dt_s: f64, solves_contact: bool) -> StepWeights {
    let weights = integrator.weights(dt_s);
    if solves_contact { StepWeights { contact_lead: 1.0, ..weights } } else { weights }
}
