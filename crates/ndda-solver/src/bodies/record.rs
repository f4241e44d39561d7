//! Work, impulses and rates of a step of one block.

use ndda_mesh::{Mat3, Vec3};

use crate::bodies::context::StepContext;
use crate::bodies::prototype::Prototype;
use crate::bodies::report::{BlockReport, LateralDrift, RigidForcing};
use crate::error::BlockError;

impl BlockReport {
    /// Work, impulse and error of damping in proportion to mass, which acts on the block as a whole, too. Its moment is that of its forces
    /// at x*; a free block has noted that about its mass centre already, and all of it where contact is not taken in the middle of a step.
    pub(crate) fn record_drag(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        (increment, old, new): (&[Vec3], &[Vec3], &[Vec3]),
    ) {
        let Some(drag) = &context.drag else { return };
        let (operator, dt_s) = (&shape.operator, context.dt_s);
        let mut square = 0.0;
        for (i, u) in increment.iter().enumerate() {
            let momentum = |v: &[Vec3]| operator.mass_row_times(i, v);
            let force = drag.drag(&momentum(old), &momentum(new));
            self.damping_work_j += u.dot(&force);
            self.impulse += dt_s * force;
            if !shape.is_free() {
                self.impulse_moment += dt_s * context.contact_position[i].cross(&force);
            }
            square += operator.node_mass[i] * (new[i] - old[i]).norm_squared();
        }
        if shape.is_free() && context.weights.contact_in_the_middle() {
            self.impulse_moment += operator.center(context.contact_position).cross(&self.impulse);
        }
        self.damping_error_m_s += drag.mean_velocity_error() * (square / operator.mass_kg).sqrt();
    }

    /// Torque of loads, work of friction and of changing loads, the contact rate of a step u [m], and the lateral drift of a block turned by R.
    pub(crate) fn book(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        (rotation, increment): (&Mat3, &[Vec3]),
    ) {
        let point = context.moment_point(shape) - context.contact_offset;
        for (x, f) in context.contact_position.iter().zip(context.external) {
            self.outside_torque += (x - point).cross(f);
        }
        self.outside_torque += context.contact_offset.cross(&self.reaction);
        self.impulse_moment += context.contact_offset.cross(&self.impulse);
        for (load, u) in context.changing.iter().zip(increment) {
            self.load_work_j += load.dot(u);
        }
        for (friction, u) in context.friction_force.iter().zip(increment) {
            self.friction_work_j += friction.dot(u);
        }
        self.contact_rate2 = self.contact_rate2.max(shape.contact_rate2(context.contact_stiffness));
        self.drive = RigidForcing::of(shape, context, rotation, self);
        if self.contact_rate2 > 0.0 && context.direction_uncertainty > 0.0 {
            self.lateral_drift = LateralDrift::of(shape, context, self);
        }
    }
}

impl Prototype {
    /// ω_c² of contact with the stiffness of some row sums per node [1/s²]: at most the largest of these over the mass of its node, and in a block that
    /// moves as a whole at most their sum, each times the mobility of its node.
    pub(crate) fn contact_rate2(&self, stiffness: &[f64]) -> f64 {
        let masses = &self.operator.node_mass;
        let by_nodes = stiffness.iter().zip(masses).fold(0.0, |most: f64, (k, m)| most.max(k / m));
        if self.mobility.is_empty() {
            return by_nodes;
        }
        by_nodes.min(stiffness.iter().zip(&self.mobility).map(|(k, w)| k * w).sum())
    }
}

/// The fastest of a block's velocities [m/s], which must be finite and slower than ten waves.
///
/// # Errors
/// [`BlockError::TooFast`] naming the node.
pub(crate) fn checked_speed(shape: &Prototype, velocity: &[Vec3]) -> Result<f64, BlockError> {
    let mut fastest = (0.0, 0);
    for (i, v) in velocity.iter().enumerate() {
        let speed = v.norm_squared();
        // A NaN speed must win, too.
        if speed > fastest.0 || speed.is_nan() {
            fastest = (speed, i);
        }
    }
    let (speed_m_s, node) = (fastest.0.sqrt(), fastest.1);
    let wave_speed_m_s = shape.material.wave_speed_m_s();
    if speed_m_s.is_nan() || speed_m_s >= 10.0 * wave_speed_m_s {
        return Err(BlockError::TooFast { node, speed_m_s, wave_speed_m_s });
    }
    Ok(speed_m_s)
}

/// Part of a step before its end at which the velocity of a prescribed motion counts as that at its end: a kink there belongs to the next step.
const BEFORE_END: f64 = 1e-6;

/// Velocity of a prescribed motion at the end of a step [m/s]: zero where there is none, and while a scene settles, for which time stands still.
pub(crate) fn end_velocity(shape: &Prototype, motion: Option<usize>, (start_s, end_s): (f64, f64)) -> Vec3 {
    let moves = end_s > start_s;
    let at_s = end_s - BEFORE_END * (end_s - start_s);
    motion.filter(|_| moves).map_or(Vec3::zeros(), |m| shape.supports.motions[m].velocity(at_s))
}

/// Mean acceleration of what holds a block, direction by direction [m/s²]: prescribed motions are exact, jumps included, and blocks are judged beside them.
pub(crate) fn support_acceleration(shape: &Prototype, context: &StepContext) -> Vec3 {
    if shape.supports.motions.is_empty() || context.end_s <= context.time_s {
        return Vec3::zeros();
    }
    let dt_s = context.end_s - context.time_s;
    let velocity = |motion, time_s| end_velocity(shape, motion, (time_s - dt_s, time_s));
    let change = |motion| velocity(motion, context.end_s) - velocity(motion, context.time_s);
    let (mut sum, mut weight) = (Vec3::zeros(), Vec3::zeros());
    let mut last = (None, Vec3::zeros());
    for held in &shape.supports.held {
        if held.motion != last.0 {
            last = (held.motion, change(held.motion));
        }
        for n in &held.held {
            sum += n * n.dot(&last.1);
            weight += n.component_mul(n);
        }
    }
    for spring in shape.supports.springs.iter().filter(|spring| spring.motion.is_some()) {
        sum += change(spring.motion);
        weight += Vec3::repeat(1.0);
    }
    sum.zip_map(&weight, |sum, weight| if weight > 0.0 { sum / (weight * dt_s) } else { 0.0 })
}

/// Displacement of a prescribed motion, zero where there is none [m].
pub(crate) fn displacement_at(shape: &Prototype, motion: Option<usize>, time_s: f64) -> Vec3 {
    motion.map_or(Vec3::zeros(), |m| shape.supports.motions[m].displacement(time_s))
}
