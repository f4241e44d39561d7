//! One side of a joint that is tested.

use ndda_contact::{FrictionLaw, ShearMemory};

/// One side of a joint of a square metre.
#[derive(Clone)]
pub(super) struct Side {
    pub(super) shear_n: [f64; 2],
    pub(super) broken: bool,
    pub(super) state: Vec<f64>,
    /// Slip, and part that is broken, of bonds that break gradually.
    pub(super) slip_m: f64,
    pub(super) damage: f64,
}

impl Side {
    /// A side that has its cohesion, with what its law begins with.
    pub(super) fn whole(state: Vec<f64>) -> Self {
        Self { shear_n: [0.0; 2], broken: false, state, slip_m: 0.0, damage: 0.0 }
    }

    /// Shows the law what it remembers.
    pub(super) fn memory<R>(&mut self, with: impl FnOnce(&mut ShearMemory) -> R) -> R {
        let mut memory = ShearMemory { shear_n: self.shear_n, broken: self.broken, state: &mut self.state };
        let result = with(&mut memory);
        (self.shear_n, self.broken) = (memory.shear_n, memory.broken);
        result
    }

    /// Shear stress of both sides against the slip: friction, and what bonds carry that break gradually [Pa].
    pub(super) fn shear_pa(&self, law: &dyn FrictionLaw) -> f64 {
        let bonds = law.fracture().map_or(0.0, |f| (1.0 - self.damage) * f.stiffness_pa_m * self.slip_m);
        bonds - 2.0 * self.shear_n[0]
    }

    /// Energy in the springs of both sides [J/m²].
    pub(super) fn stored_j_m2(&self, law: &dyn FrictionLaw) -> f64 {
        let (stiffness_pa_m, rubs_pa) = (law.shear_stiffness_pa_m(), 2.0 * self.shear_n[0]);
        let Some(fracture) = law.fracture() else { return 0.5 * rubs_pa * rubs_pa / stiffness_pa_m };
        let bonds = 0.5 * (1.0 - self.damage) * fracture.stiffness_pa_m * self.slip_m * self.slip_m;
        if self.damage > 0.0 {
            bonds + 0.5 * rubs_pa * rubs_pa / (self.damage * stiffness_pa_m)
        } else {
            bonds
        }
    }
}
