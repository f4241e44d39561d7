//! How blocks that deform answer to contact within a step, for friction that acts on velocities.

use std::sync::{Mutex, PoisonError};

use ndda_contact::Deformation;
use ndda_mesh::{BlockId, Vec3};
use rayon::prelude::*;

use crate::bodies::body::{Body, Motion};
use crate::bodies::congruent_groups::Nodes;
use crate::step::Simulation;

/// The blocks of a simulation before their step.
pub(crate) struct StepDeformation<'a> {
    simulation: &'a Simulation,
    /// Contact calls through a shared reference, once for all blocks.
    bodies: Mutex<&'a mut [Body]>,
}

impl<'a> StepDeformation<'a> {
    pub(crate) fn new(simulation: &'a Simulation, bodies: &'a mut [Body]) -> Self {
        Self { simulation, bodies: Mutex::new(bodies) }
    }

    /// One block, whose failure is kept until its step.
    fn answer_block(&self, block: BlockId, body: &mut Body, columns: &mut [Vec3]) {
        let simulation = self.simulation;
        let range = simulation.problem.blocks.nodes_of(block);
        let (force, others) = columns.split_at_mut(range.len());
        let loads = &simulation.loads.total()[range.clone()];
        force.iter_mut().zip(loads).for_each(|(force, load)| *force += load);
        if let Some(bolts) = &simulation.bolts {
            let pulls = &bolts.force[range.clone()];
            force.iter_mut().zip(pulls).for_each(|(force, pull)| *force += pull);
        }
        let state = &simulation.state;
        let nodes = Nodes {
            position: &state.position[range.clone()],
            velocity: &state.velocity[range.clone()],
            acceleration: state.acceleration.get(range.clone()).unwrap_or(&[]),
            internal_force: state.internal_force.get(range.clone()).unwrap_or(&[]),
        };
        let shape = &simulation.problem.shapes[body.shape];
        let context = simulation.context_under(block.index(), shape, force);
        let mut guests = simulation.problem.enter(std::slice::from_mut(body));
        let body = guests.one();
        body.try_step(shape, &context, &nodes);
        let Motion::Elastic(elastic) = &mut body.motion else {
            unreachable!("contact asks blocks that deform alone")
        };
        let context = simulation.context_under(block.index(), shape, &[]);
        elastic.end_velocity(&context, &nodes, force);
        let velocity_per_m = shape.weights(&simulation.weights).velocity_per_m;
        for column in others.chunks_exact_mut(range.len()) {
            if let Err(error) = elastic.respond_in_place(shape, column) {
                body.error = Some(error);
                return;
            }
            column.iter_mut().for_each(|v| *v *= velocity_per_m);
        }
    }
}

impl Deformation for StepDeformation<'_> {
    fn answer(&self, columns: &mut [Vec<Vec3>]) {
        let mut bodies = self.bodies.lock().unwrap_or_else(PoisonError::into_inner);
        let each = bodies.par_iter_mut().zip(columns).enumerate();
        each.filter(|(_, (_, columns))| !columns.is_empty()).for_each(|(block, (body, columns))| {
            self.answer_block(BlockId(block as u32), body, columns);
        });
    }

    fn masses(&self, block: BlockId, work: &mut dyn FnMut(&[f64])) {
        let bodies = self.bodies.lock().unwrap_or_else(PoisonError::into_inner);
        work(&self.simulation.problem.shapes[bodies[block.index()].shape].operator.node_mass);
    }
}
