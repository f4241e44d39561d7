//! From what a scene brings to a simulation at t = 0.

mod accelerations;

use std::collections::HashMap;

use ndda_contact::ContactModel;
use ndda_fem::Table;
use ndda_fem::loads::{add_gravity, add_traction};
use ndda_mesh::{BlockId, BlockSet, Mat3, Vec3};

use crate::bodies::batch::{Batch, ENOUGH_TOGETHER};
use crate::bodies::body::{Body, Motion};
use crate::bodies::congruent_groups::CongruentGroups;
use crate::bodies::elastic_body::{ElasticBody, Kept};
use crate::bodies::fixed_body::FixedBody;
use crate::bodies::kind::BodyKind;
use crate::bodies::prototype::{BodySetup, Mass, Prototype};
use crate::bodies::report::BlockReport;
use crate::bodies::rigid_body::RigidBody;
use crate::bodies::workspaces::{MANY, Workspaces};
use crate::bolts::memory::BoltMemory;
use crate::bolts::setup::BoltSetup;
use crate::diagnostics::block_diagnostics::BlockDiagnostics;
use crate::diagnostics::ledger::Ledger;
use crate::error::SetupError;
use crate::integrators::time_integrator::{Inertia, StepWeights, TimeIntegrator};
use crate::linear::linear_solver::{LinearSolver, MULTI};
use crate::step::clock::step_weights;
use crate::step::contact_moments::ContactMoments;
use crate::step::control::{AutoStep, Control};
use crate::step::follower::{FollowerPressure, Places};
use crate::step::implicit_contact::{ImplicitContact, Newton};
use crate::step::loads::{Loads, VaryingLoad};
use crate::step::ranks::Ranks;
use crate::step::report::StageTimes;
use crate::step::state::State;
use crate::step::state::StepState;
use crate::step::travel::Travel;
use crate::step::{Audit, Problem, Scratch, Simulation};

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
    pub implicit_contact: Option<ImplicitContact>,
    /// Linear solver.
    pub solver: Box<dyn LinearSolver>,
    /// Steps as short as they have to be, `step_s` being the longest; always `step_s` without.
    pub auto_step: Option<AutoStep>,
    /// Rock bolts.
    pub bolts: Vec<BoltSetup>,
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
            implicit_contact,
            solver,
            auto_step,
            bolts,
        } = setup;
        let weights = step_weights(integrator.as_ref(), step_s, implicit_contact.is_some());
        let (shapes, shape_of) =
            distinct_shapes(&blocks, &bodies, mass, (step_s, &weights), solver.as_ref())?;
        let nodes = blocks.rest_position.len();
        let heights = shapes.iter().map(|shape| shape.smallest_height_m);
        let smallest_height_m = heights.fold(f64::INFINITY, f64::min);
        // Contact between fewer than two blocks is left out altogether.
        let contact = contact.filter(|_| blocks.len() > 1);
        let friction_nodes = if contact.as_ref().is_some_and(|c| c.has_friction()) { nodes } else { 0 };
        let implicit_contact = implicit_contact.filter(|_| contact.is_some());
        let newton_nodes = if implicit_contact.is_some() { nodes } else { 0 };
        let contact_nodes = if contact.is_some() || !bolts.is_empty() { nodes } else { 0 };
        let mut simulation = Self {
            state: state_at_rest(&blocks, &weights, newton_nodes),
            bodies: Vec::with_capacity(blocks.len()),
            loads: Loads::none(),
            newton: implicit_contact.map(|settings| Box::new(Newton::new(settings, nodes, blocks.len()))),
            contact_moments: None,
            bolts: None,
            part_s: step_s,
            weights,
            control: None,
            settling: None,
            stage: None,
            ranks: Ranks::default(),
            scratch: Scratch {
                force: vec![Vec3::zeros(); nodes],
                friction_force: vec![Vec3::zeros(); friction_nodes],
                contact_stiffness: vec![0.0; contact_nodes],
                contact_position: blocks.rest_position.clone(),
                moved: vec![Vec3::zeros(); contact_nodes],
                ..Scratch::default()
            },
            audit: audit_of(smallest_height_m),
            problem: Problem {
                has_impulses: shapes.iter().any(Prototype::has_impulses),
                min_friction_coefficient: contact
                    .as_ref()
                    .map_or(0.0, |model| model.min_friction_coefficient()),
                affine: Vec::new(),
                runs: CongruentGroups::single(0),
                blocks,
                workspaces: workspaces(&shapes, &shape_of, newton_nodes > 0),
                shapes,
                base_step_s: step_s,
                gravity_m_s2,
                gravity_factor: gravity_factor.clone(),
                integrator,
                solver,
            },
            contact,
        };
        for (block, body) in simulation.problem.blocks.ids().zip(&bodies) {
            simulation.add_body(block, shape_of[block.index()], body);
        }
        simulation.group_congruent(&shape_of);
        simulation.add_loads(&bodies, &gravity_m_s2, gravity_factor);
        simulation.set_bolts(&bolts)?;
        simulation.prepare_contact();
        let loads = simulation.loads.total().to_vec();
        simulation.keep_static_reactions(&loads).map_err(Box::new)?;
        simulation.open_ledger()?;
        if let Some(settings) = auto_step {
            let control = Control::new(settings, &simulation.state, &simulation.audit.ledger);
            simulation.control = Some(Box::new(control));
            simulation.audit.travel.notes_touching = true;
        }
        Ok(simulation)
    }

    /// Notes which blocks are affine, their bodies where friction acts on velocities, and their moments where contact and bolts act at one end of the step.
    fn prepare_contact(&mut self) {
        if self.contact.is_some() {
            let kinds = self.problem.blocks.ids().map(|block| self.shape(block).kind);
            self.problem.affine = kinds.map(BodyKind::is_affine).collect();
        }
        if self.contact.as_ref().is_some_and(|c| c.needs_bodies()) {
            let bodies = self.problem.blocks.ids().map(|block| self.shape(block).contact_body());
            self.scratch.contact_bodies = bodies.collect();
        }
        let acts = self.contact.is_some() || self.has_bolts();
        if acts && !self.weights.contact_in_the_middle() {
            let shapes = self.problem.blocks.ids().map(|block| self.shape(block));
            self.contact_moments = Some(Box::new(ContactMoments::new(shapes)));
        }
    }

    /// Runs of congruent neighbours, solved for together.
    fn group_congruent(&mut self, shape_of: &[usize]) {
        let shapes = &self.problem.shapes;
        let congruent =
            |a: usize, b: usize| shape_of[a] == shape_of[b] && shapes[shape_of[a]].factor.is_some();
        self.problem.runs = CongruentGroups::group(shape_of.len(), MULTI, congruent);
        let has_workspaces = |shape: usize| self.problem.workspaces[shape].is_some();
        for run in self.problem.runs.ranges().filter(|run| run.len() >= ENOUGH_TOGETHER) {
            if has_workspaces(shape_of[run.start]) {
                continue;
            }
            let factor = shapes[shape_of[run.start]].factor.as_deref();
            self.bodies[run.start].batch = factor.map(|factor| Box::new(Batch::new(factor)));
        }
    }

    /// A block at its start.
    fn add_body(&mut self, block: BlockId, shape_index: usize, setup: &BodySetup) {
        let range = self.problem.blocks.nodes_of(block);
        let rest = &self.problem.blocks.rest_position[range.clone()];
        let shape = &self.problem.shapes[shape_index];
        let center = shape.operator.center(rest);
        for (v, x) in self.state.velocity[range.clone()].iter_mut().zip(rest) {
            *v = setup.velocity_m_s + setup.spin_rad_s.cross(&(x - center));
        }
        let motion = match shape.kind {
            BodyKind::Elastic | BodyKind::Affine => {
                let kept = Kept::new(shape, setup.initial_stress.as_ref(), rest);
                let internal = self.state.internal_force.get_mut(range.clone()).unwrap_or_default();
                if let Some(initial) = &kept.initial_force {
                    internal.iter_mut().zip(initial).for_each(|(f, initial)| *f = *initial);
                }
                match self.problem.workspaces[shape_index] {
                    Some(_) => Motion::Resting(kept),
                    None => Motion::Elastic(Box::new(ElasticBody::new(shape, kept))),
                }
            }
            BodyKind::Rigid => Motion::Rigid(RigidBody::new(shape)),
            BodyKind::Fixed => Motion::Fixed(FixedBody::new(shape, rest)),
        };
        let report = BlockReport::default();
        self.bodies.push(Body { shape: shape_index, motion, report, error: None, batch: None });
        if shape.kind == BodyKind::Fixed {
            // It moves as prescribed from the start: contact is evaluated ahead of where it is, and facets slip by its velocity.
            let nodes = self.problem.blocks.nodes_of(block);
            let motion = shape.supports.motions.last();
            self.state.velocity[nodes].fill(motion.map_or_else(Vec3::zeros, |motion| motion.velocity(0.0)));
            return;
        }
        let nodes = self.problem.blocks.nodes_of(block);
        shape.stop_held(&Mat3::identity(), &mut self.state.velocity[nodes]);
    }

    /// Gathers gravity, tractions, forces and pressures: those that vary each by itself, the others in one sum.
    fn add_loads(&mut self, bodies: &[BodySetup], gravity_m_s2: &Vec3, gravity_factor: Option<Table>) {
        let mut constant = vec![Vec3::zeros(); self.problem.blocks.rest_position.len()];
        let mut weight = constant.clone();
        let (mut varying, mut pressures) = (Vec::new(), Vec::new());
        for (block, setup) in self.problem.blocks.ids().zip(bodies) {
            let range = self.problem.blocks.nodes_of(block);
            let rest = &self.problem.blocks.rest_position[range.clone()];
            let movable = self.shape(block).kind != BodyKind::Fixed;
            let mass_kg = if movable { self.shape(block).operator.mass_kg } else { f64::INFINITY };
            add_gravity(&self.shape(block).operator, gravity_m_s2, &mut weight[range.clone()]);
            let mut add = |forces: Vec<Vec3>, factor: &Option<Table>| match factor {
                None => constant[range.clone()].iter_mut().zip(forces).for_each(|(sum, f)| *sum += f),
                Some(factor) => {
                    let pace_m_s2 = forces.iter().map(|f| f.norm()).sum::<f64>() / mass_kg;
                    varying.push(VaryingLoad::new(range.start, &forces, factor.clone(), pace_m_s2));
                }
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
            for pressure in &setup.pressures {
                let first = range.start as u32;
                let triangles = pressure.triangles.iter().map(|t| t.map(|n| first + n)).collect();
                let load = (pressure.field.clone(), pressure.factor.clone());
                pressures.push(FollowerPressure::new(
                    triangles,
                    load,
                    &self.problem.blocks.rest_position,
                    mass_kg,
                ));
            }
        }
        let beyond_weight =
            !pressures.is_empty() || !varying.is_empty() || constant.iter().any(|f| *f != Vec3::zeros());
        match gravity_factor {
            None => constant.iter_mut().zip(weight).for_each(|(sum, f)| *sum += f),
            Some(factor) => varying.push(VaryingLoad::new(0, &weight, factor, gravity_m_s2.norm())),
        }
        let State { position, velocity, .. } = &self.state;
        let rest = Places { position, velocity, lead_s: 0.0 };
        let starts = self.problem.blocks.node_starts().to_vec();
        self.loads = Loads::new(constant, varying, pressures, (starts, rest));
        self.loads.beyond_weight = beyond_weight;
    }

    /// Opens the ledger, with the accelerations at the start for integrators that need them.
    fn open_ledger(&mut self) -> Result<(), SetupError> {
        if self.weights.needs_acceleration {
            self.place_accelerations()?;
        }
        self.audit.ledger = self.new_ledger(self.outside_at_start());
        Ok(())
    }

    /// An empty ledger; `start` is the force and torque from outside before the first step.
    pub(crate) fn new_ledger(&self, start: (Vec3, Vec3)) -> Ledger {
        let scales = self.problem.blocks.ids().map(|block| self.shape(block).scale()).collect();
        Ledger::new(start, BlockDiagnostics::new(scales, self.newton.is_some()), self.slow_m_s())
    }

    /// Force and torque from outside at the start, as blocks report them: torques of loads about the mass centre of free blocks, all
    /// torques about the origin of others.
    fn outside_at_start(&self) -> (Vec3, Vec3) {
        let (mut force, mut torque) = (Vec3::zeros(), Vec3::zeros());
        for (block, inertia) in self.problem.blocks.ids().zip(&self.state.inertia) {
            let (shape, nodes) = (self.shape(block), self.problem.blocks.nodes_of(block));
            force += inertia.force - inertia.contact;
            if shape.is_free() {
                let position = &self.state.position[nodes.clone()];
                let center = shape.operator.center(position);
                let loads = position.iter().zip(&self.loads.total()[nodes]);
                torque += loads.map(|(x, load)| (x - center).cross(load)).sum::<Vec3>();
            } else {
                torque += inertia.torque;
            }
        }
        (force, torque)
    }
}

