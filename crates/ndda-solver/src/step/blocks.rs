//! Each block alone, in parallel.

use crate::step::GRAIN_NODES;
use std::mem::take;

use ndda_mesh::{BlockId, Vec3};

use crate::bodies::body::Body;
use crate::bodies::body::solve_together;
use crate::bodies::congruent_groups::{NodeSlices, each_of_run, for_each_run};
use crate::bodies::context::StepContext;
use crate::bodies::prototype::Prototype;
use crate::error::StepError;
use crate::step::Simulation;

impl Simulation {
    /// Input of the step of block `index` of a shape.
    pub(crate) fn context(&self, index: usize, shape: &Prototype) -> StepContext<'_> {
        let range = self.problem.blocks.nodes_of(BlockId(index as u32));
        self.context_under(index, shape, &self.scratch.force[range])
    }

    /// Input of the step with other forces on the block's nodes.
    pub(crate) fn context_under<'a>(
        &'a self,
        index: usize,
        shape: &Prototype,
        force: &'a [Vec3],
    ) -> StepContext<'a> {
        let range = self.problem.blocks.nodes_of(BlockId(index as u32));
        let acted = if self.scratch.contact_has_acted { range.clone() } else { 0..0 };
        StepContext {
            integrator: self.problem.integrator.as_ref(),
            drag: shape.damping.mass,
            weights: shape.weights(&self.weights),
            dt_s: self.part_s,
            time_s: self.clock_s(0.0),
            end_s: self.clock_s(1.0),
            settling_per_s: if self.settling.is_some() { 0.5 / self.problem.base_step_s } else { 0.0 },
            contact_position: &self.scratch.contact_position[range.clone()],
            contact_offset: self.state.contact_offset_of(BlockId(index as u32)),
            force,
            external: &self.loads.total()[range.clone()],
            falls_alone: !self.loads.are_more_than_weight() && !self.has_bolts() && self.settling.is_none(),
            changing: self.loads.changing().get(range.clone()).unwrap_or(&[]),
            friction_force: self.scratch.friction_force.get(acted.clone()).unwrap_or(&[]),
            contact_stiffness: self.scratch.contact_stiffness.get(acted).unwrap_or(&[]),
            direction_uncertainty: self.audit.direction_uncertainty,
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
    pub(super) fn solve_blocks(&mut self) -> Result<(), StepError> {
        if self.ranks.partners().is_some() {
            self.solve_shared_blocks()?;
        } else {
            self.with_bodies(|simulation, bodies, slices| simulation.step_runs(bodies, slices, &|_, _| true));
        }
        for (inertia, body) in self.state.inertia.iter_mut().zip(&self.bodies) {
            *inertia = body.report.inertia;
        }
        self.stop_if_a_block_failed()
    }

    /// Steps the runs that are asked for.
    pub(super) fn step_runs(
        &self,
        bodies: &mut [Body],
        slices: NodeSlices,
        asked: &(impl Fn(usize, &[Body]) -> bool + Sync),
    ) {
        let starts = self.problem.blocks.node_starts();
        for_each_run(&self.problem.runs, bodies, starts, slices, GRAIN_NODES, &|first, run, slices| {
            if asked(first, run) {
                self.step_run(first, run, slices);
            }
        });
    }

    /// The step of a run: congruent blocks are solved for together, others one by one; the bits are the same.
    pub(super) fn step_run(&self, first: usize, run: &mut [Body], mut slices: NodeSlices) {
        let starts = self.problem.blocks.node_starts();
        let mut borrowed = self.problem.lend_memory(run);
        let run = borrowed.run();
        let together = run[0].batch.is_some();
        if together {
            each_of_run(first, run, starts, slices.again(), |index, body: &mut Body, nodes| {
                let shape = &self.problem.shapes[body.shape];
                body.prepare(shape, &self.context(index, shape), &nodes.view());
            });
            solve_together(&self.problem.shapes[run[0].shape], run);
        }
        each_of_run(first, run, starts, slices, |index, body: &mut Body, nodes| {
            let shape = &self.problem.shapes[body.shape];
            let context = self.context(index, shape);
            if together { body.finish(shape, &context, nodes) } else { body.step(shape, &context, nodes) }
        });
    }

    /// The first error of a block, if there is any.
    pub(crate) fn stop_if_a_block_failed(&mut self) -> Result<(), StepError> {
        let time_s = self.clock_s(1.0);
        for (index, body) in self.bodies.iter_mut().enumerate() {
            if let Some(source) = body.error.take() {
                let block = self.problem.blocks.names[index].clone();
                return Err(StepError::Block { time_s, block, source });
            }
        }
        Ok(())
    }
}
