//! A block's report on a step.

use ndda_mesh::Vec3;

use crate::integrators::time_integrator::Inertia;

/// A block's report on its step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BlockReport {
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
    /// Energy that left through quiet faces [J].
    pub radiated_j: f64,
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
    /// Lateral velocity due to the uncertain direction of contact forces.
    pub lateral_drift: LateralDrift,
    /// M a of the block as a whole at the end; for free blocks only.
    pub inertia: Inertia,
    /// Forcing of its rigid motion.
    pub drive: RigidForcing,
}

/// Forcing of a block's rigid motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct RigidForcing {
    /// Force of loads over its mass [m/s²].
    pub load_m_s2: Vec3,
    /// Acceleration of translation by loads, contact and supports [m/s²].
    pub shift_m_s2: Vec3,
    /// Half the sum of the sizes of contact forces on its nodes, over its mass: what presses it from both sides [m/s²]. Zero for a
    /// block that does not deform, and where contact is taken in the middle of a step.
    pub pressed_m_s2: f64,
    /// Angular acceleration about its mass centre, times its radius; zero for a held block [m/s²].
    pub turn_m_s2: Vec3,
    /// Whether contact or supports act on it.
    pub is_held: bool,
    /// Whether contact does.
    pub touches: bool,
    /// Speed of its fastest node [m/s].
    pub speed_m_s: f64,
    /// Whether friction acts on it.
    pub has_friction: bool,
}

/// Velocity that forces of unknown direction give a block [m/s].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LateralDrift {
    /// Of its mass centre.
    pub shift_m_s: Vec3,
    /// Of its turn about the axis along which it is pressed, at its radius of gyration.
    pub turn_m_s: Vec3,
}
