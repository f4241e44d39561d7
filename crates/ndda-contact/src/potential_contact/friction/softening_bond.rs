//! Bonds that break gradually, by a fracture energy.

use crate::friction::fracture::Fracture;
use crate::friction::law::{FacetSlip, FrictionLaw, ShearMemory, capped};

/// Bonds that soften by a fracture energy in tension and shear, with Coulomb friction on what is broken: τ = (1 − D) k δ_s + τ_f, |τ_f| ≤ D σ tan φ.
///
/// Facets that touch when contact is first evaluated are bonded at three points each, so that a joint carries moments; contacts that form later have
/// friction alone. The law itself is that of the broken part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SofteningBond {
    friction: f64,
    fracture: Fracture,
}

impl SofteningBond {
    /// Friction angle φ [°] of what is broken, and how bonds break.
    pub fn new(friction_deg: f64, fracture: Fracture) -> Self {
        Self { friction: friction_deg.to_radians().tan(), fracture }
    }
}

impl FrictionLaw for SofteningBond {
    fn name(&self) -> &'static str {
        "bonds that soften by a fracture energy"
    }

    fn advance(&self, slip: &FacetSlip, memory: &mut ShearMemory) {
        let spring = 0.5 * self.fracture.stiffness_pa_m * slip.mean_area_m2;
        let trial = [0, 1].map(|i| memory.shear_n[i] - spring * slip.slip_m[i]);
        memory.shear_n = capped(trial, self.capacity_n(slip, memory)).0;
    }

    /// μ |f_n|, f_n being what the broken part bears.
    fn capacity_n(&self, slip: &FacetSlip, _memory: &ShearMemory) -> f64 {
        self.friction * slip.normal_n.max(0.0)
    }

    fn shear_stiffness_pa_m(&self) -> f64 {
        self.fracture.stiffness_pa_m
    }

    fn holds_together(&self) -> bool {
        true
    }

    fn tension_pa(&self) -> f64 {
        self.fracture.strength_pa[0]
    }

    fn bond_stiffness_pa_m(&self) -> f64 {
        self.fracture.stiffness_pa_m
    }

    fn fracture(&self) -> Option<&Fracture> {
        Some(&self.fracture)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::testing::check_friction;

    #[test]
    fn it_keeps_the_contract_of_a_friction_law() {
        let fracture = Fracture { stiffness_pa_m: 2e10, strength_pa: [3e6, 5e6], energy_j_m2: [1e3, 1e3] };
        check_friction(&SofteningBond::new(35.0, fracture));
    }
}
