//! Input of a block's step.

use ndda_mesh::Vec3;

use crate::bodies::mass_damping::MassDamping;
use crate::bodies::prototype::Prototype;
use crate::integrators::time_integrator::{Inertia, StepWeights, TimeIntegrator};

/// Input of a block's step besides the block itself.
pub(crate) struct StepContext<'a> {
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
    /// Springs on which quiet faces rest while a scene settles, over their impedance [1/s]; zero in a run.
    pub settling_per_s: f64,
    /// Where contact was evaluated, x* per node of the block [m].
    pub contact_position: &'a [Vec3],
    /// Contact offset: contact is evaluated this far from where the block is [m].
    pub contact_offset: Vec3,
    /// Force per node of the block, contact and constant loads [N].
    pub force: &'a [Vec3],
    /// The loads in it [N].
    pub external: &'a [Vec3],
    /// Whether nothing but the weight acts on blocks that do not touch, which does not change along their way; not so while a scene settles.
    pub falls_alone: bool,
    /// The part of the loads that changes over time [N]; empty if none does.
    pub changing: &'a [Vec3],
    /// Friction's part of it [N]; empty without friction.
    pub friction_force: &'a [Vec3],
    /// Row sums of the contact stiffness [N/m]; empty without contact.
    pub contact_stiffness: &'a [f64],
    /// Direction uncertainty: part of a contact force whose direction is unknown, and that no friction carries.
    pub direction_uncertainty: f64,
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

    /// Times between which loads act by their mean [s].
    pub(crate) fn load_window_s(&self) -> (f64, f64) {
        let length_s = self.end_s - self.time_s;
        let shift_s = (self.weights.load_lead - 0.5) * length_s;
        (self.time_s + shift_s, self.end_s + shift_s)
    }

    /// The point about which a block reports torques [m]: its mass centre at x* if its orbital moment is reported apart
    /// (`contact_moments.rs`), else the origin.
    pub(crate) fn moment_point(&self, shape: &Prototype) -> Vec3 {
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
