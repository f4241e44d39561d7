//! The problem, the state, and the step that joins them.

use std::mem::take;
use std::time::Instant;

use ndda_contact::{
    Body as ContactBody, ContactError, ContactInput, ContactModel, ContactOutput, ContactReport,
};
use ndda_fem::Table;
use ndda_fem::loads::{add_gravity, add_traction};
use ndda_fem::stress::{cauchy_stress, smallest_volume_ratio};
use ndda_mesh::{BlockId, BlockSet, TetId, TriangleId, Vec3};
use serde::{Deserialize, Serialize};

use crate::batch::{Batch, ENOUGH_TOGETHER, solve_together};
use crate::body::{BlockError, BlockReport, Body, BodyKind, Motion, StepContext};
use crate::elastic_body::ElasticBody;
use crate::end_contact::{EndContact, Iterations, Newton};
use crate::fixed_body::FixedBody;
use crate::for_each_block::{NodeSlices, Runs, each_of_run, for_each_run};
use crate::ledger::{Invariants, Ledger, Sample};
use crate::linear_solver::{EIGHT, FactorError, LinearSolver};
use crate::loads::{Loads, VaryingLoad};
use crate::rigid_body::RigidBody;
use crate::shape::{BodySetup, Mass, SetupError, Shape};
use crate::state::State;
use crate::step_control::{AutoStep, Control, StepState};
use crate::time_integrator::{Inertia, StepDamping, StepWeights, TimeIntegrator};

/// Nodes per half below which a second thread costs more than it brings.
pub(crate) const GRAIN_NODES: usize = 400;

/// Everything a simulation is made of.
pub struct Setup {
    /// Topology and rest shape.
    pub blocks: BlockSet,
    /// One entry per block.
    pub bodies: Vec<BodySetup>,
    /// g [m/s²].
    pub gravity_m_s2: Vec3,
    /// Factor of gravity over time; constant without.
    pub gravity_factor: Option<Table>,
    /// How mass is shared among nodes.
    pub mass: Mass,
    /// Δt [s].
    pub step_s: f64,
    /// Time integrator.
    pub integrator: Box<dyn TimeIntegrator>,
    /// Contact; `None` where blocks do not feel each other.
    pub contact: Option<Box<dyn ContactModel>>,
    /// Contact at the end of the step, solved for; at predicted positions without.
    pub end_contact: Option<EndContact>,
    /// Linear solver.
    pub solver: Box<dyn LinearSolver>,
    /// Steps as short as they have to be, `step_s` being the longest; always `step_s` without.
    pub auto_step: Option<AutoStep>,
}

/// What one step found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Contact at x*.
    pub contact: ContactReport,
    /// h = ω_c Δt, ω_c² taken as the largest row sum of contact's stiffness over the node's lumped mass.
    pub h: f64,
    /// Travel of the step over the smallest tet height of the block, largest over the blocks.
    pub travel_ratio: f64,
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

