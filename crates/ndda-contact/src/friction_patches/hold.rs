//! A patch of blocks that deform, while it sticks: a stiff spring and a damper.
//!
//! ```text
//! F′ = F − η m_eff v/Δt,   and F′ − ζ m_eff v/Δt on the block,   |F′| ≤ μN
//! T′ = T − η J_eff ω/Δt,   the same with J_eff and ω,   |T′| ≤ μ N r √(1 − (F′/μN)²)
//! ```
//!
//! v and ω are the slip velocity and spin of the surfaces themselves, weighted by pressure. A force that stopped the rigid motion of the blocks in every step
//! would feed their vibrations with energy, one that stopped the slip of each facet would be clipped at μN by their ringing: with either
//! of them a block on a slope creeps.

use ndda_mesh::Vec3;

use crate::friction_patches::patch::ContactPatch;
use crate::model::FaceMemory;

/// η = (ω_s Δt)² of the spring that holds a face.
const SPRING: f64 = 0.1;
/// ζ, the part of a slip velocity that a step takes away.
const DAMPER: f64 = 0.2;

impl ContactPatch {
    /// Friction of a patch that stuck in the last step, and moves so much mass per area.
    pub fn hold(&mut self, mass_per_area: f64, dt_s: f64) {
        let Some(old) = self.previous else { return };
        let rate = mass_per_area * self.area_m2 / dt_s;
        let twist_rate = rate * self.radius2();
        let (spring_n, slides) = self.limited(old.force_n - SPRING * rate * self.velocity_m_s);
        let most_n_m = self.most_torque_n_m(&spring_n);
        let spring_n_m = (old.torque_n_m - SPRING * twist_rate * self.spin_rad_s).clamp(-most_n_m, most_n_m);
        self.memory = FaceMemory {
            force_n: spring_n,
            torque_n_m: spring_n_m,
            slides,
            held: true,
            normal: self.normal,
            ..FaceMemory::default()
        };
        (self.force_n, _) = self.limited(spring_n - DAMPER * rate * self.velocity_m_s);
        let most_n_m = self.most_torque_n_m(&self.force_n);
        self.torque_n_m = (spring_n_m - DAMPER * twist_rate * self.spin_rad_s).clamp(-most_n_m, most_n_m);
    }

    /// A force no longer than μN, and whether it was.
    fn limited(&self, force_n: Vec3) -> (Vec3, bool) {
        let size = force_n.norm();
        if size > self.most_n { (force_n * (self.most_n / size), true) } else { (force_n, false) }
    }

    /// μ N r √(1 − (F/μN)²).
    fn most_torque_n_m(&self, force_n: &Vec3) -> f64 {
        let used = if self.most_n > 0.0 { force_n.norm() / self.most_n } else { 1.0 };
        self.most_n * self.radius2().sqrt() * (1.0 - used * used).max(0.0).sqrt()
    }
}
