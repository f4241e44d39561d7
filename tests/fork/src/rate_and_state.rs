//! Rate-and-state friction (Dieterich 1979; Ruina 1983), with ageing.

use ndda_contact::{FacetSlip, FrictionLaw, ShearMemory};

/// μ = a asinh(V/2V₀ exp((μ₀ + b ln(V₀ θ/D))/a)), dθ/dt = 1 − V θ/D, regularised at rest (Rice, Lapusta & Ranjith 2001).
///
/// V is the rate at which the joint slips beyond its spring; each step is solved for the V at its end.
#[derive(Clone, Copy, Debug)]
pub struct RateAndState {
    /// k_s [Pa/m].
    pub shear_penalty_pa_m: f64,
    /// μ₀.
    pub friction: f64,
    /// a.
    pub direct: f64,
    /// b.
    pub evolution: f64,
    /// D [m].
    pub slip_m: f64,
    /// V₀ [m/s].
    pub velocity_m_s: f64,
}

/// Halvings in the search for V: from 1e6 V₀ to rounding.
const HALVINGS: u32 = 200;

impl RateAndState {
    fn friction(&self, slip_m_s: f64, age_s: f64) -> f64 {
        let Self { friction, direct, evolution, slip_m, velocity_m_s, .. } = *self;
        let aged = (friction + evolution * (velocity_m_s * age_s / slip_m).ln()) / direct;
        direct * (0.5 * slip_m_s / velocity_m_s * aged.exp()).asinh()
    }

    /// θ after a step at a constant V: D/V + (θ − D/V) e^(−V Δt/D).
    fn age_s(&self, from_s: f64, slip_m_s: f64, dt_s: f64) -> f64 {
        let turned_over = slip_m_s * dt_s / self.slip_m;
        if turned_over < 1e-9 {
            return from_s + dt_s - turned_over * from_s;
        }
        let steady_s = self.slip_m / slip_m_s;
        steady_s + (from_s - steady_s) * (-turned_over).exp()
    }
}

impl FrictionLaw for RateAndState {
    fn name(&self) -> &'static str {
        "rate and state"
    }

    /// θ [s] and V [m/s].
    fn state_len(&self) -> usize {
        2
    }

    /// A contact begins as it is when it has slipped at V₀ for long.
    fn begin(&self, state: &mut [f64]) {
        state.copy_from_slice(&[self.slip_m / self.velocity_m_s, self.velocity_m_s]);
    }

    fn advance(&self, slip: &FacetSlip, memory: &mut ShearMemory) {
        let spring_n_m = 0.5 * self.shear_penalty_pa_m * slip.mean_area_m2;
        let trial = [0, 1].map(|i| memory.shear_n[i] - spring_n_m * slip.slip_m[i]);
        let (size, from_s) = (trial[0].hypot(trial[1]), memory.state[0]);
        // |f| − k Δt V falls and σ μ(V) rises with V.
        let left_n = |v: f64| {
            let age_s = self.age_s(from_s, v, slip.dt_s);
            size - spring_n_m * slip.dt_s * v - slip.normal_n * self.friction(v, age_s)
        };
        let fastest = size / (spring_n_m * slip.dt_s);
        let (mut low, mut slip_m_s) = (0.0, if fastest.is_finite() { fastest } else { 0.0 });
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + slip_m_s);
            if left_n(middle) > 0.0 { low = middle } else { slip_m_s = middle }
        }
        memory.state.copy_from_slice(&[self.age_s(from_s, slip_m_s, slip.dt_s), slip_m_s]);
        let most = self.capacity_n(slip, memory);
        let scale = if size > most { most / size } else { 1.0 };
        memory.shear_n = trial.map(|f| f * scale);
    }

    fn capacity_n(&self, slip: &FacetSlip, memory: &ShearMemory) -> f64 {
        slip.normal_n * self.friction(memory.state[1], memory.state[0])
    }

    fn shear_stiffness_pa_m(&self) -> f64 {
        self.shear_penalty_pa_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_contact::friction::testing::check_friction;

    const LAW: RateAndState = RateAndState {
        shear_penalty_pa_m: 2e10,
        friction: 0.6,
        direct: 0.01,
        evolution: 0.015,
        slip_m: 1e-4,
        velocity_m_s: 1e-6,
    };

    #[test]
    fn it_keeps_the_contract_of_a_friction_law() {
        check_friction(&LAW);
    }

    /// Steady sliding has μ = μ₀ + (a − b) ln(V/V₀).
    #[test]
    fn steady_friction_is_that_of_the_rate() {
        for v in [1e-6f64, 1e-5, 1e-3] {
            let mut state = [0.0; 2];
            LAW.begin(&mut state);
            let mut memory = ShearMemory { state: &mut state, ..ShearMemory::default() };
            let dt_s = 1e-6 / v;
            let slip = FacetSlip { normal_n: 1.0, mean_area_m2: 1.0, dt_s, ..FacetSlip::default() };
            let slip = FacetSlip { slip_m: [v * dt_s, 0.0], ..slip };
            (0..20_000).for_each(|_| LAW.advance(&slip, &mut memory));
            let expected = 0.6 - 0.005 * (v / 1e-6).ln();
            assert!((memory.shear_n[0] + expected).abs() < 1e-6, "{} at {v} m/s", memory.shear_n[0]);
        }
    }

    /// The spring is put in twice.
    #[test]
    #[should_panic(expected = "stiffer than it says")]
    fn a_law_that_is_stiffer_than_it_says_is_found_out() {
        struct Stiffer;
        impl FrictionLaw for Stiffer {
            fn name(&self) -> &'static str {
                "stiffer"
            }

            fn state_len(&self) -> usize {
                2
            }

            fn begin(&self, state: &mut [f64]) {
                LAW.begin(state);
            }

            fn advance(&self, slip: &FacetSlip, memory: &mut ShearMemory) {
                LAW.advance(&FacetSlip { mean_area_m2: 2.0 * slip.mean_area_m2, ..*slip }, memory);
            }

            fn capacity_n(&self, slip: &FacetSlip, memory: &ShearMemory) -> f64 {
                LAW.capacity_n(slip, memory)
            }

            fn shear_stiffness_pa_m(&self) -> f64 {
                LAW.shear_penalty_pa_m
            }
        }
        check_friction(&Stiffer);
    }
}