/// Blocks as they are meshed, at rest and without forces.
fn state_at_rest(blocks: &BlockSet, weights: &StepWeights, newton_nodes: usize) -> State {
    let nodes = blocks.rest_position.len();
    let zeros = |is_needed: bool| vec![Vec3::zeros(); if is_needed { nodes } else { 0 }];
    State {
        step: 0,
        control: StepState::default(),
        start: Vec::new(),
        position: blocks.rest_position.clone(),
        velocity: zeros(true),
        acceleration: zeros(true),
        internal_force: zeros(weights.stiffness < 1.0),
        inertia: vec![Inertia::default(); if weights.needs_acceleration { blocks.len() } else { 0 }],
        contact_force: vec![Vec3::zeros(); newton_nodes],
        contact_offset: Vec::new(),
        driving_force: Vec::new(),
        kept_force: Vec::new(),
        contact: Default::default(),
        bolts: BoltMemory::default(),
    }
}

/// Diagnostics before the first step, of blocks whose smallest tetrahedron has this height [m].
fn audit_of(smallest_height_m: f64) -> Audit {
    Audit {
        ledger: Ledger::new(Default::default(), BlockDiagnostics::default(), 0.0),
        step_sums: Default::default(),
        stages: StageTimes::default(),
        travel: Travel::new(smallest_height_m),
        contacts: None,
        contact_is_known: false,
        direction_uncertainty: 0.0,
    }
}

