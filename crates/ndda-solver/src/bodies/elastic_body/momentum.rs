//! Velocities at the end of a step, with the momentum that forces gave.

use ndda_mesh::Vec3;

use super::*;
use crate::bodies::congruent_groups::{NodeSlices, Nodes};
use crate::bodies::context::StepContext;
use crate::bodies::prototype::Prototype;
use crate::bodies::record::{checked_speed, end_velocity};
use crate::bodies::spin_torque::{Path, spin_torque};
use crate::error::BlockError;

impl ElasticBody {
    /// Gives a free block exactly the momentum and angular momentum that outside forces bring.
    ///
    /// Internal forces of a corotated frame have no resultant but, to second order in the strain, a torque. It is
    /// taken out by a rigid part of u, t + ω × z, such that c Σ m (u − û) = Σ f − α_m Σ M a₀ and
    /// Σ y × M (v₁ − v₀) + Σ u × M (½ (v₀ + v₁) − u/Δt) = Δt Σ y* × f,
    /// y at mid-step, z at its end and y* at x*, all from their mass centre. The left side is the change of angular momentum;
    /// arms at x* keep the total of all blocks exact, since contact forces have no torque there. What the right side is
    /// where contact is not taken in the middle of the step, see [`spin_torque`].
    pub(super) fn balance_momentum(&mut self, shape: &Prototype, context: &StepContext, nodes: &Nodes) {
        let (operator, c) = (&shape.operator, context.weights.mass_per_s2);
        let total: Vec3 = context.force.iter().sum();
        let had = operator.momentum(&self.correction) - operator.momentum(&self.predicted);
        let missing = total - context.weights.old_inertia * context.inertia.force - c * had;
        let shift = missing / (c * operator.mass_kg);
        self.correction.iter_mut().for_each(|u| *u += shift);

        let center = operator.center(context.contact_position);
        let arms = context.contact_position.iter().zip(context.force);
        let mut torque: Vec3 = arms.map(|(x, f)| (x - center).cross(f)).sum();
        let drag_moment = &mut self.report.impulse_moment;
        if context.weights.contact_in_the_middle() {
            let place = || operator.center(nodes.position);
            let old = || operator.angular_momentum(&place(), nodes.position, nodes.velocity);
            *drag_moment = context.drag_moment(&torque, old);
            torque += *drag_moment / context.dt_s;
        } else {
            let gone = operator.momentum(&self.correction) / operator.mass_kg;
            let (center, velocity_m_s) = (operator.center(nodes.position), operator.center(nodes.velocity));
            let path = Path { center, velocity_m_s, gone };
            let spin = || operator.angular_momentum(&center, nodes.position, nodes.velocity);
            torque = spin_torque(shape, context, &path, (&total, &torque), spin, &mut self.report);
        }
        self.rigid.fill(Vec3::zeros());
        let mut inverse_inertia = None;
        // A pass changes the arms of the next by its own small size.
        let passes = if context.weights.mean_velocity { 2 } else { 4 };
        for _ in 0..passes {
            let missing = context.dt_s * torque - self.angular_gain(shape, context, nodes);
            self.place_end_arms(shape);
            let inertia = || operator.inertia(&self.displacement, &self.elastic).try_inverse();
            let Some(inverse) = inverse_inertia.or_else(inertia) else { return };
            inverse_inertia = Some(inverse);
            let turn = inverse * missing / context.weights.velocity_per_m;
            for (r, z) in self.rigid.iter_mut().zip(&self.elastic) {
                *r += turn.cross(z);
            }
        }
    }

    /// elastic ← z, the arms at the end of the step: a turn about them stretches nothing.
    pub(super) fn place_end_arms(&mut self, shape: &Prototype) {
        for (i, z) in self.elastic.iter_mut().enumerate() {
            *z = self.displacement[i] + 0.5 * (self.correction[i] + self.rigid[i]);
        }
        let center = shape.operator.center(&self.elastic);
        self.elastic.iter_mut().for_each(|z| *z -= center);
    }

