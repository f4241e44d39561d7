//! How blocks that deform answer to contact within a step, for friction that acts on velocities.

use std::sync::{Mutex, OnceLock, PoisonError};

use ndda_contact::Deformation;
use ndda_mesh::{BlockId, Vec3};
use ndda_ranks::{Communicator, Gathered, Packer, RanksError, Topic, Unpacker, divide, share};
use rayon::prelude::*;

use crate::bodies::body::{Body, Motion};
use crate::bodies::congruent_groups::Nodes;
use crate::step::Simulation;

/// The blocks of a simulation before their step.
pub(crate) struct StepDeformation<'a> {
    simulation: &'a Simulation,
    /// Contact calls through a shared reference, once for all blocks.
    bodies: Mutex<&'a mut [Body]>,
    /// Why ranks that share the answers cannot go on.
    stopped: OnceLock<RanksError>,
}

impl<'a> StepDeformation<'a> {
    pub(crate) fn new(simulation: &'a Simulation, bodies: &'a mut [Body]) -> Self {
        Self { simulation, bodies: Mutex::new(bodies), stopped: OnceLock::new() }
    }

    /// Why the answers are not to be used.
    pub(crate) fn stopped(self) -> Option<RanksError> {
        self.stopped.into_inner()
    }

    /// The answers of the blocks that are asked for.
    fn answer_some(
        &self,
        bodies: &mut [Body],
        columns: &mut [Vec<Vec3>],
        asked: impl Fn(usize) -> bool + Sync,
    ) {
        let each = bodies.par_iter_mut().zip(columns).enumerate();
        each.filter(|(block, (_, columns))| !columns.is_empty() && asked(*block))
            .for_each(|(block, (body, columns))| self.answer_block(BlockId(block as u32), body, columns));
    }

    /// Each rank asks its share of the blocks. One that fails is asked by all, so that all have its error.
    fn answer_on_ranks(
        &self,
        ranks: &dyn Communicator,
        bodies: &mut [Body],
        columns: &mut [Vec<Vec3>],
    ) -> Result<(), RanksError> {
        let shapes = &self.simulation.problem.shapes;
        let weight = |(body, columns): (&Body, &Vec<Vec3>)| {
            columns.len() as u64 * (1 + (shapes[body.shape].unknowns.len() as u64).isqrt())
        };
        let starts = divide(bodies.iter().zip(&*columns).map(weight), ranks.size());
        let own = share(&starts, ranks.rank());
        self.answer_some(bodies, columns, |block| own.contains(&block));
        let (mut packer, mut all) = (Packer::default(), Gathered::default());
        for (body, columns) in bodies[own.clone()].iter().zip(&columns[own]).filter(|each| !each.1.is_empty())
        {
            packer.put(&u8::from(body.error.is_none()));
            if body.error.is_none() {
                packer.put_each(columns, |v| <[f64; 3]>::from(*v));
            }
        }
        ranks.exchange(Topic::Answers, packer.bytes(), &mut all)?;
        let mut failed = vec![false; bodies.len()];
        for rank in (0..ranks.size()).filter(|rank| *rank != ranks.rank()) {
            let mut found = Unpacker::new(all.of(rank));
            for block in share(&starts, rank).filter(|block| !columns[*block].is_empty()).collect::<Vec<_>>()
            {
                failed[block] = found.take::<u8>() == 0;
                if !failed[block] {
                    found.take_into(&mut columns[block], |v: [f64; 3]| Vec3::from(v));
                }
            }
        }
        if failed.contains(&true) {
            self.answer_some(bodies, columns, |block| failed[block]);
        }
        Ok(())
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
        let mut borrowed = simulation.problem.lend_memory(std::slice::from_mut(body));
        let body = borrowed.one();
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
        match self.simulation.ranks.partners() {
            None => self.answer_some(&mut bodies, columns, |_| true),
            Some(ranks) => {
                if let Err(error) = self.answer_on_ranks(ranks, &mut bodies, columns) {
                    self.stopped.get_or_init(|| error);
                }
            }
        }
    }

    fn masses(&self, block: BlockId, work: &mut dyn FnMut(&[f64])) {
        let bodies = self.bodies.lock().unwrap_or_else(PoisonError::into_inner);
        work(&self.simulation.problem.shapes[bodies[block.index()].shape].operator.node_mass);
    }
}
