//! Unresolved lateral motion of blocks that others clamp from both sides.
//!
//! Blocks in contact have sunk into each other by d, and where their edges meet they press on each other's sides, too: by N d/2L for
//! faces of length L. Their faces tilt by as much. So a contact force N has its direction to about d/L, and where a block is pressed
//! by much more than what moves it, the rest that its forces leave sideways is not known: without friction nothing else holds it there.

use crate::bodies::report::LateralDrift;
use ndda_mesh::Vec3;

use crate::bodies::context::StepContext;
use crate::bodies::prototype::Prototype;
use crate::bodies::report::BlockReport;

/// Normal contact forces on a block.
#[derive(Default)]
struct ClampingForces {
    resultant: Vec3,
    sum_n: f64,
    friction_n: f64,
    strongest: Vec3,
}

impl LateralDrift {
    /// Drift of a block in a step.
    pub(crate) fn of(shape: &Prototype, context: &StepContext, report: &BlockReport) -> Self {
        let pressed = ClampingForces::by(context);
        let unknown_n = context.direction_uncertainty * pressed.sum_n;
        // Where friction is at work, a little more or less of it carries that.
        if pressed.friction_n > unknown_n {
            return Self::default();
        }
        let Some(axis) = pressed.axis(context) else { return Self::default() };
        let per_kg = context.dt_s / shape.operator.mass_kg;
        let across = pressed.resultant - axis * axis.dot(&pressed.resultant);
        let net: Vec3 = context.force.iter().sum::<Vec3>() + report.reaction;
        Self {
            shift_m_s: per_kg * unresisted(&across, &net, unknown_n),
            turn_m_s: per_kg * turning(shape, context, &axis, unknown_n),
        }
    }
}

impl ClampingForces {
    fn by(context: &StepContext) -> Self {
        let (mut pressed, mut largest_n) = (Self::default(), 0.0);
        // Most nodes are not in contact.
        for force in
            (0..context.force.len()).map(|i| normal_force(context, i)).filter(|f| *f != Vec3::zeros())
        {
            let size = force.norm();
            pressed.resultant += force;
            pressed.sum_n += size;
            if size > largest_n {
                (pressed.strongest, largest_n) = (force, size);
            }
        }
        pressed.friction_n = context.friction_force.iter().map(|f| f.norm()).sum();
        pressed
    }

    /// The line along which the block is pressed, which is that of the resultant where no forces oppose each other.
    fn axis(&self, context: &StepContext) -> Option<Vec3> {
        let aligned = |i| {
            let force = normal_force(context, i);
            if force.dot(&self.strongest) < 0.0 { -force } else { force }
        };
        (0..context.force.len()).map(aligned).sum::<Vec3>().try_normalize(0.0)
    }
}

/// Force of contact on a node, without friction [N].
fn normal_force(context: &StepContext, node: usize) -> Vec3 {
    let friction = context.friction_force.get(node).copied().unwrap_or_default();
    context.force[node] - context.external[node] - friction
}

/// The part of a force that moves the block, as far as its size is no more than what is unknown.
fn unresisted(force: &Vec3, net: &Vec3, unknown_n: f64) -> Vec3 {
    let size = force.norm();
    if size == 0.0 || size > unknown_n {
        return Vec3::zeros();
    }
    let direction = force / size;
    net.dot(&direction).clamp(-size, size) * direction
}

/// Contribution of the torque about the axis, as a force at the radius of gyration.
fn turning(shape: &Prototype, context: &StepContext, axis: &Vec3, unknown_n: f64) -> Vec3 {
    let operator = &shape.operator;
    let center = operator.center(context.contact_position);
    let (mut torque, mut net, mut inertia) = (0.0, 0.0, 0.0);
    for (i, (x, mass)) in context.contact_position.iter().zip(&operator.node_mass).enumerate() {
        let arm = axis.cross(&(x - center));
        torque += arm.dot(&normal_force(context, i));
        net += arm.dot(&context.force[i]);
        inertia += mass * arm.norm_squared();
    }
    let radius_m = (inertia / operator.mass_kg).sqrt();
    unresisted(&(axis * torque / radius_m), &(axis * net / radius_m), unknown_n)
}