/// Why a run stops.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    /// Contact could not be computed.
    #[error("at t = {time_s} s: {source}")]
    Contact {
        /// Time [s].
        time_s: f64,
        /// The cause.
        source: ContactError,
    },
    /// However short a step, it asks for more than it may.
    #[error(
        "at t = {time_s} s: contact is too stiff or too fast even for steps of {step_s:e} s: reduce the penalty, refine \
         the mesh less, or allow more halvings"
    )]
    NoStepIsShortEnough {
        /// Time [s].
        time_s: f64,
        /// Δt [s].
        step_s: f64,
    },
    /// The equations of a shorter step cannot be factored.
    #[error("for steps of {step_s:e} s: {source}")]
    Factor {
        /// Δt [s].
        step_s: f64,
        /// What is wrong with them.
        source: FactorError,
    },
    /// Newton's method did not find the contact forces at the end of a step.
    #[error(
        "at t = {time_s} s: contact at the end of the step is not solved for after {iterations} evaluations \
         (residual {residual:e}): reduce step_s, or raise the tolerance"
    )]
    ContactNotSolved {
        /// Time [s].
        time_s: f64,
        /// Evaluations of contact.
        iterations: u32,
        /// Misfit of contact forces over the largest of contact forces and loads.
        residual: f64,
    },
    /// A block is past the depth at which contact pushes it out (invariant I5).
    #[error(
        "at t = {time_s} s: triangle {} of block `{contactor}` is past the centroid of tet {} of block `{target}`, \
         where the contact potential no longer pushes it out: raise penalty_pa or reduce step_s", triangle.0, tet.0
    )]
    PastCentroid {
        /// Time [s].
        time_s: f64,
        /// Name of the block that went in.
        contactor: String,
        /// Its boundary triangle.
        triangle: TriangleId,
        /// Name of the block that it went into.
        target: String,
        /// The tetrahedron.
        tet: TetId,
    },
    /// A block could not take the step.
    #[error("at t = {time_s} s: block `{block}`: {source}")]
    Block {
        /// Time [s].
        time_s: f64,
        /// Name of the block.
        block: String,
        /// The cause.
        source: BlockError,
    },
    /// A scene that was to settle first does not.
    #[error(
        "the scene has not settled in {steps} steps (speed {speed_ratio:e} of the largest): raise settle.most_steps or \
         settle.tolerance, or see whether anything holds it"
    )]
    NotSettled {
        /// Steps done.
        steps: u64,
        /// Speed left over the largest speed.
        speed_ratio: f64,
    },
    /// An element is inside out (invariant I7).
    #[error(
        "at t = {time_s} s: tet {} of block `{block}` is inverted (det F = {volume_ratio:e}): reduce step_s or the load",
        tet.0
    )]
    Inverted {
        /// Time [s].
        time_s: f64,
        /// Name of the block.
        block: String,
        /// The tetrahedron.
        tet: TetId,
        /// det F.
        volume_ratio: f64,
    },
}

/// A problem on its way through time.
pub struct Simulation {
    pub(crate) blocks: BlockSet,
    pub(crate) shapes: Vec<Shape>,
    pub(crate) bodies: Vec<Body>,
    pub(crate) runs: Runs,
    pub(crate) state: State,
    /// Δt of a whole step, and of the parts that it is done in.
    pub(crate) base_step_s: f64,
    pub(crate) step_s: f64,
    control: Option<Box<Control>>,
    pub(crate) settling: bool,
    integrator: Box<dyn TimeIntegrator>,
    pub(crate) weights: StepWeights,
    pub(crate) contact: Option<Box<dyn ContactModel>>,
    newton: Option<Box<Newton>>,
    pub(crate) ledger: Ledger,
    stages: StageTimes,
    pub(crate) loads: Loads,
    pub(crate) force: Vec<Vec3>,
    friction_force: Vec<Vec3>,
    pub(crate) contact_stiffness: Vec<f64>,
    pub(crate) contact_position: Vec<Vec3>,
    pub(crate) contact_bodies: Vec<ContactBody>,
}

