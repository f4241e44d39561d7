//! Quiet faces of a block: −Z v, waves that arrive, and rest on springs while a scene settles.

use ndda_mesh::{Mat3, Vec3};

use super::ElasticBody;
use crate::bodies::congruent_groups::Nodes;
use crate::bodies::context::StepContext;
use crate::bodies::prototype::Prototype;
use crate::error::BlockError;

impl ElasticBody {
    /// Force of the k-th node of quiet faces as far as it is known before the step [N], and velocity of the waves that arrive there [m/s];
    /// what u adds to it is in K̃.
    pub(super) fn quiet_force(
        &self,
        shape: &Prototype,
        context: &StepContext,
        k: usize,
        nodes: &Nodes,
    ) -> (Vec3, Vec3) {
        let quiet = &shape.supports.quiet;
        let dashpot = &quiet.dashpots[k];
        let i = dashpot.node as usize;
        let (mut end, mut acceleration) = (nodes.velocity[i], nodes.acceleration[i]);
        context.correct(&self.predicted[i], &self.predicted[i], &mut end, &mut acceleration);
        let velocity = nodes.velocity[i] + context.weights.drag() * (end - nodes.velocity[i]);
        let (incident, arriving) = quiet.incident(dashpot, context.load_window_s());
        let mut resisted = velocity;
        if context.settling_per_s > 0.0 {
            let anchor = self.kept.anchor[shape.supports.held.len() + shape.supports.springs.len() + k];
            resisted += context.settling_per_s * (nodes.position[i] - anchor);
        }
        let drag = self.rotation * (dashpot.drag * self.rotation.tr_mul(&resisted));
        (incident - drag, arriving)
    }

    /// Forces of quiet faces with what u adds to them, which also goes to `load`, for nodes that are held, too. Of their work, the energy of the
    /// waves that leave is booked apart: that of v less what arrives.
    pub(super) fn collect_quiet(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        rotation: &Mat3,
        nodes: &Nodes,
    ) {
        let per_m = context.weights.drag_per_m();
        for (k, dashpot) in shape.supports.quiet.dashpots.iter().enumerate() {
            let i = dashpot.node as usize;
            let added = -per_m * (dashpot.drag * self.correction[i]);
            self.load[i] += added;
            let (known, arriving) = self.quiet_force(shape, context, k, nodes);
            let force = known + rotation * added;
            let increment = self.predicted[i] + rotation * self.correction[i];
            self.add_reaction(&force, &(nodes.position[i] + 0.5 * increment));
            let leaving = rotation.tr_mul(&(increment / context.dt_s - arriving));
            let radiated_j = context.dt_s * leaving.dot(&(dashpot.drag * leaving));
            self.report.radiated_j += radiated_j;
            self.report.load_work_j += force.dot(&increment) + radiated_j;
        }
    }

    /// Springs of quiet faces begin at these places.
    pub(crate) fn rest_here(&mut self, shape: &Prototype, position: &[Vec3]) {
        let first = shape.supports.held.len() + shape.supports.springs.len();
        let dashpots = shape.supports.quiet.dashpots.iter();
        self.kept.anchor[first..]
            .iter_mut()
            .zip(dashpots)
            .for_each(|(at, d)| *at = position[d.node as usize]);
    }

    /// kept ← what the nodes of quiet faces need to stay where they are under `force` [N].
    ///
    /// # Errors
    /// [`BlockError`] when the block has no rotation any more.
    pub(crate) fn keep_quiet(
        &mut self,
        shape: &Prototype,
        (position, force): (&[Vec3], &[Vec3]),
        kept: &mut [Vec3],
    ) -> Result<(), BlockError> {
        let rotation = self.recover_displacement(shape, position)?;
        self.apply_stiffness(shape);
        for dashpot in &shape.supports.quiet.dashpots {
            let i = dashpot.node as usize;
            kept[i] = rotation * self.elastic[i] - force[i];
        }
        for held in &shape.supports.held {
            let kept = &mut kept[held.node as usize];
            held.held.iter().for_each(|n| *kept -= n * n.dot(kept));
        }
        Ok(())
    }
}
