//! Blocks that do not deform.
//!
//! The nodes are the state: they are where a rigid motion puts them, so place, turn, momentum and spin follow from them,
//! and nothing else has to be remembered, saved or rolled back.

use crate::bodies::rigid_inertia::RigidInertia;
use ndda_fem::FrameError;
use ndda_mesh::{Mat3, Vec3};

use crate::bodies::congruent_groups::{NodeSlices, Nodes};
use crate::bodies::context::StepContext;
use crate::bodies::prototype::Prototype;
use crate::bodies::record::checked_speed;
use crate::bodies::report::BlockReport;
use crate::bodies::spin_torque::{Path, spin_torque};
use crate::error::BlockError;
use crate::integrators::time_integrator::StepWeights;

/// Newton steps for the turn of a step: it converges quadratically from a turn at constant spin.
const MOST_ITERATIONS: usize = 20;

/// Memory of one rigid block.
pub(crate) struct RigidBody {
    /// u [m].
    increment: Vec<Vec3>,
    /// v₁ [m/s].
    velocity: Vec<Vec3>,
    /// R at the start of the step last tried.
    rotation: Mat3,
}

/// Place and motion of a rigid block at the start of a step.
struct Start {
    center: Vec3,
    rotation: Mat3,
    velocity_m_s: Vec3,
    /// In the block's frame [rad/s].
    spin: Vec3,
}

impl RigidBody {
    /// Memory for a block of this shape.
    pub(crate) fn new(shape: &Prototype) -> Self {
        let zeros = vec![Vec3::zeros(); shape.operator.nodes()];
        Self { increment: zeros.clone(), velocity: zeros, rotation: Mat3::identity() }
    }

    /// Advances the block by one step: its mass centre by the integrator, its turn by an energy and momentum conserving
    /// rule (see `turn` below).
    ///
    /// # Errors
    /// [`BlockError`] when the block has lost its speed.
    pub(crate) fn step(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        mut nodes: NodeSlices,
    ) -> Result<BlockReport, BlockError> {
        let mut report = BlockReport::default();
        let start = self.place_increment(shape, context, &nodes.view(), &mut report)?;
        report.speed_m_s = checked_speed(shape, &self.velocity)?;
        report.record_drag(shape, context, (&self.increment, nodes.velocity, &self.velocity));
        self.advance(context, &mut nodes);
        report.book(shape, context, (&start.rotation, &self.increment));
        Ok(report)
    }

    /// u as a step would have it; nothing else is written.
    ///
    /// # Errors
    /// [`BlockError`] when no turn fits.
    pub(crate) fn try_step(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        nodes: &Nodes,
    ) -> Result<(), BlockError> {
        let start = self.place_increment(shape, context, nodes, &mut BlockReport::default())?;
        self.rotation = start.rotation;
        Ok(())
    }

    /// u as last tried [m].
    pub(crate) fn increment(&self) -> &[Vec3] {
        &self.increment
    }

    /// out ← how u as last tried changes with the force: a shift F/c m, a turn J⁻¹ T/c.
    pub(crate) fn respond(&self, shape: &Prototype, weights: &StepWeights, force: &[Vec3], out: &mut [Vec3]) {
        let (operator, inertia) = (&shape.operator, shape.rigid.as_ref().expect("a rigid shape"));
        let rate = shape.weights(weights).mass_per_s2;
        let arms = || operator.rest.iter().map(|rest| self.rotation * rest);
        let shift = force.iter().sum::<Vec3>() / (rate * operator.mass_kg);
        let torque: Vec3 = arms().zip(force).map(|(arm, f)| arm.cross(f)).sum();
        let turn = self.rotation * (inertia.inverse * self.rotation.tr_mul(&torque)) / rate;
        out.iter_mut().zip(arms()).for_each(|(u, arm)| *u = shift + turn.cross(&arm));
    }

