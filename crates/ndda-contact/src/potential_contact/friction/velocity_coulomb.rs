//! Coulomb friction at the level of velocities: no spring, no lag.

use crate::friction::law::{FacetSlip, FrictionLaw, ShearMemory, capped};

/// Coulomb friction that takes the force which stops the slip of this step, or all it may: μ |f_n|.
///
/// ```text
/// f′ = f − m_eff v_t / Δt,   |f′| ≤ μ |f_n|
/// ```
///
/// v_t is the slip velocity that this step would end with if contact did what it did in the last one, m_eff the mass
/// that the face moves within the step (see [`faces`](crate::faces)). A block that slides has its friction from the first step on; one that
/// sticks is held by the force that it was held by before, without any displacement. In the manner of
/// velocity-level contact dynamics (Moreau 1988; Anitescu & Potra 1997).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityCoulomb {
    friction: f64,
}

impl VelocityCoulomb {
    /// Friction angle φ [°], μ = tan φ.
    pub fn new(friction_deg: f64) -> Self {
        Self { friction: friction_deg.to_radians().tan() }
    }
}

impl FrictionLaw for VelocityCoulomb {
    fn name(&self) -> &'static str {
        "Coulomb on velocities"
    }

    fn advance(&self, slip: &FacetSlip, memory: &mut ShearMemory) {
        let trial = [0, 1].map(|i| memory.shear_n[i] + slip.stopping_n[i]);
        memory.shear_n = capped(trial, self.capacity_n(slip, memory)).0;
    }

    /// μ |f_n|.
    fn capacity_n(&self, slip: &FacetSlip, _memory: &ShearMemory) -> f64 {
        self.friction * slip.normal_n
    }

    fn acts_on_faces(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::testing::check_friction;

    #[test]
    fn it_keeps_the_contract_of_a_friction_law() {
        check_friction(&VelocityCoulomb::new(35.0));
        check_friction(&VelocityCoulomb::new(0.0));
    }

    #[test]
    fn a_slip_is_stopped_at_once_and_then_held() {
        let law = VelocityCoulomb::new(45.0);
        let mut memory = ShearMemory::default();
        let slip =
            FacetSlip { normal_n: 10.0, area_m2: 1.0, stopping_n: [-3.0, 0.0], ..FacetSlip::default() };
        law.advance(&slip, &mut memory);
        law.advance(&FacetSlip { stopping_n: [0.0; 2], ..slip }, &mut memory);
        assert_eq!(memory.shear_n, [-3.0, 0.0]);
    }
}
