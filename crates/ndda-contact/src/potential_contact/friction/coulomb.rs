//! Coulomb friction with a shear spring: the paper's law.

use crate::friction::law::{FacetSlip, FrictionLaw, ShearMemory, capped};

/// Coulomb friction with a shear spring, the paper's eqs (17)–(19).
///
/// Both sides of a contact patch carry facets, so each gets half the spring: a patch of area S has k_s S in all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb {
    friction: f64,
    shear_penalty_pa_m: f64,
}

impl Coulomb {
    /// Friction angle φ [°], μ = tan φ, and shear penalty k_s [Pa/m].
    pub fn new(friction_deg: f64, shear_penalty_pa_m: f64) -> Self {
        Self { friction: friction_deg.to_radians().tan(), shear_penalty_pa_m }
    }
}

impl FrictionLaw for Coulomb {
    fn name(&self) -> &'static str {
        "Coulomb with a shear spring"
    }

    /// f′ = f − ½ k_s Δu S̄, capped at μ f_n along its own direction; S̄ is the mean of the areas at this step and the last, so that the error of a growing contact is of
    /// second order in Δt.
    fn advance(&self, slip: &FacetSlip, memory: &mut ShearMemory) {
        let spring = 0.5 * self.shear_penalty_pa_m * slip.mean_area_m2;
        let trial = [0, 1].map(|i| memory.shear_n[i] - spring * slip.slip_m[i]);
        memory.shear_n = capped(trial, self.capacity_n(slip, memory)).0;
    }

    fn shear_stiffness_pa_m(&self) -> f64 {
        self.shear_penalty_pa_m
    }

    /// μ f_n; normal forces of contact are never negative.
    fn capacity_n(&self, slip: &FacetSlip, _memory: &ShearMemory) -> f64 {
        self.friction * slip.normal_n
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::testing::check_friction;

    #[test]
    fn it_keeps_the_contract_of_a_friction_law() {
        check_friction(&Coulomb::new(35.0, 2e10));
        check_friction(&Coulomb::new(0.0, 1e3));
    }

    #[test]
    fn below_the_cap_it_is_a_spring_and_above_it_slides() {
        let law = Coulomb::new(45.0, 2.0);
        let mut memory = ShearMemory::default();
        let slip =
            FacetSlip { normal_n: 10.0, mean_area_m2: 3.0, slip_m: [1.0, 0.0], ..FacetSlip::default() };
        law.advance(&slip, &mut memory);
        assert_eq!(memory.shear_n, [-3.0, 0.0]);
        law.advance(&FacetSlip { slip_m: [0.0, 100.0], ..slip }, &mut memory);
        let shear = memory.shear_n;
        assert!((shear[0].hypot(shear[1]) - 10.0).abs() < 1e-12 && shear[1] < 0.0);
    }
}
