//! How blocks that deform answer to contact within a step, for friction that acts on velocities.

use std::sync::{Mutex, OnceLock, PoisonError};

use ndda_contact::Deformation;
use ndda_mesh::{BlockId, Vec3};
use ndda_ranks::{Communicator, Gathered, Packer, RanksError, Topic, Unpacker, divide, share};

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

    /// The answers of the blocks that are asked for, whose bodies begin with that of number `first`.
    fn answer_some(
        &self,
        first: usize,
        bodies: &mut [Body],
        (blocks, columns): (&[BlockId], &mut [Vec<Vec3>]),
        asked: &(impl Fn(usize) -> bool + Sync),
    ) {
        match blocks {
            [] => {}
            [block] if asked(block.index()) => {
                self.answer_block(*block, &mut bodies[block.index() - first], &mut columns[0]);
            }
            [_] => {}
            many => {
                let (head, tail) = many.split_at(many.len() / 2);
                let (of_head, of_tail) = columns.split_at_mut(head.len());
                let middle = tail[0].index();
                let (own, others) = bodies.split_at_mut(middle - first);
                rayon::join(
                    || self.answer_some(first, own, (head, of_head), asked),
                    || self.answer_some(middle, others, (tail, of_tail), asked),
                );
            }
        }
    }

    /// Each rank asks its share of the blocks. One that fails is asked by all, so that all have its error.
    fn answer_on_ranks(
        &self,
        ranks: &dyn Communicator,
        bodies: &mut [Body],
        (blocks, columns): (&[BlockId], &mut [Vec<Vec3>]),
    ) -> Result<(), RanksError> {
        let shapes = &self.simulation.problem.shapes;
        let weight = |(block, columns): (&BlockId, &Vec<Vec3>)| {
            let shape = &shapes[bodies[block.index()].shape];
            columns.len() as u64 * (1 + (shape.unknowns.len() as u64).isqrt())
        };
        let starts = divide(blocks.iter().zip(&*columns).map(weight), ranks.size());
        let own = share(&starts, ranks.rank());
        self.answer_some(0, bodies, (&blocks[own.clone()], &mut columns[own.clone()]), &|_| true);
        let (mut packer, mut all) = (Packer::default(), Gathered::default());
        for (block, columns) in blocks[own.clone()].iter().zip(&columns[own]) {
            let body = &bodies[block.index()];
            packer.put(&u8::from(body.error.is_none()));
            if body.error.is_none() {
                packer.put_each(columns, |v| <[f64; 3]>::from(*v));
            }
        }
        ranks.exchange(Topic::Answers, packer.bytes(), &mut all)?;
        let mut failed = vec![false; bodies.len()];
        for rank in (0..ranks.size()).filter(|rank| *rank != ranks.rank()) {
            let mut found = Unpacker::new(all.of(rank));
            for slot in share(&starts, rank) {
                let failed = &mut failed[blocks[slot].index()];
                *failed = found.take::<u8>() == 0;
                if !*failed {
                    found.take_into(&mut columns[slot], |v: [f64; 3]| Vec3::from(v));
                }
            }
        }
        if failed.contains(&true) {
            self.answer_some(0, bodies, (blocks, columns), &|block| failed[block]);
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
    fn answer(&self, blocks: &[BlockId], columns: &mut [Vec<Vec3>]) {
        let mut bodies = self.bodies.lock().unwrap_or_else(PoisonError::into_inner);
        match self.simulation.ranks.partners() {
            None => self.answer_some(0, &mut bodies, (blocks, columns), &|_| true),
            Some(ranks) => {
                if let Err(error) = self.answer_on_ranks(ranks, &mut bodies, (blocks, columns)) {
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