    /// u and v₁.
    fn place_increment(
        &mut self,
        shape: &Prototype,
        context: &StepContext,
        nodes: &Nodes,
        report: &mut BlockReport,
    ) -> Result<Start, BlockError> {
        let start = start(shape, nodes)?;
        let (gone, drive, velocity) = shift(shape, context, &start);
        let path = Path { center: start.center, velocity_m_s: start.velocity_m_s, gone };
        let torque = self.torque(shape, context, &path, &start, &drive, report);
        let local = start.rotation.tr_mul(&torque);
        let inertia = shape.rigid.as_ref().expect("a rigid shape");
        let angle = turn(inertia, &start.spin, &local, context.dt_s)
            .ok_or_else(|| turned_too_far(inertia, context.dt_s, &start.spin, &local))?;
        let momentum = inertia.inertia * start.spin + context.dt_s * local;
        let turned = rotation_by(&angle);
        let rotation = start.rotation * turned;
        let spin = rotation * (inertia.inverse * turned.tr_mul(&momentum));
        let center = start.center + gone;
        for (i, rest) in shape.operator.rest.iter().enumerate() {
            let arm = rotation * rest;
            self.increment[i] = center + arm - nodes.position[i];
            self.velocity[i] = velocity + spin.cross(&arm);
        }
        Ok(start)
    }

    /// Torque about the mass centre in this step, drag included.
    fn torque(
        &self,
        shape: &Prototype,
        context: &StepContext,
        path: &Path,
        start: &Start,
        drive: &Vec3,
        report: &mut BlockReport,
    ) -> Vec3 {
        let center = shape.operator.center(context.contact_position);
        let arms = context.contact_position.iter().zip(context.force);
        let torque: Vec3 = arms.map(|(x, f)| (x - center).cross(f)).sum();
        let drag_moment = &mut report.impulse_moment;
        if context.weights.contact_in_the_middle() {
            let inertia = &shape.rigid.as_ref().expect("a rigid shape").inertia;
            *drag_moment = context.drag_moment(&torque, || start.rotation * (inertia * start.spin));
            return torque + *drag_moment / context.dt_s;
        }
        let inertia = &shape.rigid.as_ref().expect("a rigid shape").inertia;
        let spin = || start.rotation * (inertia * start.spin);
        spin_torque(shape, context, path, (drive, &torque), spin, report)
    }

    /// Velocities, accelerations and positions at the end of the step.
    fn advance(&self, context: &StepContext, nodes: &mut NodeSlices) {
        for (i, u) in self.increment.iter().enumerate() {
            let (mut v, mut a) = (nodes.velocity[i], nodes.acceleration[i]);
            let predicted = context.predict(&v, &a);
            context.correct(u, &predicted, &mut v, &mut a);
            nodes.acceleration[i] = a;
            nodes.velocity[i] = self.velocity[i];
            nodes.position[i] += u;
        }
    }
}

/// The rigid motion that the nodes are in.
fn start(shape: &Prototype, nodes: &Nodes) -> Result<Start, FrameError> {
    let operator = &shape.operator;
    let center = operator.center(nodes.position);
    let rotation = shape.supports.frame.rotation(operator, nodes.position, &center)?;
    let velocity_m_s = operator.center(nodes.velocity);
    let moving = operator.node_mass.iter().zip(nodes.position).zip(nodes.velocity);
    let moment: Vec3 = moving.map(|((&m, x), v)| m * (x - center).cross(&(v - velocity_m_s))).sum();
    let inertia = shape.rigid.as_ref().expect("a rigid shape");
    let spin = inertia.inverse_lumped * rotation.tr_mul(&moment);
    Ok(Start { center, rotation, velocity_m_s, spin })
}

/// How far the mass centre goes, the force that drives it and its velocity at the end of the step:
/// c m (u − û) = F − α_m F₀.
fn shift(shape: &Prototype, context: &StepContext, start: &Start) -> (Vec3, Vec3, Vec3) {
    let (weights, mass) = (&context.weights, shape.operator.mass_kg);
    let force: Vec3 = context.force.iter().sum();
    // Accelerations of nodes carry the rounding of their places over Δt²; M a does not.
    let (mut velocity, mut acceleration) = (start.velocity_m_s, context.inertia.force / mass);
    let predicted = context.predict(&velocity, &acceleration);
    let push = force - weights.old_inertia * context.inertia.force;
    let c = weights.mass_per_s2;
    let gone = (push / mass + c * predicted) / c;
    context.correct(&gone, &predicted, &mut velocity, &mut acceleration);
    (gone, force, velocity)
}

