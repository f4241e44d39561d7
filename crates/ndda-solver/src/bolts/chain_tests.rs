//! The static solve against closed forms of chains and bars.

use super::*;

/// A grouted bar of equal segments with its head held by the last argument.
struct Bar {
    steel: Vec<Law>,
    holders: Vec<Holder>,
    rest_m: Vec<f64>,
    yielded_m: Vec<f64>,
    broken: Vec<bool>,
    slip_m: Vec<f64>,
    rock_m: Vec<f64>,
    u: Vec<f64>,
}

const EA_N: f64 = 98.6e9 * 181e-6;
const BOND_N_M2: f64 = 112e6;
const STRENGTH_N_M: f64 = 0.175e6;
const YIELD_N: f64 = 0.5e6;

impl Bar {
    fn new(length_m: f64, segments: usize, yield_n: f64) -> Self {
        let h = length_m / segments as f64;
        let part = |i: usize| if i == 0 || i == segments { 0.5 * h } else { h };
        let grout = |i: usize| Law::symmetric(BOND_N_M2 * part(i), STRENGTH_N_M * part(i));
        let mut holders: Vec<Holder> =
            (0..=segments).map(|i| Holder { node: i as u32, law: grout(i) }).collect();
        // A driver far stiffer than the bar.
        holders.push(Holder { node: 0, law: Law::symmetric(1e6 * EA_N, f64::INFINITY) });
        let count = holders.len();
        Self {
            steel: vec![Law::symmetric(EA_N / h, yield_n); segments],
            holders,
            rest_m: vec![0.0; segments],
            yielded_m: vec![0.0; segments],
            broken: vec![false; segments],
            slip_m: vec![0.0; count],
            rock_m: vec![0.0; count],
            u: vec![0.0; segments + 1],
        }
    }

    /// Pulls the head to −u, yields, and returns the pull.
    fn pull(&mut self, to_m: f64) -> f64 {
        let mut workspace = Workspace::new(self.u.len());
        let head = self.holders.len() - 1;
        self.rock_m[head] = -to_m;
        let mut u = std::mem::take(&mut self.u);
        let chain = Chain {
            steel: &self.steel,
            rest_m: &self.rest_m,
            yielded_m: &self.yielded_m,
            broken: &self.broken,
            holders: &self.holders,
            slip_m: &self.slip_m,
            rock_m: &self.rock_m,
        };
        assert!(chain.solve(&mut u, &mut workspace) < 60);
        let pull_n = chain.hold_n(head, &u);
        let slips: Vec<f64> =
            (0..=head).map(|k| self.holders[k].law.yielding(chain.offset_m(k, &u)).0).collect();
        let yields: Vec<f64> =
            (0..self.steel.len()).map(|i| self.steel[i].yielding(chain.stretch_m(i, &u)).0).collect();
        self.slip_m.iter_mut().zip(slips).for_each(|(s, more)| *s += more);
        self.yielded_m.iter_mut().zip(yields).for_each(|(s, more)| *s += more);
        self.u = u;
        pull_n
    }
}

fn lambda() -> f64 {
    (BOND_N_M2 / EA_N).sqrt()
}

#[test]
fn pulling_a_chain_out_takes_what_its_difference_equation_says() {
    assert!((lambda() - 2.505136).abs() < 1e-6);
    for (length_m, segments) in [(0.5, 5), (0.5, 40), (2.0, 20), (2.0, 160)] {
        let x = lambda() * length_m / segments as f64;
        // 2 sinh(μ/2) = λh: P/u = ½ k_b h coth(μ/2) tanh(n μ).
        let half = (0.5 * x).asinh();
        let chain_n_m =
            0.5 * BOND_N_M2 * (x / lambda()) / half.tanh() * (2.0 * half * segments as f64).tanh();
        let mut bar = Bar::new(length_m, segments, f64::INFINITY);
        let found_n_m = bar.pull(1e-4) / 1e-4;
        // The driver gives way by 1e-6 of a bar of a metre.
        assert!((found_n_m / chain_n_m - 1.0).abs() < 1e-5, "{found_n_m:e} {chain_n_m:e}");
        let driven = found_n_m * -bar.u[0].recip() * 1e-4;
        assert!((driven / chain_n_m - 1.0).abs() < 1e-9, "{driven:e} {chain_n_m:e}");
        let bar_n_m = EA_N * lambda() * (lambda() * length_m).tanh();
        assert!((chain_n_m / bar_n_m - 1.0).abs() <= 0.15 * x * x, "{chain_n_m:e} {bar_n_m:e}");
    }
}

