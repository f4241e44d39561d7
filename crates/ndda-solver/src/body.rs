//! One step of one block, alone, whatever kind of body it is.

use ndda_fem::FrameError;
use ndda_mesh::{Mat3, Vec3};
use serde::Serialize;

use crate::batch::Batch;
use crate::elastic_body::ElasticBody;
use crate::fixed_body::FixedBody;
use crate::for_each_block::{NodeSlices, Nodes};
use crate::linear_solver::{Factor, SolveError};
use crate::mass_damping::MassDamping;
use crate::rigid_body::RigidBody;
use crate::ringing::Drive;
use crate::shape::Shape;
use crate::squeeze::Sideways;
use crate::time_integrator::{Inertia, StepWeights, TimeIntegrator};

/// How a block may move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BodyKind {
    /// Each node by itself: linear tetrahedra.
    #[default]
    Elastic,
    /// All nodes by one affine map, 12 unknowns: the first-order block of classic DDA (Shi 1988).
    Affine,
    /// Without deformation, 6 unknowns.
    Rigid,
    /// Not at all, or as prescribed: no unknowns.
    Fixed,
}

impl BodyKind {
    /// Whether all its nodes move by one affine map, so that plane faces stay plane.
    pub fn is_affine(self) -> bool {
        self != Self::Elastic
    }
}

/// Why a block could not take a step.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BlockError {
    /// The shape has no rotation any more.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// Its equations were not solved.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The rotation of a rigid block in a step cannot be solved for; half a turn at most has a solution.
    #[error(
        "its rotation in this step, about {angle_rad:.3} rad, is too large to be solved for: a torque of {torque_n_m:.3e} N m turns it by \
         {torque_angle_rad:.3} rad, from {spin_rad_s:.3e} rad/s at the start: reduce step_s, or penalty_pa if contact exerts the torque"
    )]
    TurnsTooFar {
        /// |Δt ω₀ + ½ Δt² J⁻¹ T| [rad].
        angle_rad: f64,
        /// |ω₀|, its spin at the start of the step [rad/s].
        spin_rad_s: f64,
        /// |T|, the torque of loads and contact about its mass centre [N m].
        torque_n_m: f64,
        /// |½ Δt² J⁻¹ T| [rad].
        torque_angle_rad: f64,
    },
    /// The loads and contact forces on a rigid block are infinite or not a number.
    #[error("the forces on it are not finite: reduce step_s or penalty_pa, or check the units of its loads")]
    ForceNotFinite,
    /// A velocity is beyond what the material can carry, or not a number.
    #[error(
        "node {node} moves at {speed_m_s:e} m/s, more than ten times its wave speed {wave_speed_m_s:e} m/s: \
         reduce step_s, or the penalty if contact is stiff"
    )]
    TooFast {
        /// The node, counted from the block's first.
        node: usize,
        /// Its speed [m/s].
        speed_m_s: f64,
        /// Wave speed of the material [m/s].
        wave_speed_m_s: f64,
    },
}

/// What a block step needs besides the block itself.
pub struct StepContext<'a> {
    /// The integrator.
    pub integrator: &'a dyn TimeIntegrator,
    /// Damping in proportion to mass.
    pub drag: Option<MassDamping>,
    /// The integrator's weights for this step and block.
    pub weights: StepWeights,
    /// Δt [s].
    pub dt_s: f64,
    /// Time at the start of the step [s].
    pub time_s: f64,
    /// Time at the end of the step [s].
    pub end_s: f64,
    /// Where contact was evaluated, x* per node of the block [m].
    pub contact_position: &'a [Vec3],
    /// How far ahead of that contact saw it [m].
    pub ahead: Vec3,
    /// Force per node of the block, contact and constant loads [N].
    pub force: &'a [Vec3],
    /// The loads in it [N].
    pub external: &'a [Vec3],
    /// Those of them that change over time [N]; empty if none do.
    pub changing: &'a [Vec3],
    /// Friction's part of it [N]; empty without friction.
    pub friction_force: &'a [Vec3],
    /// Row sums of the contact stiffness [N/m]; empty without contact.
    pub contact_stiffness: &'a [f64],
    /// Part of a contact force whose direction is not known, and that no friction bears.
    pub loose: f64,
    /// M a of the block as a whole at the start; zero where it does not matter.
    pub inertia: Inertia,
    /// Σ w × F of the contact forces on the block, w being the velocity of the pair of blocks in contact [N m/s]; zero where contact is
    /// taken in the middle of the step.
    pub carried: Vec3,
}