    /// Change of angular momentum about the mass centre that u brings [kg m²/s]; leaves y in `displacement` and
    /// v₁ − v₀ in `load`.
    pub(super) fn angular_gain(&mut self, shape: &Prototype, context: &StepContext, nodes: &Nodes) -> Vec3 {
        let (operator, rate) = (&shape.operator, context.weights.velocity_per_m);
        for (i, u) in self.correction.iter().enumerate() {
            let (mut velocity, mut acceleration) = (nodes.velocity[i], nodes.acceleration[i]);
            let predicted = &self.predicted[i];
            context.correct(u, predicted, &mut velocity, &mut acceleration);
            self.load[i] = velocity - nodes.velocity[i] + rate * self.rigid[i];
            self.displacement[i] = nodes.position[i] + 0.5 * (u + self.rigid[i]);
        }
        let center = operator.center(&self.displacement);
        self.displacement.iter_mut().for_each(|y| *y -= center);
        let mut gained = operator.angular_momentum(&Vec3::zeros(), &self.displacement, &self.load);
        if !context.weights.mean_velocity {
            for (i, u) in self.correction.iter().enumerate() {
                let mean = (u + self.rigid[i]) / context.dt_s;
                self.elastic[i] = nodes.velocity[i] + 0.5 * self.load[i] - mean;
            }
            let center = operator.momentum(&self.correction) / operator.mass_kg;
            gained += operator.angular_momentum(&center, &self.correction, &self.elastic);
            gained += operator.angular_momentum(&Vec3::zeros(), &self.rigid, &self.elastic);
        }
        gained
    }

    /// Velocities, accelerations and positions at the end of the step; nothing is written before all are sound.
    pub(super) fn advance(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        nodes: &mut NodeSlices,
    ) -> Result<(), BlockError> {
        let rate = context.weights.velocity_per_m;
        // v₁ and a₁ wait in `load` and `elastic`.
        for (i, u) in self.correction.iter_mut().enumerate() {
            let (mut v, mut a) = (nodes.velocity[i], nodes.acceleration[i]);
            context.correct(u, &self.predicted[i], &mut v, &mut a);
            (self.load[i], self.elastic[i]) = (v + rate * self.rigid[i], a);
            *u += self.rigid[i];
        }
        self.report.record_drag(shape, context, (&self.correction, nodes.velocity, &self.load));
        if moved(shape).next().is_some() {
            self.prescribe_velocities(shape, context, nodes.position);
        }
        self.filter_velocities(shape, context, &nodes.view())?;
        self.report.speed_m_s = checked_speed(shape, &self.load)?;
        for (i, u) in self.correction.iter().enumerate() {
            nodes.position[i] += u;
        }
        nodes.velocity.copy_from_slice(&self.load);
        nodes.acceleration.copy_from_slice(&self.elastic);
        self.report.book(shape, context, (&self.rotation, &self.correction));
        Ok(())
    }

    /// Gives moved nodes the velocity that is prescribed for the end of the step: that of the integrator would ring where the table has a kink.
    /// What that changes of momentum and kinetic energy is an impulse and work of what moves them.
    pub(super) fn prescribe_velocities(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        position: &[Vec3],
    ) {
        self.predicted.fill(Vec3::zeros());
        for (_, held) in moved(shape) {
            let i = held.node as usize;
            let end_m_s = end_velocity(shape, held.motion, (context.time_s, context.end_s));
            self.predicted[i] = onto(&held.held, &(end_m_s - self.load[i]));
            let a = self.elastic[i];
            self.elastic[i] -= onto(&held.held, &a);
        }
        for (i, change) in self.predicted.iter().enumerate() {
            let impulse = shape.operator.mass_row_times(i, &self.predicted);
            self.report.impulse += impulse;
            self.report.impulse_moment += (position[i] + self.correction[i]).cross(&impulse);
            self.report.motion_work_j += impulse.dot(&(self.load[i] + 0.5 * change));
        }
        self.load.iter_mut().zip(&self.predicted).for_each(|(v, change)| *v += change);
    }

    /// Filters what damping in proportion to stiffness leaves of the velocities in `load` and of the accelerations in `elastic`, and
    /// books that damping.
    pub(super) fn filter_velocities(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        start: &Nodes,
    ) -> Result<(), BlockError> {
        let Some(damping) = &mut self.kept.damping else { return Ok(()) };
        self.report.damping_work_j += damping.work_j(shape);
        for ((end, x), u) in self.displacement.iter_mut().zip(start.position).zip(&self.correction) {
            *end = x + u;
        }
        let remembered = context.weights.needs_acceleration.then_some(&mut self.elastic[..]);
        damping.filter(shape, start, &self.displacement, (&mut self.load, remembered), &mut self.report)
    }
}
