//! Joints that open while they slip.

use crate::friction::law::{FacetSlip, FrictionLaw, ShearMemory, length};

/// How a joint opens by slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Dilation {
    /// v = tan ψ min(|u_p|, u_zd): by an angle, until a slip.
    Angle {
        /// Dilation angle ψ [°].
        psi_deg: f64,
        /// Slip u_zd at which dilation ends [m].
        to_slip_m: f64,
    },
    /// dv = tan d d|u_p| by the law's own angle d, [`FrictionLaw::dilation_deg`].
    Own,
}

/// A law of friction whose joint opens by the plastic slip u_p, which is what it has slid from where the contact began, beyond the stretch of its spring.
///
/// The opening v depends on how far u_p has come, and not on the way: where slip is reversed the joint closes again, so that dilation does not ratchet
/// under cycles of shear. With a constant normal stress σ the dissipation is σ (tan φ − tan ψ) per slip while the joint opens, and
/// σ (tan φ + tan ψ) while it closes. Friction, φ, is the total angle, dilation included.
///
/// The opening is kept by the law, beside what the law within keeps: [`FrictionLaw::dilation_m`]. Contact moves a facet out by it before it is clipped in the
/// next step, so that blocks are pushed apart, and the work of that comes from friction ([`FrictionLaw::openings_m`]).
pub struct Dilating {
    law: Box<dyn FrictionLaw>,
    dilation: Dilation,
}

/// Numbers that are kept beside those of the law within: plastic slip [m] along both axes, opening at which the facet was clipped last and that at which it will be
/// clipped next [m].
const KEPT: usize = 4;
/// Most numbers that the law within may keep.
const MOST_WITHIN: usize = 8;

impl Dilating {
    /// A law that acts on facets, and how its joint opens.
    ///
    /// # Panics
    /// If the law acts on whole faces, breaks gradually, or keeps more than eight numbers.
    pub fn new(law: Box<dyn FrictionLaw>, dilation: Dilation) -> Self {
        let may = !law.acts_on_faces() && law.fracture().is_none() && law.state_len() <= MOST_WITHIN;
        assert!(may, "{}: cannot dilate", law.name());
        Self { law, dilation }
    }

    /// Opening after a step that took the plastic slip from `before` to `after` [m]: what a joint has opened by remains where its angle changes.
    fn opening_m(&self, opening_m: f64, [before, after]: [[f64; 2]; 2], deg: f64) -> f64 {
        let (deg, to_slip_m) = match self.dilation {
            Dilation::Angle { psi_deg, to_slip_m } => (psi_deg, to_slip_m),
            Dilation::Own => (deg, f64::INFINITY),
        };
        let slip_m = length(after).min(to_slip_m) - length(before).min(to_slip_m);
        (opening_m + deg.to_radians().tan() * slip_m).max(0.0)
    }
}