impl StepContext<'_> {
    /// Time at which supports pull: (1 − θ) start + θ end [s].
    pub(crate) fn theta_time_s(&self) -> f64 {
        self.time_s + self.weights.stiffness * (self.end_s - self.time_s)
    }

    /// The point about which a block reports torques [m]: its mass centre at x* if its orbital moment is reported apart
    /// (`contact_moments.rs`), else the origin.
    pub(crate) fn moment_point(&self, shape: &Shape) -> Vec3 {
        if self.weights.contact_in_the_middle() || !shape.is_free() {
            Vec3::zeros()
        } else {
            shape.operator.center(self.contact_position)
        }
    }

    /// û, the displacement of the step as far as it is known beforehand [m].
    #[inline]
    pub(crate) fn predict(&self, velocity: &Vec3, acceleration: &Vec3) -> Vec3 {
        match &self.drag {
            None => self.integrator.predict(self.dt_s, velocity, acceleration),
            Some(drag) => drag.predict(self.integrator, self.dt_s, velocity, acceleration),
        }
    }

    /// Velocity and acceleration at the end of the step from u and û.
    #[inline]
    pub(crate) fn correct(&self, increment: &Vec3, predicted: &Vec3, v: &mut Vec3, a: &mut Vec3) {
        match &self.drag {
            None => self.integrator.correct(self.dt_s, increment, predicted, v, a),
            Some(drag) => drag.correct(self.integrator, (self.dt_s, increment, predicted), v, a),
        }
    }

    /// Moment by which drag changes an angular momentum `old` [kg m²/s] in a step under a torque.
    pub(crate) fn drag_moment(&self, torque: &Vec3, old: impl FnOnce() -> Vec3) -> Vec3 {
        let impulse = self.dt_s * torque;
        self.drag.map_or_else(Vec3::zeros, |drag| drag.gain(&old(), &impulse) - impulse)
    }
}

/// What a block reports of its step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BlockReport {
    /// Force that supports exerted on the block [N].
    pub reaction: Vec3,
    /// Torque of that force, at mid-step, and of the loads, at x* [N m]: about the origin, or about the mass centre where the moment of the
    /// resultant is `orbital_impulse`.
    pub outside_torque: Vec3,
    /// Change of momentum of a block that moves as prescribed; its rate is part of `reaction` [N s].
    pub motion_impulse: Vec3,
    /// Moment about the origin of the impulse of loads, which act along the path of the mass centre, and of `motion_impulse` [N m s].
    pub orbital_impulse: Vec3,
    /// Work of prescribed motions [J].
    pub motion_work_j: f64,
    /// Work of loads that change over time [J].
    pub load_work_j: f64,
    /// Work of damping [J].
    pub damping_work_j: f64,
    /// Impulses beside the forces, of damping and of prescribed velocities [kg m/s].
    pub impulse: Vec3,
    /// Their moment about the origin [kg m²/s].
    pub impulse_moment: Vec3,
    /// Error of velocities that damping leaves in the step, mean square over the mass [m/s].
    pub damping_error_m_s: f64,
    /// Work of friction [J].
    pub friction_work_j: f64,
    /// Fastest node [m/s].
    pub speed_m_s: f64,
    /// Largest Σ|k| / m over the nodes [1/s²]: a bound of ω_c².
    pub contact_rate2: f64,
    /// Velocity that it owes to the unknown direction of contact forces.
    pub sideways: Sideways,
    /// M a of the block as a whole at the end; for free blocks only.
    pub inertia: Inertia,
    /// What drives it as a whole.
    pub drive: Drive,
}

/// One block on its way: memory sized once, written every step.
pub struct Body {
    /// Index of its shape.
    pub shape: usize,
    /// How it moves.
    pub motion: Motion,
    /// What it reports of the last step.
    pub report: BlockReport,
    /// Why the last step failed.
    pub error: Option<BlockError>,
    /// Room to solve for the run of congruent blocks that it leads.
    pub batch: Option<Box<Batch>>,
}

/// The ways in which a block moves.
pub enum Motion {
    /// Elastic and affine blocks.
    Elastic(Box<ElasticBody>),
    /// Rigid blocks.
    Rigid(RigidBody),
    /// Blocks that stay, or go where they are told to.
    Fixed(FixedBody),
}

impl Body {
    /// Advances the block by one step and keeps what it reports, or why it could not.
    pub fn step(&mut self, shape: &Shape, context: &StepContext, nodes: NodeSlices) {
        let report = match &mut self.motion {
            Motion::Elastic(body) => body.step(shape, context, nodes),
            Motion::Rigid(body) => body.step(shape, context, nodes),
            Motion::Fixed(body) => Ok(body.step(shape, context, nodes)),
        };
        match report {
            Ok(report) => self.report = report,
            Err(error) => self.error = Some(error),
        }
    }

