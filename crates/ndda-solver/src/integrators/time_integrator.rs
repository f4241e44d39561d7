//! The contract of a time integrator.

use ndda_mesh::Vec3;
use serde::{Deserialize, Serialize};

/// The numbers by which one step is weighted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepWeights {
    /// θ: elasticity acts as (1 − θ) of its value at the start plus θ of that at the end.
    pub stiffness: f64,
    /// c = (1 − α_m)/(β Δt²) [1/s²]: what accelerates at the end of the step is c M (u − û).
    pub mass_per_s2: f64,
    /// ∂v₁/∂u [1/s].
    pub velocity_per_m: f64,
    /// Whether u = Δt (v₀ + v₁)/2.
    pub mean_velocity: bool,
    /// Contact acts at x* = x + lead · Δt v + lead₂ · Δt² a.
    pub contact_lead: f64,
    /// lead₂.
    pub contact_lead_acceleration: f64,
    /// Loads that change over time act by their mean over the Δt about start + lead · Δt.
    pub load_lead: f64,
    /// γ: the momentum changes by Δt [(1 − γ) f_old + γ f_new].
    pub new_force: f64,
    /// α_m: inertia acts as α_m of its value at the start plus (1 − α_m) of that at the end.
    pub old_inertia: f64,
    /// Whether the acceleration at the start of a step matters, so that a run must begin with M a = f − K d.
    pub needs_acceleration: bool,
}

impl StepWeights {
    /// Whether the arms of contact are those of the middle of the step, so that a block's momentum has no moment.
    pub fn contact_in_the_middle(&self) -> bool {
        self.contact_lead == 0.5 && self.mean_velocity
    }

    /// How far from the middle of a step elasticity acts, over the step: θ − ½ of `Midpoint`, γ − ½ of `Newmark`, nothing where inertia is weighted so as
    /// to make up for it (`GeneralizedAlpha`).
    pub fn elastic_lag(&self) -> f64 {
        if self.old_inertia != 0.0 {
            0.0
        } else if self.forces_do_their_work() {
            (self.stiffness - 0.5).abs()
        } else {
            (self.new_force - 0.5).abs()
        }
    }

    /// w: quiet faces resist (1 − w) of the velocity at the start plus w of that at the end; as elasticity is weighted, but where u = Δt (v₀ + v₁)/2 by
    /// the mean, so that what they take is never negative.
    pub(crate) fn drag(&self) -> f64 {
        if self.mean_velocity { 0.5 } else { self.stiffness }
    }

    /// w ∂v₁/∂u [1/s]; none for a matrix without time, as M alone.
    pub(crate) fn drag_per_m(&self) -> f64 {
        if self.stiffness == 0.0 { 0.0 } else { self.drag() * self.velocity_per_m }
    }

    /// Whether the work of a force over a step is what it changes of kinetic energy.
    pub fn forces_do_their_work(&self) -> bool {
        self.mean_velocity && self.new_force == 1.0 && self.old_inertia == 0.0
    }

    /// M a at the end of a step that `force` drives from M a = `old` at its start; the same holds for torques.
    pub fn inertia(&self, force: &Vec3, old: &Vec3) -> Vec3 {
        (force - self.old_inertia * old) / (1.0 - self.old_inertia)
    }

    /// β of u = Δt v₀ + Δt² [(½ − β) a₀ + β a₁].
    pub fn beta(&self, dt_s: f64) -> f64 {
        (1.0 - self.old_inertia) / (self.mass_per_s2 * dt_s * dt_s)
    }

    /// The mean of M a by which momentum changes in a step.
    pub fn mean_inertia(&self, old: &Vec3, new: &Vec3) -> Vec3 {
        (1.0 - self.new_force) * old + self.new_force * new
    }
}

/// Acceleration of a block as a whole at the end of a step, of which integrators with `old_inertia` or `new_force` < 1 remember a part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Inertia {
    /// Σ M a [N].
    pub force: Vec3,
    /// Rate at which loads and contact change the angular momentum about the mass centre [N m].
    pub torque: Vec3,
    /// The part of `force` that contact exerts; only where the moments of past contact forces matter, as the next two [N].
    pub contact: Vec3,
    /// Σ w × F of contact forces F, w being the velocity of the pair of blocks in contact (`contact_moments.rs`) [N m/s].
    pub carried: Vec3,
    /// Moment about the mass centre that past contact forces have where they acted, as seen by an observer who moves at w [N m].
    pub lag: Vec3,
}

/// An integrator of one step and one stage for M a + K d = f, with no memory but velocities and accelerations (multi-stage ones, as Bathe's, take a
/// solver of their own), solved per block as
/// (θ K + c M)(u − û) = f − α_m M a − (1 − θ) K d − θ K (d + û).
///
/// Contract (checked by [`check_integrator`](crate::testing::check_integrator)): exact for constant acceleration,
/// keeps constant velocity, `correct` undoes `predict` when the step brings no acceleration, the weights say what `correct` does, and an
/// elastic oscillator converges and never grows.
pub trait TimeIntegrator: Send + Sync {
    /// Name in reports.
    fn name(&self) -> &'static str;

    /// Weights of a step Δt [s].
    fn weights(&self, dt_s: f64) -> StepWeights;

    /// û: the displacement of the step as far as it is known beforehand [m].
    fn predict(&self, dt_s: f64, velocity: &Vec3, acceleration: &Vec3) -> Vec3;

    /// Velocity and acceleration at the end of the step from u and û.
    fn correct(
        &self,
        dt_s: f64,
        increment: &Vec3,
        predicted: &Vec3,
        velocity: &mut Vec3,
        acceleration: &mut Vec3,
    );

    /// Largest stable h = ω_c Δt for contact evaluated explicitly; `None` if there is none above zero.
    fn contact_bound(&self) -> Option<f64>;

    /// Whether it was chosen to damp elastic modes, those that a step resolves included.
    fn damps_elasticity(&self) -> bool {
        false
    }

    /// Whether vibrations that a step does not resolve die out.
    fn damps_vibrations(&self) -> bool {
        self.damps_elasticity()
    }
}