/// Why no turn was found: forces are not finite, or the turn of the step, Δt ω₀ + ½ Δt² J⁻¹ T, is beyond what it can be solved for.
fn turned_too_far(inertia: &RigidInertia, dt_s: f64, spin: &Vec3, torque: &Vec3) -> BlockError {
    let by_torque = 0.5 * dt_s * dt_s * (inertia.inverse * torque);
    let angle_rad = (dt_s * spin + by_torque).norm();
    if !angle_rad.is_finite() {
        return BlockError::ForceNotFinite;
    }
    BlockError::TurnsTooFar {
        angle_rad,
        spin_rad_s: spin.norm(),
        torque_n_m: torque.norm(),
        torque_angle_rad: by_torque.norm(),
    }
}

/// The turn θ of a step, axis times angle in the block's frame, under a torque T there (Simo & Wong 1991):
///
/// ```text
/// exp(θ̂) J (2 θ/Δt − ω₀) = p        p = J ω₀ + Δt T
/// (I + ½ τ θ̂) J (2 θ/Δt − ω₀) = (I − ½ τ θ̂) p        τ = tan(½ |θ|)/(½ |θ|)
/// ```
///
/// both being the same. The spin at the end is J ω₁ = exp(θ̂)ᵀ p, so angular momentum changes by Δt T exactly; ω₀ + ω₁ = 2 θ/Δt and
/// exp(θ̂) θ = θ, so energy changes by the work of T exactly; a block that spins about a principal axis turns by ω Δt exactly. Nothing
/// where no turn fits, which is half a turn at most.
fn turn(inertia: &RigidInertia, spin: &Vec3, torque: &Vec3, dt_s: f64) -> Option<Vec3> {
    let j = &inertia.inertia;
    let old = j * spin;
    let driven = old + dt_s * torque;
    let mut angle = dt_s * (spin + 0.5 * dt_s * (inertia.inverse * torque));
    let mut last = f64::INFINITY;
    for _ in 0..MOST_ITERATIONS {
        let (mean, p) = (2.0 / dt_s * (j * angle) - old, driven);
        let (stretch, growth) = half_angle_stretch(angle.norm_squared())?;
        let moment = angle.cross(&(mean + p));
        let misfit = mean - p + 0.5 * stretch * moment;
        let cross = stretch * angle.cross_matrix();
        let slope = (Mat3::identity() + 0.5 * cross) * (2.0 / dt_s * j)
            - 0.5 * stretch * (mean + p).cross_matrix()
            + growth * moment * angle.transpose();
        let change = slope.try_inverse()? * misfit;
        angle -= change;
        let (size, scale) = (change.norm(), angle.norm() + dt_s * spin.norm());
        // Quadratic convergence: once the change stops shrinking it is round-off.
        if size <= f64::EPSILON * scale || (size < 1e-8 * scale && size >= 0.5 * last) {
            return Some(angle);
        }
        last = size;
    }
    None
}

/// τ = tan(½ θ)/(½ θ) and dτ/dθ² for θ², as long as that is less than half a turn.
fn half_angle_stretch(angle2: f64) -> Option<(f64, f64)> {
    if angle2 < 1e-3 {
        let x = 0.25 * angle2;
        let stretch = 1.0 + x * (1.0 / 3.0 + x * (2.0 / 15.0 + x * 17.0 / 315.0));
        return Some((stretch, 0.25 * (1.0 / 3.0 + x * (4.0 / 15.0 + x * 17.0 / 105.0))));
    }
    let half = 0.5 * angle2.sqrt();
    // Also where the angle is not a number.
    if half.is_nan() || half >= std::f64::consts::FRAC_PI_2 {
        return None;
    }
    let stretch = half.tan() / half;
    Some((stretch, 0.5 * (1.0 + half * half * stretch * stretch - stretch) / angle2))
}