impl Simulation {
    /// Assembles, factors each distinct block once, and sets the state at t = 0.
    ///
    /// # Errors
    /// [`SetupError`] naming the block whose supports or equations are at fault.
    pub fn new(setup: Setup) -> Result<Self, SetupError> {
        let Setup {
            blocks,
            bodies,
            gravity_m_s2,
            gravity_factor,
            mass,
            step_s,
            integrator,
            contact,
            end_contact,
            solver,
            auto_step,
        } = setup;
        let weights = step_weights(integrator.as_ref(), step_s, end_contact.is_some());
        let mut shapes: Vec<Shape> = Vec::new();
        let mut shape_of = Vec::with_capacity(blocks.len());
        for (block, body) in blocks.ids().zip(&bodies) {
            let known = shapes.iter().position(|shape| shape.fits(&blocks, block, body));
            shape_of.push(known.unwrap_or(shapes.len()));
            if known.is_none() {
                shapes.push(Shape::new(&blocks, block, body, mass, (step_s, &weights), solver.as_ref())?);
            }
        }
        let nodes = blocks.rest_position.len();
        // Contact between fewer than two blocks is left out altogether.
        let contact = contact.filter(|_| blocks.len() > 1);
        let friction_nodes = if contact.as_ref().is_some_and(|c| c.has_friction()) { nodes } else { 0 };
        let end_contact = end_contact.filter(|_| contact.is_some());
        let newton_nodes = if end_contact.is_some() { nodes } else { 0 };
        let contact_nodes = if contact.is_some() { nodes } else { 0 };
        let mut simulation = Self {
            state: State {
                step: 0,
                control: StepState::default(),
                start: Vec::new(),
                position: blocks.rest_position.clone(),
                velocity: vec![Vec3::zeros(); nodes],
                acceleration: vec![Vec3::zeros(); nodes],
                internal_force: vec![Vec3::zeros(); if weights.stiffness < 1.0 { nodes } else { 0 }],
                inertia: vec![Inertia::default(); if weights.needs_acceleration { blocks.len() } else { 0 }],
                contact_force: vec![Vec3::zeros(); newton_nodes],
                contact: Default::default(),
            },
            newton: end_contact.map(|settings| Box::new(Newton::new(settings, nodes, blocks.len()))),
            bodies: Vec::with_capacity(blocks.len()),
            runs: Runs::single(0),
            loads: Loads::new(Vec::new(), Vec::new()),
            force: vec![Vec3::zeros(); nodes],
            friction_force: vec![Vec3::zeros(); friction_nodes],
            contact_stiffness: vec![0.0; contact_nodes],
            contact_position: blocks.rest_position.clone(),
            contact_bodies: Vec::new(),
            ledger: Ledger::new((Vec3::zeros(), Vec3::zeros())),
            stages: StageTimes::default(),
            blocks,
            shapes,
            base_step_s: step_s,
            step_s,
            control: None,
            settling: false,
            integrator,
            weights,
            contact,
        };
        for (block, body) in simulation.blocks.ids().zip(&bodies) {
            simulation.add_body(block, shape_of[block.index()], body);
        }
        let shapes = &simulation.shapes;
        let solved = |block: usize| shapes[shape_of[block]].factor.is_some();
        let alike = |a: usize, b: usize| shape_of[a] == shape_of[b] && solved(a);
        simulation.runs = Runs::of_alike(shape_of.len(), EIGHT, alike);
        for run in simulation.runs.ranges().filter(|run| run.len() >= ENOUGH_TOGETHER) {
            let factor = shapes[shape_of[run.start]].factor.as_deref();
            simulation.bodies[run.start].batch = factor.map(|factor| Box::new(Batch::new(factor)));
        }
        simulation.add_loads(&bodies, &gravity_m_s2, gravity_factor);
        if simulation.contact.as_ref().is_some_and(|c| c.needs_bodies()) {
            let bodies = simulation.blocks.ids().map(|block| simulation.shape(block).contact_body());
            simulation.contact_bodies = bodies.collect();
        }
        simulation.open_books(solver.as_ref())?;
        if let Some(settings) = auto_step {
            let control = Control::new(settings, solver, &simulation.state, &simulation.ledger);
            simulation.control = Some(Box::new(control));
        }
        Ok(simulation)
    }

    fn add_body(&mut self, block: BlockId, shape_index: usize, setup: &BodySetup) {
        let range = self.blocks.nodes_of(block);
        let rest = &self.blocks.rest_position[range.clone()];
        let shape = &self.shapes[shape_index];
        let center = shape.operator.center(rest);
        for (v, x) in self.state.velocity[range.clone()].iter_mut().zip(rest) {
            *v = setup.velocity_m_s + setup.spin_rad_s.cross(&(x - center));
        }
        let motion = match shape.kind {
            BodyKind::Elastic | BodyKind::Affine => {
                let body = ElasticBody::new(shape, setup.initial_stress.as_ref(), rest);
                let internal = self.state.internal_force.get_mut(range.clone()).unwrap_or_default();
                if let Some(initial) = &body.initial_force {
                    internal.iter_mut().zip(initial).for_each(|(f, initial)| *f = *initial);
                }
                Motion::Elastic(Box::new(body))
            }
            BodyKind::Rigid => Motion::Rigid(RigidBody::new(shape)),
            BodyKind::Fixed => {
                self.state.velocity[range].fill(Vec3::zeros());
                Motion::Fixed(FixedBody::new(shape, rest))
            }
        };
        let report = BlockReport::default();
        self.bodies.push(Body { shape: shape_index, motion, report, error: None, batch: None });
        if shape.kind == BodyKind::Affine && !shape.is_free() {
            let velocity = &mut self.state.velocity[self.blocks.nodes_of(block)];
            shape.unknowns.restrict(&shape.operator.node_mass, velocity);
            return;
        }
        for held in &shape.supports.held {
            let v = &mut self.state.velocity[self.blocks.nodes_of(block).start + held.node as usize];
            for n in &held.held {
                *v -= n * n.dot(v);
            }
        }
    }

