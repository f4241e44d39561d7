//! A block's report on a step.

use ndda_mesh::Vec3;
use ndda_ranks::{Packer, Unpacker};

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

impl BlockReport {
    /// Everything in it, in one order.
    fn parts(&mut self) -> ([&mut Vec3; 19], [&mut f64; 11], [&mut bool; 5]) {
        let Self {
            reaction,
            outside_torque,
            motion_impulse,
            orbital_impulse,
            motion_work_j,
            load_work_j,
            damping_work_j,
            radiated_j,
            impulse,
            impulse_moment,
            damping_error_m_s,
            friction_work_j,
            speed_m_s,
            contact_rate2,
            lateral_drift,
            inertia,
            drive,
        } = self;
        let LateralDrift { shift_m_s, turn_m_s } = lateral_drift;
        let Inertia { force, torque, contact, carried, lag } = inertia;
        let RigidForcing {
            load_m_s2,
            shift_m_s2,
            damped_m_s,
            pressed_m_s2,
            turn_m_s2,
            is_held,
            is_clamped,
            touches,
            speed_m_s: fastest_m_s,
            has_friction,
            contact_rate2: drive_rate2,
            is_free,
            free_m_s2: [free_shift, free_turn],
        } = drive;
        let of_block = [reaction, outside_torque, motion_impulse, orbital_impulse, impulse, impulse_moment];
        let of_parts = [
            shift_m_s, turn_m_s, force, torque, contact, carried, lag, load_m_s2, shift_m_s2, damped_m_s,
            turn_m_s2, free_shift, free_turn,
        ];
        let mut vectors = of_block.into_iter().chain(of_parts);
        let numbers = [
            motion_work_j,
            load_work_j,
            damping_work_j,
            radiated_j,
            damping_error_m_s,
            friction_work_j,
            speed_m_s,
            contact_rate2,
            pressed_m_s2,
            fastest_m_s,
            drive_rate2,
        ];
        let vectors = std::array::from_fn(|_| vectors.next().expect("nineteen of them"));
        (vectors, numbers, [is_held, is_clamped, touches, has_friction, is_free])
    }

    /// Hands it to another rank.
    pub(crate) fn pack(mut self, packer: &mut Packer) {
        let (vectors, numbers, flags) = self.parts();
        packer.put_each(&vectors, |v| <[f64; 3]>::from(**v));
        packer.put_each(&numbers, |x| **x);
        packer.put_each(&flags, |flag| u8::from(**flag));
    }

    /// Takes one from another rank.
    pub(crate) fn unpack(found: &mut Unpacker) -> Self {
        let mut report = Self::default();
        let (vectors, numbers, flags) = report.parts();
        for v in vectors {
            *v = Vec3::from(found.take::<[f64; 3]>());
        }
        for x in numbers {
            *x = found.take();
        }
        for flag in flags {
            *flag = found.take::<u8>() == 1;
        }
        report
    }
}

/// Forcing of a block's rigid motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct RigidForcing {
    /// Force of loads over its mass [m/s²].
    pub load_m_s2: Vec3,
    /// Acceleration of translation by loads, contact and supports, relative to that of the supports [m/s²].
    pub shift_m_s2: Vec3,
    /// Change of velocity in the step by damping in proportion to mass, and by prescribed velocities [m/s].
    pub damped_m_s: Vec3,
    /// Half the sum of the sizes of contact forces on its nodes, over its mass: what presses it from both sides [m/s²]. Zero for a
    /// block that does not deform, and where contact is taken in the middle of a step.
    pub pressed_m_s2: f64,
    /// Angular acceleration about its mass centre, times its radius; zero for a held block [m/s²].
    pub turn_m_s2: Vec3,
    /// Whether contact or supports act on it.
    pub is_held: bool,
    /// Whether supports hold a place of it, or springs pull one back.
    pub is_clamped: bool,
    /// Whether contact does.
    pub touches: bool,
    /// Speed of its fastest node [m/s].
    pub speed_m_s: f64,
    /// Whether friction acts on it.
    pub has_friction: bool,
    /// A bound of ω_c² of its contact [1/s²].
    pub contact_rate2: f64,
    /// Whether neither contact nor supports act on it, and its accelerations then: of its mass centre, and of its rotation times its radius [m/s²]. All
    /// else of its forcing is zero then.
    pub is_free: bool,
    pub free_m_s2: [Vec3; 2],
}

/// Velocity that forces of unknown direction give a block [m/s].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LateralDrift {
    /// Of its mass centre.
    pub shift_m_s: Vec3,
    /// Of its turn about the axis along which it is pressed, at its radius of gyration.
    pub turn_m_s: Vec3,
}
