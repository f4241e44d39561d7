//! Friction of joints that hold together until they break.

use crate::friction::law::{FacetSlip, FrictionLaw, ShearMemory, capped};

/// Mohr–Coulomb with a tension cut-off: shear up to τ = max(0, c + σ tan φ), σ being the normal stress, compression
/// positive, and tension up to σ_t, until either is exceeded; then friction alone, for good. Only contacts that exist
/// at the start of a run hold together.
///
/// Shear is a spring as in [`Coulomb`](crate::Coulomb).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MohrCoulomb {
    friction: f64,
    shear_penalty_pa_m: f64,
    cohesion_pa: f64,
    tension_pa: f64,
}

impl MohrCoulomb {
    /// Friction angle φ [°], shear penalty k_s [Pa/m], cohesion c [Pa] and tensile strength σ_t [Pa].
    pub fn new(friction_deg: f64, shear_penalty_pa_m: f64, cohesion_pa: f64, tension_pa: f64) -> Self {
        Self { friction: friction_deg.to_radians().tan(), shear_penalty_pa_m, cohesion_pa, tension_pa }
    }
}

impl FrictionLaw for MohrCoulomb {
    fn name(&self) -> &'static str {
        "Mohr–Coulomb with a shear spring"
    }

    fn advance(&self, slip: &FacetSlip, memory: &mut ShearMemory) {
        let spring = 0.5 * self.shear_penalty_pa_m * slip.mean_area_m2;
        let trial = [0, 1].map(|i| memory.shear_n[i] - spring * slip.slip_m[i]);
        let (shear_n, slides) = capped(trial, self.capacity_n(slip, memory));
        memory.shear_n = shear_n;
        if slides && !memory.broken {
            memory.broken = true;
            memory.shear_n = capped(trial, self.capacity_n(slip, memory)).0;
        }
    }

    /// max(0, ½ c S + μ f_n) (the other half of c is the other side's), without c once broken.
    fn capacity_n(&self, slip: &FacetSlip, memory: &ShearMemory) -> f64 {
        let cohesion = if memory.broken { 0.0 } else { 0.5 * self.cohesion_pa * slip.area_m2 };
        (cohesion + self.friction * slip.normal_n).max(0.0)
    }

    fn shear_stiffness_pa_m(&self) -> f64 {
        self.shear_penalty_pa_m
    }

    fn holds_together(&self) -> bool {
        self.cohesion_pa > 0.0 || self.tension_pa > 0.0
    }

    fn tension_pa(&self) -> f64 {
        self.tension_pa
    }

    /// As stiff in tension as in shear.
    fn bond_stiffness_pa_m(&self) -> f64 {
        self.shear_penalty_pa_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::testing::check_friction;

    #[test]
    fn it_keeps_the_contract_of_a_friction_law() {
        check_friction(&MohrCoulomb::new(35.0, 2e10, 0.0, 0.0));
    }

    #[test]
    fn cohesion_holds_until_it_breaks_and_never_again() {
        let law = MohrCoulomb::new(45.0, 2.0, 20.0, 0.0);
        let mut memory = ShearMemory { broken: false, ..ShearMemory::default() };
        let slip = FacetSlip {
            normal_n: 1.0,
            area_m2: 1.0,
            mean_area_m2: 1.0,
            slip_m: [10.5, 0.0],
            ..FacetSlip::default()
        };
        law.advance(&slip, &mut memory);
        assert_eq!((memory.shear_n, memory.broken), ([-10.5, 0.0], false));
        law.advance(&FacetSlip { slip_m: [1.0, 0.0], ..slip }, &mut memory);
        assert!(memory.broken && (memory.shear_n[0] + 1.0).abs() < 1e-15, "{memory:?}");
        law.advance(&FacetSlip { slip_m: [-1.0, 0.0], ..slip }, &mut memory);
        law.advance(&FacetSlip { slip_m: [10.5, 0.0], ..slip }, &mut memory);
        assert!((memory.shear_n[0] + 1.0).abs() < 1e-15, "{memory:?}");
    }
}