#[test]
fn pull_out_of_bars_has_the_stiffness_of_the_continuum() {
    for (length_m, stiffness_n_m) in [(0.5, 37.9573e6), (2.0, 44.7042e6)] {
        let mut bar = Bar::new(length_m, 4000, f64::INFINITY);
        bar.pull(1e-4);
        let pull_n: f64 = (0..bar.u.len()).map(|i| bar.holders[i].law.force_n(-bar.u[i])).sum();
        assert!((pull_n / -bar.u[0] / stiffness_n_m - 1.0).abs() < 2e-6, "{}", pull_n / -bar.u[0]);
    }
}

#[test]
fn bond_fails_and_debonding_runs_along_the_bar() {
    for segments in [20, 40, 200] {
        let mut bar = Bar::new(2.0, segments, f64::INFINITY);
        let pull_n = bar.pull(1.5625e-3);
        assert!((pull_n / 69.850e3 - 1.0).abs() < 0.01, "{pull_n}");
        let mut bar = Bar::new(2.0, segments, f64::INFINITY);
        let pull_n = bar.pull(10.3278e-3);
        assert!((pull_n / 243.931e3 - 1.0).abs() < 0.01, "{segments}: {pull_n}");
        let pull_n = bar.pull(0.1);
        assert!((pull_n / 350e3 - 1.0).abs() < 1e-9, "{pull_n}");
        // Slip stays when it is pushed back: elastic first.
        let back_n = bar.pull(0.1 - 1e-4);
        assert!(back_n < 350e3 && back_n > 0.0);
    }
}

#[test]
fn a_long_bar_yields_where_the_debonded_part_carries_the_yield_force() {
    // T_y = s_b a + (s_b/λ): a; u = s_b/k_b + (s_b/(EA)) (a²/2 + a/λ).
    let a = YIELD_N / STRENGTH_N_M - 1.0 / lambda();
    let yield_m = STRENGTH_N_M / BOND_N_M2 + STRENGTH_N_M / EA_N * (0.5 * a * a + a / lambda());
    assert!((yield_m - 40.805e-3).abs() < 1e-6, "{yield_m}");
    for segments in [180, 400] {
        let mut bar = Bar::new(17.7, segments, YIELD_N);
        // The head itself is held by half a segment of grout.
        let head_n = STRENGTH_N_M * 0.5 * 17.7 / segments as f64;
        let pull_n = bar.pull(yield_m * 0.99) - head_n;
        assert!(pull_n < YIELD_N && pull_n > 0.97 * YIELD_N, "{pull_n}");
        let pull_n = bar.pull(yield_m * 1.05);
        assert!((pull_n - head_n - YIELD_N).abs() < 1.0, "{pull_n}");
    }
}

#[test]
fn any_chain_comes_to_rest_and_nothing_near_is_lower() {
    let mut seed = 1u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let (mut most, mut workspace) = (0, Workspace::new(40));
    for _ in 0..3000 {
        let nodes = 2 + (30.0 * random()) as usize;
        let mut bar = Bar::new(1.0, nodes - 1, f64::INFINITY);
        for law in &mut bar.steel {
            *law = Law::symmetric(10f64.powf(6.0 * random()), 10f64.powf(3.0 * random()));
        }
        for holder in &mut bar.holders {
            holder.law = Law::symmetric(10f64.powf(6.0 * random()), 10f64.powf(3.0 * random()));
        }
        bar.rock_m.iter_mut().for_each(|g| *g = 10f64.powf(4.0 * random() - 3.0) * (random() - 0.5));
        bar.broken.iter_mut().for_each(|broken| *broken = random() < 0.05);
        let chain = Chain {
            steel: &bar.steel,
            rest_m: &bar.rest_m,
            yielded_m: &bar.yielded_m,
            broken: &bar.broken,
            holders: &bar.holders,
            slip_m: &bar.slip_m,
            rock_m: &bar.rock_m,
        };
        most = most.max(chain.solve(&mut bar.u, &mut workspace));
        let least_j = chain.potential_j(&bar.u);
        for i in 0..nodes {
            for change in [-1e-3, 1e-3] {
                let mut near = bar.u.clone();
                near[i] += change;
                assert!(chain.potential_j(&near) >= least_j * (1.0 - 1e-12));
            }
        }
    }
    assert!(most < 200, "{most} iterations");
}
