//! Friction and cohesion that fall from a peak to a residual value while a joint slips.

use crate::friction::law::{FacetSlip, FrictionLaw, ShearMemory, capped, length};

/// Coulomb friction with cohesion and a shear spring, both falling linearly over slip:
///
/// ```text
/// τ(p) = c(p) + σ tan φ(p)        c(p) = c + (c_r − c) min(p/u_c, 1), tan φ(p) likewise
/// ```
///
/// p is the plastic slip, what the joint has slid beyond the stretch of its spring. Where residual and peak are the same the joint is
/// perfectly plastic. What touches when contact is first evaluated has its peak strength, and keeps it until it slips or opens; what comes
/// into contact later has the residual one. Tensile strength falls likewise, and is gone for good where a joint opens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SofteningCoulomb {
    shear_penalty_pa_m: f64,
    peak: Strength,
    residual: Strength,
    over_m: f64,
    /// Tensile strength at the peak, and when it is residual [Pa].
    tension_pa: [f64; 2],
    /// How far it opens at that strength before it is broken [m].
    opens_m: f64,
}

/// Friction μ = tan φ and cohesion c [Pa].
#[derive(Clone, Copy, Debug, PartialEq)]
struct Strength {
    friction: f64,
    cohesion_pa: f64,
}

impl Strength {
    /// ½ c S + μ f_n; the other half of c is the other side's.
    fn capacity_n(&self, slip: &FacetSlip) -> f64 {
        (0.5 * self.cohesion_pa * slip.area_m2 + self.friction * slip.normal_n).max(0.0)
    }
}

impl SofteningCoulomb {
    /// Shear penalty k_s [Pa/m], friction angle φ [°] and cohesion c [Pa] at the peak and when they are residual, and the plastic slip u_c in
    /// between [m].
    pub fn new(shear_penalty_pa_m: f64, peak: (f64, f64), residual: (f64, f64), over_m: f64) -> Self {
        let strength = |(friction_deg, cohesion_pa): (f64, f64)| Strength {
            friction: friction_deg.to_radians().tan(),
            cohesion_pa,
        };
        Self {
            shear_penalty_pa_m,
            peak: strength(peak),
            residual: strength(residual),
            over_m,
            tension_pa: [0.0; 2],
            opens_m: 0.0,
        }
    }

    /// With a tensile strength at the peak, and what is left of it when the joint has slipped [Pa].
    #[must_use]
    pub fn with_tension(self, peak_pa: f64, residual_pa: f64) -> Self {
        Self { tension_pa: [peak_pa, residual_pa], ..self }
    }

    /// Keeps tensile strength and cohesion until it has opened by so much [m].
    #[must_use]
    pub fn that_opens(self, opens_m: f64) -> Self {
        Self { opens_m, ..self }
    }

    /// How far strength has fallen: 0 at the peak, 1 where it is residual.
    fn softened(&self, memory: &ShearMemory) -> f64 {
        if memory.broken { 1.0 } else { self.softened_by(memory.state[0]) }
    }

    /// How far strength has fallen after a plastic slip [m]; before any slip it is at its peak, also where it falls at once (u_c = 0).
    fn softened_by(&self, slip_m: f64) -> f64 {
        if slip_m <= 0.0 {
            0.0
        } else if slip_m >= self.over_m {
            1.0
        } else {
            slip_m / self.over_m
        }
    }

    /// c/tan φ where strength has fallen so far: beyond that tension no shear is left [Pa].
    fn apex_pa(&self, softened: f64) -> f64 {
        let between =
            |of: fn(&Strength) -> f64| of(&self.peak) + softened * (of(&self.residual) - of(&self.peak));
        let friction = between(|strength| strength.friction);
        if friction > 0.0 { between(|strength| strength.cohesion_pa) / friction } else { f64::INFINITY }
    }

