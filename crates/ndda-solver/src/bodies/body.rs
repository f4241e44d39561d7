//! One step of one block, alone, whatever kind of body it is.

use crate::bodies::context::StepContext;
use crate::bodies::report::BlockReport;
use crate::error::BlockError;
use crate::linear::linear_solver::MULTI;
use ndda_mesh::Vec3;

use crate::bodies::batch::Batch;
use crate::bodies::congruent_groups::{NodeSlices, Nodes};
use crate::bodies::elastic_body::{ElasticBody, Kept};
use crate::bodies::fixed_body::FixedBody;
use crate::bodies::prototype::Prototype;
use crate::bodies::rigid_body::RigidBody;
use crate::integrators::time_integrator::StepWeights;
use crate::linear::linear_solver::Factor;

/// One block on its way: memory sized once, written every step.
pub(crate) struct Body {
    /// Index of its shape.
    pub shape: usize,
    /// How it moves.
    pub motion: Motion,
    /// Report on the last step.
    pub report: BlockReport,
    /// Why the last step failed.
    pub error: Option<BlockError>,
    /// Workspace to solve for the run of congruent blocks that it leads.
    pub batch: Option<Box<Batch>>,
}

/// A block without memory takes no step.
const NO_WORKSPACE: &str = "blocks have memory to work in while they step";

/// The ways in which a block moves.
pub(crate) enum Motion {
    /// Elastic and affine blocks.
    Elastic(Box<ElasticBody>),
    /// Such blocks outside their step, where many of one shape share memory (`workspaces.rs`).
    Resting(Kept),
    /// Rigid blocks.
    Rigid(RigidBody),
    /// Blocks that stay, or move as prescribed.
    Fixed(FixedBody),
}

impl Body {
    /// Advances the block by one step and keeps what it reports, or why it could not.
    pub(crate) fn step(&mut self, shape: &Prototype, context: &StepContext, nodes: NodeSlices) {
        let report = match &mut self.motion {
            Motion::Elastic(body) => body.step(shape, context, nodes),
            Motion::Rigid(body) => body.step(shape, context, nodes),
            Motion::Fixed(body) => Ok(body.step(shape, context, nodes)),
            Motion::Resting(_) => unreachable!("{NO_WORKSPACE}"),
        };
        match report {
            Ok(report) => self.report = report,
            Err(error) => self.error = Some(error),
        }
    }

    /// Memory of solves for another factor of the same matrix structure.
    pub(crate) fn renew_scratch(&mut self, factor: &dyn Factor, filter: Option<&dyn Factor>) {
        if let Some(batch) = &mut self.batch {
            **batch = Batch::new(factor);
        }
        if let Some(body) = self.elastic() {
            body.scratch = factor.new_scratch();
        }
        let kept = match &mut self.motion {
            Motion::Elastic(body) => &mut body.kept,
            Motion::Resting(kept) => kept,
            Motion::Rigid(_) | Motion::Fixed(_) => return,
        };
        if let (Some(damping), Some(filter)) = (&mut kept.damping, filter) {
            damping.renew_scratch(filter);
        }
    }

    /// The right-hand side of a block with a factor, to be solved for together with others.
    pub(crate) fn prepare(&mut self, shape: &Prototype, context: &StepContext, nodes: &Nodes) {
        if let Some(body) = self.elastic() {
            self.error = body.prepare(shape, context, nodes).err();
        }
    }

    /// The rest of a step that is prepared and solved for.
    pub(crate) fn finish(&mut self, shape: &Prototype, context: &StepContext, nodes: NodeSlices) {
        if self.error.is_some() {
            return;
        }
        if let Some(body) = self.elastic() {
            match body.finish(shape, context, nodes) {
                Ok(report) => self.report = report,
                Err(error) => self.error = Some(error),
            }
        }
    }

    /// Finds where the block would go; [`place_end`](Self::place_end) then says it.
    pub(crate) fn try_step(&mut self, shape: &Prototype, context: &StepContext, nodes: &Nodes) {
        let tried = match &mut self.motion {
            Motion::Elastic(body) => body.try_step(shape, context, nodes),
            Motion::Rigid(body) => body.try_step(shape, context, nodes),
            Motion::Fixed(_) => Ok(()),
            Motion::Resting(_) => unreachable!("{NO_WORKSPACE}"),
        };
        self.error = tried.err();
    }

    /// out ← x + u as last tried [m].
    pub(crate) fn place_end(&self, shape: &Prototype, end_s: f64, position: &[Vec3], out: &mut [Vec3]) {
        let increment = match &self.motion {
            Motion::Elastic(body) => body.increment(),
            Motion::Rigid(body) => body.increment(),
            Motion::Fixed(body) => return body.end_position(shape, end_s, position, out),
            Motion::Resting(_) => unreachable!("{NO_WORKSPACE}"),
        };
        for ((end, x), u) in out.iter_mut().zip(position).zip(increment) {
            *end = x + u;
        }
    }

    /// out ← how u as last tried changes with the force, linearised.
    pub(crate) fn respond(
        &mut self,
        shape: &Prototype,
        weights: &StepWeights,
        force: &[Vec3],
        out: &mut [Vec3],
    ) {
        match &mut self.motion {
            Motion::Elastic(body) => {
                out.copy_from_slice(force);
                if let Err(error) = body.respond_in_place(shape, out) {
                    self.error = Some(error);
                }
            }
            Motion::Rigid(body) => body.respond(shape, weights, force, out),
            Motion::Fixed(_) => out.fill(Vec3::zeros()),
            Motion::Resting(_) => unreachable!("{NO_WORKSPACE}"),
        }
    }

    /// The deforming part, where there is one and it has memory to work in.
    pub(crate) fn elastic(&mut self) -> Option<&mut ElasticBody> {
        match &mut self.motion {
            Motion::Elastic(body) => Some(body),
            Motion::Rigid(_) | Motion::Fixed(_) | Motion::Resting(_) => None,
        }
    }

    /// What a deforming block keeps.
    pub(crate) fn kept(&self) -> Option<&Kept> {
        match &self.motion {
            Motion::Elastic(body) => Some(&body.kept),
            Motion::Resting(kept) => Some(kept),
            Motion::Rigid(_) | Motion::Fixed(_) => None,
        }
    }
}

/// unknowns ← K̃⁻¹ unknowns for a run of prepared blocks, to the bits of solving them one by one.
pub(crate) fn solve_together(shape: &Prototype, run: &mut [Body]) {
    let (Some(factor), Some(mut batch)) = (&shape.factor, run[0].batch.take()) else { return };
    let Batch { lanes, scratch } = &mut *batch;
    lanes.fill([0.0; MULTI]);
    for (lane, body) in run.iter_mut().enumerate() {
        let Some(body) = body.elastic() else { continue };
        lanes.iter_mut().zip(&body.unknowns).for_each(|(row, b)| row[lane] = *b);
    }
    let solved = factor.solve_multi_in_place(lanes, scratch);
    for (lane, body) in run.iter_mut().enumerate() {
        if let Err(error) = &solved {
            body.error.get_or_insert(BlockError::Solve(*error));
        }
        let Some(body) = body.elastic() else { continue };
        body.unknowns.iter_mut().zip(&*lanes).for_each(|(x, row)| *x = row[lane]);
    }
    run[0].batch = Some(batch);
}
