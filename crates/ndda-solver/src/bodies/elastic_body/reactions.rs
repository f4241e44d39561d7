//! Forces that supports exert on an elastic block.

use ndda_mesh::{Mat3, Vec3};

use super::*;
use crate::bodies::congruent_groups::Nodes;
use crate::bodies::context::StepContext;
use crate::bodies::kind::BodyKind;
use crate::bodies::prototype::Prototype;
use crate::bodies::record::displacement_at;
use crate::integrators::time_integrator::StepWeights;

impl ElasticBody {
    /// Forces that supports must exert to hold components and springs as prescribed.
    pub(super) fn collect_reactions(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        rotation: &Mat3,
        nodes: &Nodes,
    ) {
        self.collect_springs(shape, context, rotation, nodes);
        self.collect_quiet(shape, context, rotation, nodes);
        if shape.kind == BodyKind::Affine {
            return self.collect_as_a_whole(shape, context, rotation, nodes);
        }
        self.collect_ties(shape, context, rotation, nodes);
        for held in &shape.supports.held {
            let i = held.node as usize;
            let reaction = rotation * onto(&held.held, &self.unbalanced(shape, context, i));
            let increment = self.predicted[i] + rotation * self.correction[i];
            self.add_reaction(&reaction, &(nodes.position[i] + 0.5 * increment));
            if held.motion.is_some() {
                self.report.motion_work_j += reaction.dot(&increment);
            }
        }
    }

    /// Forces by which tied nodes hold each other: they add up to nothing, but have a moment.
    fn collect_ties(&mut self, shape: &Prototype, context: &StepContext, rotation: &Mat3, nodes: &Nodes) {
        for &node in shape.supports.ties.iter().flatten() {
            let i = node as usize;
            let mut force = self.unbalanced(shape, context, i);
            if let Ok(held) = shape.supports.held.binary_search_by_key(&node, |held| held.node) {
                force -= onto(&shape.supports.held[held].held, &force);
            }
            let increment = self.predicted[i] + rotation * self.correction[i];
            self.add_reaction(&(rotation * force), &(nodes.position[i] + 0.5 * increment));
        }
    }

    /// Reactions of a block that is kept affine: the constraint acts on each node, but has no resultant and no torque, so that of all
    /// nodes together is that of the supports.
    pub(super) fn collect_as_a_whole(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        rotation: &Mat3,
        nodes: &Nodes,
    ) {
        for i in 0..shape.operator.nodes() {
            let force = rotation * self.unbalanced(shape, context, i);
            let increment = self.predicted[i] + rotation * self.correction[i];
            self.add_reaction(&force, &(nodes.position[i] + 0.5 * increment));
        }
    }

    /// Force on a node that its equation of motion lacks, in the block's frame [N].
    pub(super) fn unbalanced(&self, shape: &Prototype, context: &StepContext, node: usize) -> Vec3 {
        let StepWeights { stiffness: theta, mass_per_s2: c, .. } = context.weights;
        let b = shape.damping.stiffness;
        let inertia = shape.operator.row(node).fold(Vec3::zeros(), |sum, (j, stiffness, mass)| {
            let drag = if b > 0.0 { b * (stiffness * self.correction[j]) } else { Vec3::zeros() };
            sum + c * mass * self.correction[j] + drag
        });
        inertia + theta * self.elastic[node] - self.load[node]
    }

    /// Forces of the springs at x + θ u; what u adds to them also goes to `load`, for nodes that are held, too. Those of an affine block
    /// leave `load`, to be found as what it lacks as a whole: its unknowns move all nodes, and round as the stiffest spring does.
    pub(super) fn collect_springs(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        rotation: &Mat3,
        nodes: &Nodes,
    ) {
        let theta = context.weights.stiffness;
        for (k, spring) in shape.supports.springs.iter().enumerate() {
            let i = spring.node as usize;
            let turned = rotation * self.correction[i];
            let increment = self.predicted[i] + turned;
            // As it is solved for: a stiff spring would feel the last digit of x + u.
            let added = -spring.stiffness_n_m * theta * along(spring.along.as_ref(), &turned);
            let pull = self.pull_of_spring(shape, context, k, nodes.position);
            let reaction = pull + added;
            if shape.kind == BodyKind::Affine {
                self.load[i] -= rotation.tr_mul(&pull);
            } else {
                self.load[i] += rotation.tr_mul(&added);
                self.add_reaction(&reaction, &(nodes.position[i] + 0.5 * increment));
            }
            let travel = displacement_at(shape, spring.motion, context.end_s)
                - displacement_at(shape, spring.motion, context.time_s);
            self.report.motion_work_j += reaction.dot(&travel);
        }
    }

    pub(super) fn add_reaction(&mut self, reaction: &Vec3, place: &Vec3) {
        self.report.reaction += reaction;
        self.report.outside_torque += place.cross(reaction);
    }

    /// u = û + R s.
    pub(super) fn turn_back(&mut self, rotation: &Mat3) {
        for (s, predicted) in self.correction.iter_mut().zip(&self.predicted) {
            *s = predicted + rotation * *s;
        }
    }
}
