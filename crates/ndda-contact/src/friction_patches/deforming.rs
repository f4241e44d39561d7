//! Friction of a patch of which at least one block deforms: found from this patch alone.
//!
//! ```text
//! touching, sliding   F′ = F − m_eff v₁/Δt,   |F′| ≤ μN                              stops the slip of this step, or slides
//! sticking            F′ = F − η m_eff v/Δt,   and F′ − ζ m_eff v/Δt on the block   a stiff spring and a damper
//! torque              the same with J_eff and ω,   |T′| ≤ μ N r √(1 − (F′/μN)²)
//! ```
//!
//! v₁ is the slip velocity that the rigid motion of both blocks would have at the end of the step under the loads and normal forces of this
//! step and the friction of the last; v and ω are the slip velocity and spin of the surfaces themselves, weighted by pressure;
//! m_eff is the mass that the patch moves within the step ([`mass_per_area`](crate::facets::mass_per_area)); r is the mean
//! distance of the pressure from its centre. A force that stopped the rigid motion in every step would feed the vibrations of a block with
//! energy, one that stopped the slip of each facet would be clipped at μN by their ringing: with either of them a block
//! that sticks on a slope creeps.
//!
//! The limit of force and torque is an ellipsoid, so Coulomb friction takes D(u, θ) = μN √(|u|² + r² θ²) from a displacement.

use ndda_mesh::Vec3;

use crate::friction_patches::patch::ContactPatch;
use crate::model::{Body, FaceMemory};

/// η = (ω_s Δt)² of the spring that holds a face.
const SPRING: f64 = 0.1;
/// ζ, the part of a slip velocity that a step takes away.
const DAMPER: f64 = 0.2;

impl ContactPatch {
    /// Friction of a patch that moves so much mass per area; `bodies` are the blocks at the end of the step under the friction of the last.
    pub fn advance_alone(&mut self, bodies: &[Body], mass_per_area: f64, dt_s: f64) {
        let rate = mass_per_area * self.area_m2 / dt_s;
        match self.previous {
            Some(old) if !old.slides => self.hold(&old, rate),
            Some(old) => self.stop(bodies, &old, rate),
            None => self.stop(bodies, &FaceMemory::default(), rate),
        }
    }

    /// Touching or sliding: what stops the rigid motion in this step, or all there is.
    fn stop(&mut self, bodies: &[Body], old: &FaceMemory, rate: f64) {
        let (velocity, spin) = self.slip_to_come(bodies);
        let (force_n, slides) = self.limited(old.force_n - rate * velocity);
        let most_n_m = self.most_torque_n_m(&force_n);
        let torque_n_m = (old.torque_n_m - rate * self.radius2() * spin).clamp(-most_n_m, most_n_m);
        (self.force_n, self.torque_n_m) = (force_n, torque_n_m);
        self.memory =
            FaceMemory { force_n, torque_n_m, slides, normal: self.normal, ..FaceMemory::default() };
    }

    /// Sticking: a spring and a damper.
    fn hold(&mut self, old: &FaceMemory, rate: f64) {
        let twist_rate = rate * self.radius2();
        let (force_n, slides) = self.limited(old.force_n - SPRING * rate * self.velocity_m_s);
        let most_n_m = self.most_torque_n_m(&force_n);
        let torque_n_m = (old.torque_n_m - SPRING * twist_rate * self.spin_rad_s).clamp(-most_n_m, most_n_m);
        self.memory =
            FaceMemory { force_n, torque_n_m, slides, normal: self.normal, ..FaceMemory::default() };
        (self.force_n, _) = self.limited(force_n - DAMPER * rate * self.velocity_m_s);
        let most_n_m = self.most_torque_n_m(&self.force_n);
        self.torque_n_m = (torque_n_m - DAMPER * twist_rate * self.spin_rad_s).clamp(-most_n_m, most_n_m);
    }

    /// Slip velocity at the end of the step, and spin about the normal, if this patch's friction did not change.
    fn slip_to_come(&self, bodies: &[Body]) -> (Vec3, f64) {
        let (own, other) = (&bodies[self.owner.index()], &bodies[self.target.index()]);
        let velocity = own.velocity_at(&self.center) - other.velocity_at(&self.center);
        let spin = own.spin_rad_s - other.spin_rad_s;
        (velocity - self.normal * self.normal.dot(&velocity), spin.dot(&self.normal))
    }

    /// A force no longer than μN, and whether it was.
    fn limited(&self, force_n: Vec3) -> (Vec3, bool) {
        let size = force_n.norm();
        if size > self.most_n { (force_n * (self.most_n / size), true) } else { (force_n, false) }
    }

    /// μ N r √(1 − (F/μN)²).
    fn most_torque_n_m(&self, force_n: &Vec3) -> f64 {
        let used = if self.most_n > 0.0 { force_n.norm() / self.most_n } else { 1.0 };
        self.most_n * self.radius_m * (1.0 - used * used).max(0.0).sqrt()
    }
}