    /// Gathers gravity, tractions and forces: those that vary each by itself, the others in one sum.
    fn add_loads(&mut self, bodies: &[BodySetup], gravity_m_s2: &Vec3, gravity_factor: Option<Table>) {
        let mut constant = vec![Vec3::zeros(); self.blocks.rest_position.len()];
        let mut weight = constant.clone();
        let mut varying = Vec::new();
        for (block, setup) in self.blocks.ids().zip(bodies) {
            let range = self.blocks.nodes_of(block);
            let rest = &self.blocks.rest_position[range.clone()];
            add_gravity(&self.shape(block).operator, gravity_m_s2, &mut weight[range.clone()]);
            let mut add = |forces: Vec<Vec3>, factor: &Option<Table>| match factor {
                None => constant[range.clone()].iter_mut().zip(forces).for_each(|(sum, f)| *sum += f),
                Some(factor) => varying.push(VaryingLoad::new(range.start, &forces, factor.clone())),
            };
            for traction in &setup.tractions {
                let mut forces = vec![Vec3::zeros(); rest.len()];
                add_traction(&traction.triangles, rest, &traction.traction_pa, &mut forces);
                add(forces, &traction.factor);
            }
            for force in &setup.forces {
                let mut forces = vec![Vec3::zeros(); rest.len()];
                forces[force.node as usize] = force.force_n;
                add(forces, &force.factor);
            }
        }
        match gravity_factor {
            None => constant.iter_mut().zip(weight).for_each(|(sum, f)| *sum += f),
            Some(factor) => varying.push(VaryingLoad::new(0, &weight, factor)),
        }
        self.loads = Loads::new(constant, varying);
    }