/// Memory to work in for blocks of each shape of which there are many; none where contact at the end of steps goes back to what blocks have tried.
fn workspaces(shapes: &[Prototype], shape_of: &[usize], is_iterated: bool) -> Vec<Option<Workspaces>> {
    let mut count = vec![0; shapes.len()];
    shape_of.iter().for_each(|&shape| count[shape] += 1);
    let share = |(shape, count): (&Prototype, usize)| {
        (count >= MANY && shape.is_free() && shape.deforms() && !is_iterated).then(Workspaces::new)
    };
    shapes.iter().zip(count).map(share).collect()
}

/// The distinct blocks, and which of them each block is.
fn distinct_shapes(
    blocks: &BlockSet,
    bodies: &[BodySetup],
    mass: Mass,
    step: (f64, &StepWeights),
    solver: &dyn LinearSolver,
) -> Result<(Vec<Prototype>, Vec<usize>), SetupError> {
    let (mut shapes, mut shape_of): (Vec<Prototype>, Vec<usize>) = (Vec::new(), Vec::new());
    // Blocks can only be congruent if they have the same number of nodes and elements.
    let mut by_size: HashMap<(usize, usize), Vec<usize>> = HashMap::new();
    for (block, body) in blocks.ids().zip(bodies) {
        let size = (blocks.nodes_of(block).len(), blocks.tets_of(block).len());
        let known = by_size.entry(size).or_default();
        let found = known.iter().copied().find(|&index| shapes[index].fits(blocks, block, body));
        shape_of.push(found.unwrap_or(shapes.len()));
        if found.is_none() {
            known.push(shapes.len());
            shapes.push(Prototype::new(blocks, block, body, mass, step, solver)?);
        }
    }
    Ok((shapes, shape_of))
}