    /// Plastic slip in a step whose spring would bear `trial_n`: |f| − k Δp = τ(p + Δp) S, where k = ½ k_s S̄.
    fn plastic_slip_m(&self, trial_n: f64, slip: &FacetSlip, memory: &ShearMemory, spring_n_m: f64) -> f64 {
        let residual_n = self.residual.capacity_n(slip);
        let to_residual_m = (trial_n - residual_n) / spring_n_m;
        let left_m = self.over_m * (1.0 - self.softened(memory));
        // Residual already, or falls at once.
        if left_m <= 0.0 || to_residual_m >= left_m {
            return to_residual_m;
        }
        let fall_n_m = (self.peak.capacity_n(slip) - residual_n) / self.over_m;
        // A spring that unloads more slowly than the joint softens snaps to the residual strength.
        if spring_n_m <= fall_n_m {
            return to_residual_m.max(left_m);
        }
        (trial_n - self.capacity_n(slip, memory)) / (spring_n_m - fall_n_m)
    }
}

impl FrictionLaw for SofteningCoulomb {
    fn name(&self) -> &'static str {
        "Coulomb with a shear spring that softens"
    }

    /// Plastic slip [m].
    fn state_len(&self) -> usize {
        1
    }

    fn advance(&self, slip: &FacetSlip, memory: &mut ShearMemory) {
        let spring_n_m = 0.5 * self.shear_penalty_pa_m * slip.mean_area_m2;
        let trial = [0, 1].map(|i| memory.shear_n[i] - spring_n_m * slip.slip_m[i]);
        if length(trial) > self.capacity_n(slip, memory) && spring_n_m > 0.0 {
            memory.state[0] += self.plastic_slip_m(length(trial), slip, memory, spring_n_m);
        }
        memory.shear_n = capped(trial, self.capacity_n(slip, memory)).0;
    }

    fn capacity_n(&self, slip: &FacetSlip, memory: &ShearMemory) -> f64 {
        let (peak_n, residual_n) = (self.peak.capacity_n(slip), self.residual.capacity_n(slip));
        peak_n + self.softened(memory) * (residual_n - peak_n)
    }

    fn shear_stiffness_pa_m(&self) -> f64 {
        self.shear_penalty_pa_m
    }

    fn holds_together(&self) -> bool {
        true
    }

    fn survives_slip(&self) -> bool {
        true
    }

    fn tension_pa(&self) -> f64 {
        self.tension_pa[0]
    }

    fn tension_after_slip_pa(&self, slip_m: f64) -> Option<f64> {
        let [peak_pa, residual_pa] = self.tension_pa;
        let softened = self.softened_by(slip_m);
        let strength_pa = peak_pa + softened * (residual_pa - peak_pa);
        (peak_pa > 0.0)
            .then(|| if self.opens_m > 0.0 { strength_pa.min(self.apex_pa(softened)) } else { strength_pa })
    }

    fn opens_m(&self) -> f64 {
        self.opens_m
    }

    /// As stiff in tension as in shear, so that what opens is broken.
    fn bond_stiffness_pa_m(&self) -> f64 {
        self.shear_penalty_pa_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::testing::check_friction;

    fn intact(state: &mut [f64]) -> ShearMemory<'_> {
        state.fill(0.0);
        ShearMemory { shear_n: [0.0; 2], broken: false, state }
    }

    fn pressed(slip_m: f64) -> FacetSlip {
        FacetSlip {
            normal_n: 1e6,
            area_m2: 1.0,
            mean_area_m2: 1.0,
            slip_m: [slip_m, 0.0],
            ..FacetSlip::default()
        }
    }

    #[test]
    fn it_keeps_the_contract_of_a_friction_law() {
        check_friction(&SofteningCoulomb::new(2e10, (35.0, 0.0), (20.0, 0.0), 1e-3));
    }

    #[test]
    fn a_joint_whose_strength_falls_at_once_bears_its_peak_until_it_slips() {
        let law = SofteningCoulomb::new(1e9, (35.0, 1e5), (20.0, 0.0), 0.0);
        let (peak_n, residual_n) = (0.5e5 + 1e6 * 35f64.to_radians().tan(), 1e6 * 20f64.to_radians().tan());
        let mut state = [0.0];
        let mut memory = intact(&mut state);
        let spring_n_m = 0.5 * 1e9;
        // To nine tenths of its strength, then beyond it.
        law.advance(&pressed(0.9 * peak_n / spring_n_m), &mut memory);
        assert!((memory.shear_n[0] / (-0.9 * peak_n) - 1.0).abs() < 1e-12, "{memory:?}");
        assert_eq!(memory.state[0], 0.0);
        law.advance(&pressed(0.2 * peak_n / spring_n_m), &mut memory);
        assert!((memory.shear_n[0] / -residual_n - 1.0).abs() < 1e-12, "{memory:?}");
        let slipped_m = (1.1 * peak_n - residual_n) / spring_n_m;
        assert!((memory.state[0] / slipped_m - 1.0).abs() < 1e-12, "{memory:?}");
    }

    #[test]
    fn tension_falls_from_peak_to_residual_over_slip() {
        let law = SofteningCoulomb::new(2e10, (35.0, 2e4), (30.0, 1e4), 4e-3);
        assert_eq!(law.tension_after_slip_pa(0.0), None);
        let law = law.with_tension(3e4, 1e4);
        assert_eq!(
            [0.0, 2e-3, 4e-3, 1.0].map(|p| law.tension_after_slip_pa(p).unwrap()),
            [3e4, 2e4, 1e4, 1e4]
        );
        let at_once = SofteningCoulomb::new(2e10, (35.0, 2e4), (35.0, 2e4), 0.0).with_tension(3e4, 0.0);
        assert_eq!([0.0, 1e-9].map(|p| at_once.tension_after_slip_pa(p).unwrap()), [3e4, 0.0]);
    }

    /// Work above that of residual friction: ½ σ (tan φ − tan φ_r) u_c, here 931.98 J/m² for 40° → 25° over 5 mm at 1 MPa.
    #[test]
    fn softening_takes_half_the_fall_times_the_slip() {
        let law = SofteningCoulomb::new(2e12, (40.0, 0.0), (25.0, 0.0), 5e-3);
        let (mut state, mut work_j, step_m) = ([0.0], 0.0, 1e-7);
        let mut memory = intact(&mut state);
        for _ in 0..100_000 {
            law.advance(&pressed(step_m), &mut memory);
            work_j -= memory.shear_n[0] * step_m;
        }
        let residual_j = 1e6 * 25f64.to_radians().tan() * 1e5 * step_m;
        let expected_j = 0.5e6 * (40f64.to_radians().tan() - 25f64.to_radians().tan()) * 5e-3;
        assert!((expected_j - 931.98).abs() < 0.01);
        // The spring stretches by 0.8 µm before.
        assert!(((work_j - residual_j) / expected_j - 1.0).abs() < 2e-3, "{}", work_j - residual_j);
        assert!((memory.state[0] - 1e5 * step_m).abs() < 1e-6);
    }

    /// For any step, strength is that of the plastic slip.
    #[test]
    fn one_long_step_ends_where_many_short_ones_do() {
        let law = SofteningCoulomb::new(1e10, (40.0, 2e5), (25.0, 0.0), 5e-3);
        let ends = [1, 10, 1000].map(|steps| {
            let mut state = [0.0];
            let mut memory = intact(&mut state);
            for _ in 0..steps {
                law.advance(&pressed(2e-3 / f64::from(steps)), &mut memory);
            }
            [memory.shear_n[0], memory.state[0]]
        });
        for end in ends {
            assert!((end[0] / ends[2][0] - 1.0).abs() < 1e-12, "{ends:?}");
            assert!((end[1] / ends[2][1] - 1.0).abs() < 1e-12, "{ends:?}");
        }
    }

    #[test]
    fn a_spring_softer_than_the_joint_snaps_and_a_broken_contact_is_residual() {
        let law = SofteningCoulomb::new(1e6, (40.0, 0.0), (25.0, 0.0), 1e-6);
        let mut state = [0.0];
        let mut memory = intact(&mut state);
        law.advance(&pressed(2.0), &mut memory);
        let residual_n = 1e6 * 25f64.to_radians().tan();
        assert!((memory.shear_n[0] + residual_n).abs() < 1e-6, "{memory:?}");
        let stiff = SofteningCoulomb::new(1e12, (40.0, 1e5), (25.0, 0.0), 1.0);
        let mut memory = ShearMemory { broken: true, ..intact(&mut state) };
        stiff.advance(&pressed(1e-3), &mut memory);
        assert!((memory.shear_n[0] + residual_n).abs() < 1e-6, "{memory:?}");
    }
}
