//! How blocks that deform answer to contact within a step, for friction that acts on velocities.

use std::sync::{Mutex, PoisonError};

use ndda_contact::Deformation;
use ndda_mesh::{BlockId, Vec3};

use crate::body::{Body, Motion};
use crate::for_each_block::Nodes;
use crate::simulation::Simulation;

/// The blocks of a simulation before their step.
pub(crate) struct StepDeformation<'a> {
    simulation: &'a Simulation,
    bodies: Mutex<&'a mut [Body]>,
}

impl<'a> StepDeformation<'a> {
    pub(crate) fn new(simulation: &'a Simulation, bodies: &'a mut [Body]) -> Self {
        Self { simulation, bodies: Mutex::new(bodies) }
    }

    /// Works on one block, whose failure is kept until its step.
    fn with_body(&self, block: BlockId, work: impl FnOnce(&mut Body)) {
        let mut bodies = self.bodies.lock().unwrap_or_else(PoisonError::into_inner);
        work(&mut bodies[block.index()]);
    }
}

impl Deformation for StepDeformation<'_> {
    fn end_velocity(&self, block: BlockId, force: &mut [Vec3], velocity: &mut [Vec3]) {
        let simulation = self.simulation;
        let range = simulation.blocks.nodes_of(block);
        let loads = &simulation.loads.total()[range.clone()];
        force.iter_mut().zip(loads).for_each(|(force, load)| *force += load);
        let state = &simulation.state;
        let nodes = Nodes {
            position: &state.position[range.clone()],
            velocity: &state.velocity[range.clone()],
            acceleration: state.acceleration.get(range.clone()).unwrap_or(&[]),
            internal_force: state.internal_force.get(range).unwrap_or(&[]),
        };
        self.with_body(block, |body| {
            let shape = &simulation.shapes[body.shape];
            let context = simulation.context_under(block.index(), shape, force);
            body.try_step(shape, &context, &nodes);
            if let Motion::Elastic(body) = &body.motion {
                body.end_velocity(&context, &nodes, velocity);
            }
        });
    }

    fn respond(&self, block: BlockId, force: &[Vec3], velocity: &mut [Vec3]) {
        let simulation = self.simulation;
        self.with_body(block, |body| {
            let shape = &simulation.shapes[body.shape];
            let weights = shape.weights(&simulation.weights);
            body.respond(shape, &weights, force, velocity);
            velocity.iter_mut().for_each(|v| *v *= weights.velocity_per_m);
        });
    }
}
