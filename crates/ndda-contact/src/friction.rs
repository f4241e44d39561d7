//! Friction laws.

/// A law for the shear force of one contactor facet on one target body.
///
/// Contract (checked by [`check_friction`](crate::testing::check_friction)): the force never exceeds what the
/// normal force carries, opposes the slip, and is zero without a normal force.
pub trait FrictionLaw: Send + Sync {
    /// Advances the shear force \[N\] on the contactor over a slip \[m\]; both are in the facet's own basis.
    fn advance(&self, normal_n: f64, area_m2: f64, slip_m: &[f64; 2], shear_n: &mut [f64; 2]);
}

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
    /// f′ = f − ½ k_s Δu S, capped at μ |f_n| along its own direction.
    fn advance(&self, normal_n: f64, area_m2: f64, slip_m: &[f64; 2], shear_n: &mut [f64; 2]) {
        let spring = 0.5 * self.shear_penalty_pa_m * area_m2;
        let trial = [shear_n[0] - spring * slip_m[0], shear_n[1] - spring * slip_m[1]];
        let (size, most) = (trial[0].hypot(trial[1]), self.friction * normal_n);
        let scale = if size > most { most / size } else { 1.0 };
        *shear_n = [trial[0] * scale, trial[1] * scale];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::check_friction;

    #[test]
    fn it_keeps_the_contract_of_a_friction_law() {
        check_friction(&Coulomb::new(35.0, 2e10));
        check_friction(&Coulomb::new(0.0, 1e3));
    }

    #[test]
    fn below_the_cap_it_is_a_spring_and_above_it_slides() {
        let law = Coulomb::new(45.0, 2.0);
        let mut shear = [0.0, 0.0];
        law.advance(10.0, 3.0, &[1.0, 0.0], &mut shear);
        assert_eq!(shear, [-3.0, 0.0]);
        law.advance(10.0, 3.0, &[0.0, 100.0], &mut shear);
        assert!((shear[0].hypot(shear[1]) - 10.0).abs() < 1e-12 && shear[1] < 0.0);
    }
}
