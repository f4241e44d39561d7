//! Blocks without unknowns: they stay where they are, or move as prescribed.

use ndda_mesh::Vec3;

use crate::bodies::congruent_groups::NodeSlices;
use crate::bodies::context::StepContext;
use crate::bodies::prototype::Prototype;
use crate::bodies::record::end_velocity;
use crate::bodies::report::BlockReport;

/// A block that is held as a whole.
pub(crate) struct FixedBody {
    /// Where its nodes started [m]; empty while nothing moves it.
    anchor: Vec<Vec3>,
}

impl FixedBody {
    /// A block of this shape that starts at `position`.
    pub(crate) fn new(shape: &Prototype, position: &[Vec3]) -> Self {
        let moves = !shape.supports.motions.is_empty();
        Self { anchor: if moves { position.to_vec() } else { Vec::new() } }
    }

    /// Positions of the nodes at the end of a step [m], `position` being where they are before it.
    pub(crate) fn end_position(&self, shape: &Prototype, end_s: f64, position: &[Vec3], out: &mut [Vec3]) {
        if self.anchor.is_empty() {
            out.copy_from_slice(position);
            return;
        }
        let to = shape.displacement_as_a_whole(end_s);
        out.iter_mut().zip(&self.anchor).for_each(|(x, anchor)| *x = anchor + to);
    }

    /// Takes the place and the velocity that are prescribed for the end of the step, and reports what that took.
    pub(crate) fn step(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        nodes: NodeSlices,
    ) -> BlockReport {
        let mut report = BlockReport::default();
        let total: Vec3 = context.force.iter().sum();
        for (x, f) in context.contact_position.iter().zip(context.force) {
            report.outside_torque -= x.cross(f);
        }
        for (x, f) in context.contact_position.iter().zip(context.external) {
            report.outside_torque += x.cross(f);
        }
        report.reaction = -total;
        if self.anchor.is_empty() {
            return report;
        }
        let to = shape.displacement_as_a_whole(context.end_s);
        let increment = to - shape.displacement_as_a_whole(context.time_s);
        let (old, velocity) = (
            nodes.velocity[0],
            end_velocity(shape, shape.motion_as_a_whole(), (context.time_s, context.end_s)),
        );
        // Its own inertia is moved at the mean of both velocities, so that its kinetic energy is the work done on it.
        let inertia = shape.operator.mass_kg * (velocity - old);
        report.motion_work_j = report.reaction.dot(&increment) + 0.5 * inertia.dot(&(velocity + old));
        report.reaction += inertia / context.dt_s;
        // The motion is prescribed, so the integrator's weights do not apply to what moves the block's own mass.
        report.motion_impulse = inertia;
        report.orbital_impulse = shape.operator.center(nodes.position).cross(&inertia);
        // The support delivers what friction and changing loads take: their own work is recorded as such.
        report.friction_work_j = context.friction_force.iter().sum::<Vec3>().dot(&increment);
        report.load_work_j = context.changing.iter().sum::<Vec3>().dot(&increment);
        report.speed_m_s = velocity.norm();
        for (x, anchor) in nodes.position.iter_mut().zip(&self.anchor) {
            *x = anchor + to;
        }
        nodes.velocity.fill(velocity);
        report
    }
}