/// exp(θ̂), the turn about θ by |θ|, less than half a turn: I + (t̂ + ½ t̂²)/(1 + ¼ t²) for t = τ θ.
fn rotation_by(angle: &Vec3) -> Mat3 {
    let (stretch, _) = half_angle_stretch(angle.norm_squared()).unwrap_or((1.0, 0.0));
    let t = stretch * angle;
    let cross = t.cross_matrix();
    Mat3::identity() + (cross + 0.5 * cross * cross) / (1.0 + 0.25 * t.norm_squared())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slab() -> RigidInertia {
        let inertia = Mat3::new(3.0, 0.2, 0.1, 0.2, 2.0, -0.1, 0.1, -0.1, 1.5);
        let inverse = inertia.try_inverse().expect("regular");
        RigidInertia { inertia, inverse, inverse_lumped: inverse }
    }

    #[test]
    fn a_rotation_turns_by_its_angle_without_stretching() {
        for size in [1e-9, 1e-3, 0.03, 0.032, 1.0, 3.0] {
            let angle = size * Vec3::new(0.3, -2.0, 1.1).normalize();
            let turned = rotation_by(&angle);
            assert!((turned.transpose() * turned - Mat3::identity()).amax() < 1e-15);
            let exact = nalgebra::Rotation3::new(angle);
            assert!((turned - exact.matrix()).amax() < 2e-15, "{size}: {}", (turned - exact.matrix()).amax());
        }
    }

    #[test]
    fn the_stretch_of_a_half_angle_has_its_own_slope() {
        for angle2 in [1e-4, 0.9e-3, 1.1e-3, 0.5, 4.0, 9.0] {
            let at = |x: f64| half_angle_stretch(x).expect("less than half a turn");
            let change = 1e-4 * angle2;
            let slope = (at(angle2 + change).0 - at(angle2 - change).0) / (2.0 * change);
            assert!((slope / at(angle2).1 - 1.0).abs() < 1e-5, "{angle2}: {slope} and {}", at(angle2).1);
        }
        assert_eq!(half_angle_stretch(9.9), None);
    }

    #[test]
    fn a_free_turn_keeps_energy_and_a_torque_does_its_work() {
        let (block, dt_s) = (slab(), 0.05);
        let energy = |spin: &Vec3| 0.5 * spin.dot(&(block.inertia * spin));
        for torque in [Vec3::zeros(), Vec3::new(1.0, -2.0, 0.5)] {
            let spin = Vec3::new(1.0, 3.0, -2.0);
            let angle = turn(&block, &spin, &torque, dt_s).expect("a turn");
            let end = block.inverse * rotation_by(&angle).tr_mul(&(block.inertia * spin + dt_s * torque));
            let gain = energy(&end) - energy(&spin) - torque.dot(&angle);
            assert!(gain.abs() < 1e-14 * energy(&spin), "{gain}");
            assert!((0.5 * dt_s * (spin + end) - angle).norm() < 1e-15);
        }
    }

    #[test]
    fn a_turn_that_cannot_be_found_names_its_cause() {
        // From rest, a torque turns the block by ½ Δt² J⁻¹ T = 4 rad in a step: the cause is the torque, not a spin.
        let (block, dt_s) = (slab(), 0.1);
        let torque = block.inertia * Vec3::new(0.0, 0.0, 8.0 / (dt_s * dt_s));
        assert_eq!(turn(&block, &Vec3::zeros(), &torque, dt_s), None);
        let error = turned_too_far(&block, dt_s, &Vec3::zeros(), &torque);
        let BlockError::TurnsTooFar { angle_rad, spin_rad_s, torque_n_m, torque_angle_rad } = error else {
            panic!("{error}")
        };
        assert!((angle_rad - 4.0).abs() < 1e-12 && (torque_angle_rad - 4.0).abs() < 1e-12);
        assert_eq!((spin_rad_s, torque_n_m), (0.0, torque.norm()));
        let nothing = Vec3::repeat(f64::NAN);
        assert_eq!(turn(&block, &Vec3::zeros(), &nothing, dt_s), None);
        assert_eq!(turned_too_far(&block, dt_s, &Vec3::zeros(), &nothing), BlockError::ForceNotFinite);
    }

    #[test]
    fn a_spin_beyond_all_measure_is_refused_or_bounded() {
        for spin in [1e3, 1e9, 1e200, f64::NAN] {
            let angle = turn(&slab(), &Vec3::new(spin, 1.0, -spin), &Vec3::zeros(), 1.0);
            assert!(angle.is_none_or(|a| a.iter().all(|x| x.is_finite())), "{angle:?}");
        }
    }
}