impl FrictionLaw for Dilating {
    fn name(&self) -> &'static str {
        self.law.name()
    }

    fn state_len(&self) -> usize {
        self.law.state_len() + KEPT
    }

    fn state_parts(&self) -> Vec<(&'static str, usize)> {
        let mut parts = self.law.state_parts();
        parts.push(("slip and opening of a joint that dilates", KEPT));
        parts
    }

    fn begin(&self, state: &mut [f64]) {
        let (within, own) = state.split_at_mut(self.law.state_len());
        self.law.begin(within);
        own.fill(0.0);
    }

    fn has_constant_strength(&self) -> bool {
        self.law.has_constant_strength()
    }

    fn advance(&self, slip: &FacetSlip, memory: &mut ShearMemory) {
        let (within, own) = memory.state.split_at_mut(self.law.state_len());
        let before_n = memory.shear_n;
        let mut inner = ShearMemory { shear_n: before_n, broken: memory.broken, state: within };
        self.law.advance(slip, &mut inner);
        let spring_n_m = 0.5 * self.law.shear_stiffness_pa_m() * slip.mean_area_m2;
        let elastic = |i: usize| {
            if spring_n_m > 0.0 { (before_n[i] - inner.shear_n[i]) / spring_n_m } else { 0.0 }
        };
        let from = [own[0], own[1]];
        let to = [0, 1].map(|i| from[i] + slip.slip_m[i] - elastic(i));
        let deg = self.law.dilation_deg(slip, &inner);
        own[2] = own[3];
        own[3] = self.opening_m(own[2], [from, to], deg);
        own[..2].copy_from_slice(&to);
        (memory.shear_n, memory.broken) = (inner.shear_n, inner.broken);
    }

    fn capacity_n(&self, slip: &FacetSlip, memory: &ShearMemory) -> f64 {
        let (mut room, len) = ([0.0; MOST_WITHIN], self.law.state_len());
        let within = &mut room[..len];
        within.copy_from_slice(&memory.state[..len]);
        let inner = ShearMemory { shear_n: memory.shear_n, broken: memory.broken, state: within };
        self.law.capacity_n(slip, &inner)
    }

    fn shear_stiffness_pa_m(&self) -> f64 {
        self.law.shear_stiffness_pa_m()
    }

    fn holds_together(&self) -> bool {
        self.law.holds_together()
    }

    fn survives_slip(&self) -> bool {
        self.law.survives_slip()
    }

    fn tension_pa(&self) -> f64 {
        self.law.tension_pa()
    }

    fn bond_stiffness_pa_m(&self) -> f64 {
        self.law.bond_stiffness_pa_m()
    }

    fn dilation_m(&self, memory: &ShearMemory) -> f64 {
        self.openings_m(memory.state)[1]
    }

    fn dilates(&self) -> bool {
        true
    }

    fn openings_m(&self, state: &[f64]) -> [f64; 2] {
        let first = self.law.state_len() + KEPT - 2;
        [state[first], state[first + 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::barton_bandis::{BartonBandis, Roughness};
    use crate::friction::coulomb::Coulomb;
    use crate::friction::testing::check_friction;

    const SPRING_PA_M: f64 = 1e10;

    fn dilating(to_slip_m: f64) -> Dilating {
        let dilation = Dilation::Angle { psi_deg: 10.0, to_slip_m };
        Dilating::new(Box::new(Coulomb::new(30.0, SPRING_PA_M)), dilation)
    }

    fn pressed(slip_m: [f64; 2]) -> FacetSlip {
        FacetSlip { normal_n: 0.5e6, area_m2: 1.0, mean_area_m2: 1.0, slip_m, ..FacetSlip::default() }
    }

    #[test]
    fn it_keeps_the_contract_of_a_friction_law() {
        check_friction(&dilating(1e-3));
        let rough = Roughness { jrc: 10.0, jcs_pa: 100e6, residual_deg: 30.0, length_m: 0.1 };
        check_friction(&Dilating::new(Box::new(BartonBandis::new(rough, 2e10).mobilised()), Dilation::Own));
    }

    #[test]
    fn a_joint_opens_by_plastic_slip_until_dilation_ends() {
        let elastic_m = 1e6 * 30f64.to_radians().tan() / SPRING_PA_M;
        for (to_slip_m, expected_mm) in [(1.0, 0.881_635), (3e-3, 0.528_981)] {
            let law = dilating(to_slip_m);
            let mut state = [0.0; KEPT];
            let mut memory = ShearMemory { state: &mut state, ..ShearMemory::default() };
            law.advance(&pressed([5e-3 + elastic_m, 0.0]), &mut memory);
            let found_mm = 1e3 * law.dilation_m(&memory);
            let slip_m = to_slip_m.min(5e-3);
            assert!((found_mm / (1e3 * slip_m * 10f64.to_radians().tan()) - 1.0).abs() < 1e-12);
            assert!((found_mm - expected_mm).abs() < 5e-7, "{found_mm} for {expected_mm}");
        }
    }

    #[test]
    fn cycles_do_not_ratchet_and_a_joint_that_comes_back_closes() {
        let law = dilating(1.0);
        let mut state = [0.0; KEPT];
        let mut memory = ShearMemory { state: &mut state, ..ShearMemory::default() };
        let mut most_m = 0.0f64;
        for k in 0..4000u32 {
            // Squares of 4 mm, forth and back.
            let way = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]][(k / 100 % 4) as usize];
            law.advance(&pressed(way.map(|w| 4e-5 * w)), &mut memory);
            most_m = most_m.max(law.dilation_m(&memory));
        }
        let tan = 10f64.to_radians().tan();
        assert!(most_m < 2f64.sqrt() * 4e-3 * tan, "{most_m}");
        // Back at the start but for the stretch of the spring.
        assert!(law.dilation_m(&memory) < 2e-4 * tan, "{}", law.dilation_m(&memory));
    }
}
