//! Friction that weakens with slip and heals at rest.

use ndda_contact::{FacetSlip, FrictionLaw, ShearMemory};

/// τ = σ [μ_d + (μ_s − μ_d) (1 − p/D)] while p < D, then σ μ_d. The slip p since the joint was whole grows while it slides and decays as
/// e^(−t/T) while it is held.
#[derive(Clone, Copy, Debug)]
pub struct SlipWeakening {
    /// k_s [Pa/m].
    pub shear_penalty_pa_m: f64,
    /// μ_s.
    pub static_friction: f64,
    /// μ_d, not above μ_s.
    pub dynamic_friction: f64,
    /// D [m].
    pub weakening_m: f64,
    /// T [s].
    pub healing_s: f64,
}

impl SlipWeakening {
    fn friction(&self, slip_m: f64) -> f64 {
        let left = (1.0 - slip_m / self.weakening_m).max(0.0);
        self.dynamic_friction + (self.static_friction - self.dynamic_friction) * left
    }

    /// Slip in a step that ends at |f| − k p = σ μ(p₀ + p) S, for a spring that would bear `trial_n`.
    fn slip_m(&self, trial_n: f64, normal_n: f64, from_m: f64, spring_n_m: f64) -> f64 {
        let left_m = (self.weakening_m - from_m).max(0.0);
        let at_dynamic = (trial_n - self.dynamic_friction * normal_n) / spring_n_m;
        let fall_n_m = normal_n * (self.static_friction - self.dynamic_friction) / self.weakening_m;
        if at_dynamic >= left_m || spring_n_m <= fall_n_m {
            return at_dynamic;
        }
        (trial_n - self.friction(from_m) * normal_n) / (spring_n_m - fall_n_m)
    }
}

impl FrictionLaw for SlipWeakening {
    fn name(&self) -> &'static str {
        "slip weakening with healing"
    }

    /// p [m].
    fn state_len(&self) -> usize {
        1
    }

    fn advance(&self, slip: &FacetSlip, memory: &mut ShearMemory) {
        let spring_n_m = 0.5 * self.shear_penalty_pa_m * slip.mean_area_m2;
        let trial = [0, 1].map(|i| memory.shear_n[i] - spring_n_m * slip.slip_m[i]);
        let size = trial[0].hypot(trial[1]);
        if size > self.capacity_n(slip, memory) {
            memory.state[0] += self.slip_m(size, slip.normal_n, memory.state[0], spring_n_m);
            let scale = self.capacity_n(slip, memory) / size;
            memory.shear_n = trial.map(|f| f * scale);
        } else {
            memory.shear_n = trial;
            memory.state[0] *= (-slip.dt_s / self.healing_s).exp();
        }
    }

    fn capacity_n(&self, slip: &FacetSlip, memory: &ShearMemory) -> f64 {
        self.friction(memory.state[0]) * slip.normal_n
    }

    fn shear_stiffness_pa_m(&self) -> f64 {
        self.shear_penalty_pa_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_contact::friction::testing::check_friction;

    const LAW: SlipWeakening = SlipWeakening {
        shear_penalty_pa_m: 2e10,
        static_friction: 0.75,
        dynamic_friction: 0.6,
        weakening_m: 5e-3,
        healing_s: 1.0,
    };

    #[test]
    fn it_keeps_the_contract_of_a_friction_law() {
        check_friction(&LAW);
    }

    /// Weakening takes ½ σ (μ_s − μ_d) D beyond dynamic friction, and a held joint is whole again after a while.
    #[test]
    fn it_weakens_by_the_slip_and_heals_by_time() {
        let mut state = [0.0];
        let mut memory = ShearMemory { state: &mut state, ..ShearMemory::default() };
        let slip = |slip_m: f64, dt_s: f64| FacetSlip {
            normal_n: 1e6,
            area_m2: 1.0,
            mean_area_m2: 1.0,
            dt_s,
            slip_m: [slip_m, 0.0],
            ..FacetSlip::default()
        };
        let mut work_j = 0.0;
        for _ in 0..10_000 {
            LAW.advance(&slip(1e-6, 1e-6), &mut memory);
            work_j -= 1e-6 * memory.shear_n[0];
        }
        let expected_j = 1e6 * (0.6 * 0.01 + 0.5 * 0.15 * 5e-3);
        // The spring holds back 60 µm of the slip.
        assert!((work_j / expected_j - 1.0).abs() < 1e-2, "{work_j} J instead of {expected_j}");
        LAW.advance(&slip(-1e-9, 20.0), &mut memory);
        assert!(memory.state[0] < 1e-9 && LAW.capacity_n(&slip(0.0, 1.0), &memory) > 0.7499e6);
    }

    /// The spring is stretched by the slip in the wrong direction.
    #[test]
    #[should_panic(expected = "friction pushes along the slip")]
    fn a_law_that_pushes_along_the_slip_is_found_out() {
        struct Backwards;
        impl FrictionLaw for Backwards {
            fn name(&self) -> &'static str {
                "backwards"
            }

            fn state_len(&self) -> usize {
                1
            }

            fn advance(&self, slip: &FacetSlip, memory: &mut ShearMemory) {
                LAW.advance(&FacetSlip { slip_m: slip.slip_m.map(|s| -s), ..*slip }, memory);
            }

            fn capacity_n(&self, slip: &FacetSlip, memory: &ShearMemory) -> f64 {
                LAW.capacity_n(slip, memory)
            }
        }
        check_friction(&Backwards);
    }
}