    /// Total load at the start, and accelerations at the start for integrators that need them: M a = f − ∫Bᵀσ₀, contact
    /// being part of f.
    fn open_books(&mut self, solver: &dyn LinearSolver) -> Result<(), SetupError> {
        self.ledger = Ledger::new(self.loads.resultant(&self.state.position));
        if !self.weights.needs_acceleration {
            return Ok(());
        }
        let untouched = self.state.contact.clone();
        self.force.copy_from_slice(self.loads.total());
        self.add_contact_forces(None).map_err(Box::new)?;
        self.state.contact = untouched;
        let mass_only = StepWeights { stiffness: 0.0, mass_per_s2: 1.0, ..self.weights };
        for block in self.blocks.ids() {
            let body = &mut self.bodies[block.index()];
            let shape = &self.shapes[body.shape];
            let range = self.blocks.nodes_of(block);
            let mut load = self.force[range.clone()].to_vec();
            if shape.kind == BodyKind::Rigid {
                let force: Vec3 = load.iter().sum();
                self.state.acceleration[range.clone()].fill(force / shape.operator.mass_kg);
                let torque = load.iter().zip(&self.state.position[range]).map(|(f, x)| x.cross(f)).sum();
                self.state.inertia[block.index()] = Inertia { force, torque };
                continue;
            }
            let Some(elastic) = body.elastic().filter(|_| !shape.unknowns.is_empty()) else { continue };
            if let Some(initial) = &elastic.initial_force {
                load.iter_mut().zip(initial).for_each(|(l, f)| *l -= f);
            }
            let matrix =
                shape.unknowns.matrix(&shape.operator, &shape.supports, &mass_only, &StepDamping::default());
            let factor = solver.factor(&matrix).map_err(|source| SetupError::Factor {
                block: self.blocks.names[block.index()].clone(),
                source,
            })?;
            let mut rhs = vec![0.0; factor.unknowns()];
            shape.unknowns.gather(&load, &mut rhs);
            factor.solve_in_place(&mut rhs, &mut factor.new_scratch()).map_err(|source| {
                SetupError::Solve { block: self.blocks.names[block.index()].clone(), source }
            })?;
            shape.unknowns.scatter(&rhs, &mut self.state.acceleration[range.clone()]);
            let (position, acceleration) =
                (&self.state.position[range.clone()], &self.state.acceleration[range]);
            self.state.inertia[block.index()] = Inertia {
                force: shape.operator.momentum(acceleration),
                torque: shape.operator.angular_momentum(&Vec3::zeros(), position, acceleration),
            };
        }
        Ok(())
    }

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
        let (contact, iterations) = self.gather_contact()?;
        let contact_done = Instant::now();
        self.solve_blocks()?;
        let solved = Instant::now();
        let report = self.keep_books(contact, iterations);
        self.stages.contact_s += (contact_done - started).as_secs_f64();
        self.stages.blocks_s += (solved - contact_done).as_secs_f64();
        self.stages.ledger_s += solved.elapsed().as_secs_f64();
        Ok(report)
    }

    /// f ← gravity, tractions and forces at the time at which the integrator takes them.
    fn gather_loads(&mut self) {
        self.loads.place(self.clock_s(self.weights.load_lead));
        self.force.copy_from_slice(self.loads.total());
    }

    /// f ← loads and contact, at predicted positions or at the end of the step.
    fn gather_contact(&mut self) -> Result<(ContactReport, Iterations), StepError> {
        let Some(mut newton) = self.newton.take() else {
            self.place_contact();
            let report = self.add_contact_forces(None)?;
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
        let lead = self.weights.contact_lead * self.step_s;
        let moving = self.state.position.iter().zip(&self.state.velocity);
        for (place, (x, v)) in self.contact_position.iter_mut().zip(moving) {
            *place = x + lead * v;
        }
        let lead = self.weights.contact_lead_acceleration * self.step_s * self.step_s;
        if lead != 0.0 {
            let accelerations = self.contact_position.iter_mut().zip(&self.state.acceleration);
            accelerations.for_each(|(place, a)| *place += lead * a);
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
            body.center = motion.center;
            body.velocity_m_s = motion.velocity_m_s;
            body.spin_rad_s = motion.spin_rad_s;
            if held {
                if shape.kind == BodyKind::Fixed {
                    // Where it goes in this step is known already.
                    let at = |time_s: f64| shape.supports.motions[0].displacement(time_s);
                    body.velocity_m_s = (at(end_s) - at(now_s)) / self.step_s;
                }
                continue;
            }
            body.inverse_inertia = motion.inverse_inertia;
            (body.load_n, body.torque_n_m) = (Vec3::zeros(), Vec3::zeros());
            for (x, load) in position.iter().zip(&self.loads.total()[range]) {
                body.push(x, load);
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
        let Some(model) = &mut self.contact else { return Ok(ContactReport::default()) };
        self.friction_force.fill(Vec3::zeros());
        self.contact_stiffness.fill(0.0);
        let input = ContactInput {
            blocks: &self.blocks,
            position: &self.contact_position,
            velocity: facet_velocity.filter(|_| !model.needs_bodies()).unwrap_or(&self.state.velocity),
            dt_s: self.step_s,
            bodies: &self.contact_bodies,
        };
        let mut output = ContactOutput {
            force: &mut self.force,
            friction_force: &mut self.friction_force,
            stiffness: &mut self.contact_stiffness,
        };
        let report = model.add_forces(&input, &mut self.state.contact, &mut output);
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

    /// What block `index` needs to know of a step.
    pub(crate) fn context(&self, index: usize) -> StepContext<'_> {
        let range = self.blocks.nodes_of(BlockId(index as u32));
        StepContext {
            integrator: self.integrator.as_ref(),
            weights: self.weights,
            dt_s: self.step_s,
            time_s: self.clock_s(0.0),
            end_s: self.clock_s(1.0),
            contact_position: &self.contact_position[range.clone()],
            force: &self.force[range.clone()],
            external: &self.loads.total()[range.clone()],
            changing: self.loads.changing().get(range.clone()).unwrap_or(&[]),
            friction_force: self.friction_force.get(range.clone()).unwrap_or(&[]),
            contact_stiffness: self.contact_stiffness.get(range).unwrap_or(&[]),
            inertia: self.state.inertia.get(index).copied().unwrap_or_default(),
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
                body.prepare(&self.shapes[body.shape], &self.context(index), &nodes.view());
            });
            solve_together(&self.shapes[run[0].shape], run);
        }
        each_of_run(first, run, starts, slices, |index, body: &mut Body, nodes| {
            let (shape, context) = (&self.shapes[body.shape], self.context(index));
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
        let (mut rate2, mut travel_ratio) = (0.0f64, 0.0f64);
        let (mut friction_j, mut motion_j, mut load_j, mut damping_j) = (0.0, 0.0, 0.0, 0.0);
        for body in &self.bodies {
            let report = &body.report;
            force += report.reaction;
            torque += report.outside_torque;
            friction_j += report.friction_work_j;
            motion_j += report.motion_work_j;
            load_j += report.load_work_j;
            damping_j += report.damping_work_j;
            rate2 = rate2.max(report.contact_rate2);
            let height_m = self.shapes[body.shape].smallest_height_m;
            travel_ratio = travel_ratio.max(report.speed_m_s * self.step_s / height_m);
        }
        let h = self.step_s * rate2.sqrt();
        self.ledger.add_impulse(self.step_s, &self.weights, force, torque);
        self.ledger.add_work(friction_j, motion_j, load_j, damping_j);
        self.ledger.watch(&contact, h, travel_ratio);
        self.ledger.note_iterations(iterations.newton);
        self.advance_clock();
        StepReport { contact, h, travel_ratio, iterations }
    }

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
            let input = ContactInput::new(&self.blocks, position, velocity, self.step_s);
            let energy_j = model.energy_j(&input, &self.state.contact);
            sample.contact_j = energy_j.map_err(|source| StepError::Contact { time_s, source })?;
        }
        let sample = self.ledger.balance(sample);
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
        self.loads.place(0.0);
        self.ledger = Ledger::new(self.loads.resultant(&self.state.position));
    }

    /// A copy of all that changes.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot { state: self.state.clone(), ledger: self.ledger.clone(), stages: self.stages }
    }

    /// Goes on from a snapshot of the same problem, bit for bit.
    ///
    /// # Errors
    /// [`RestoreError`] when it has another number of nodes.
    pub fn restore(&mut self, snapshot: Snapshot) -> Result<(), RestoreError> {
        let expected = self.blocks.rest_position.len();
        let Snapshot { state, ledger, stages } = snapshot;
        let internal = self.state.internal_force.len();
        for (found, expected) in [
            (state.position.len(), expected),
            (state.velocity.len(), expected),
            (state.acceleration.len(), expected),
            (state.internal_force.len(), internal),
            (state.inertia.len(), self.state.inertia.len()),
            (state.contact_force.len(), self.state.contact_force.len()),
        ] {
            if found != expected {
                return Err(RestoreError { found, expected });
            }
        }
        (self.state, self.ledger, self.stages) = (state, ledger, stages);
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

    /// Whether blocks feel each other.
    pub fn has_contact(&self) -> bool {
        self.contact.is_some()
    }

    /// Largest stable h = ω_c Δt; none where contact is solved for, or never stable.
    pub fn contact_bound(&self) -> Option<f64> {
        if self.newton.is_some() { None } else { self.integrator.contact_bound() }
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

fn step_weights(integrator: &dyn TimeIntegrator, dt_s: f64, solves_contact: bool) -> StepWeights {
    let weights = integrator.weights(dt_s);
    if solves_contact { StepWeights { contact_lead: 1.0, ..weights } } else { weights }
}