    /// Memory of solves for another factor of the same matrix structure.
    pub fn renew_scratch(&mut self, factor: &dyn Factor, filter: Option<&dyn Factor>) {
        if let Some(batch) = &mut self.batch {
            **batch = Batch::new(factor);
        }
        if let Some(body) = self.elastic() {
            body.scratch = factor.new_scratch();
            if let (Some(damping), Some(filter)) = (&mut body.damping, filter) {
                damping.renew_scratch(filter);
            }
        }
    }

    /// The right-hand side of a block with a factor, to be solved for together with others.
    pub fn prepare(&mut self, shape: &Shape, context: &StepContext, nodes: &Nodes) {
        if let Some(body) = self.elastic() {
            self.error = body.prepare(shape, context, nodes).err();
        }
    }

    /// The rest of a step that is prepared and solved for.
    pub fn finish(&mut self, shape: &Shape, context: &StepContext, nodes: NodeSlices) {
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
    pub fn try_step(&mut self, shape: &Shape, context: &StepContext, nodes: &Nodes) {
        let tried = match &mut self.motion {
            Motion::Elastic(body) => body.try_step(shape, context, nodes),
            Motion::Rigid(body) => body.try_step(shape, context, nodes),
            Motion::Fixed(_) => Ok(()),
        };
        self.error = tried.err();
    }

    /// out ← x + u as last tried [m].
    pub fn place_end(&self, shape: &Shape, end_s: f64, position: &[Vec3], out: &mut [Vec3]) {
        let increment = match &self.motion {
            Motion::Elastic(body) => body.increment(),
            Motion::Rigid(body) => body.increment(),
            Motion::Fixed(body) => return body.end_position(shape, end_s, position, out),
        };
        for ((end, x), u) in out.iter_mut().zip(position).zip(increment) {
            *end = x + u;
        }
    }

    /// out ← how u as last tried changes with the force, linearised.
    pub fn respond(&mut self, shape: &Shape, weights: &StepWeights, force: &[Vec3], out: &mut [Vec3]) {
        match &mut self.motion {
            Motion::Elastic(body) => {
                out.copy_from_slice(force);
                if let Err(error) = body.respond_in_place(shape, out) {
                    self.error = Some(error);
                }
            }
            Motion::Rigid(body) => body.respond(shape, weights, force, out),
            Motion::Fixed(_) => out.fill(Vec3::zeros()),
        }
    }

    /// The deforming part, where there is one.
    pub fn elastic(&mut self) -> Option<&mut ElasticBody> {
        match &mut self.motion {
            Motion::Elastic(body) => Some(body),
            Motion::Rigid(_) | Motion::Fixed(_) => None,
        }
    }
}

impl BlockReport {
    /// Work, impulse and error of damping in proportion to mass, which acts on the block as a whole, too. Its moment is that of its forces
    /// at x*; a free block has noted that about its mass centre already, and all of it where contact is not taken in the middle of a step.
    pub(crate) fn book_drag(
        &mut self,
        shape: &Shape,
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

    /// Torque of loads, work of friction and of changing loads, the contact rate of a step u [m], and what squeezes a block turned by R.
    pub(crate) fn book(
        &mut self,
        shape: &Shape,
        context: &StepContext,
        (rotation, increment): (&Mat3, &[Vec3]),
    ) {
        let point = context.moment_point(shape) - context.ahead;
        for (x, f) in context.contact_position.iter().zip(context.external) {
            self.outside_torque += (x - point).cross(f);
        }
        self.outside_torque += context.ahead.cross(&self.reaction);
        self.impulse_moment += context.ahead.cross(&self.impulse);
        for (load, u) in context.changing.iter().zip(increment) {
            self.load_work_j += load.dot(u);
        }
        for (friction, u) in context.friction_force.iter().zip(increment) {
            self.friction_work_j += friction.dot(u);
        }
        for (stiffness, mass) in context.contact_stiffness.iter().zip(&shape.operator.node_mass) {
            self.contact_rate2 = self.contact_rate2.max(stiffness / mass);
        }
        self.drive = Drive::of(shape, context, rotation, self);
        if self.contact_rate2 > 0.0 && context.loose > 0.0 {
            self.sideways = Sideways::of(shape, context, self);
        }
    }
}

/// The fastest of a block's velocities [m/s], which must be finite and slower than ten waves.
///
/// # Errors
/// [`BlockError::TooFast`] naming the node.
pub(crate) fn checked_speed(shape: &Shape, velocity: &[Vec3]) -> Result<f64, BlockError> {
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

/// Displacement of a prescribed motion, zero where there is none [m].
pub(crate) fn displacement_at(shape: &Shape, motion: Option<usize>, time_s: f64) -> Vec3 {
    motion.map_or(Vec3::zeros(), |m| shape.supports.motions[m].displacement(time_s))
}
