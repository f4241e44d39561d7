//! Contract suites that a fork can run on its own integrator or linear solver.

use ndda_mesh::{Mat3, Vec3};

use crate::integrators::time_integrator::TimeIntegrator;
use crate::linear::linear_solver::{Factor, LinearSolver, MULTI, SymmetricMatrix};

/// Panics unless `integrator` keeps the contract of [`TimeIntegrator`].
pub fn check_integrator(integrator: &dyn TimeIntegrator) {
    let (dt_s, gravity) = (1e-3, Vec3::new(0.0, 0.5, -9.8));
    let weights = integrator.weights(dt_s);
    assert!(0.0 < weights.stiffness && weights.stiffness <= 1.0, "θ = {}", weights.stiffness);
    assert!(weights.mass_per_s2 > 0.0 && weights.mass_per_s2.is_finite());
    assert!((0.0..=1.0).contains(&weights.contact_lead));

    check_correction(integrator, dt_s);
    check_oscillator(integrator);

    // Constant acceleration: c M (u − û) = M g in every step, exact for a start with a = g.
    let (mut x, mut v, mut a) = (Vec3::zeros(), Vec3::new(1.0, 0.0, 2.0), gravity);
    let (start, steps) = (v, 1000);
    for _ in 0..steps {
        let predicted = integrator.predict(dt_s, &v, &a);
        let u = predicted + (gravity - weights.old_inertia * a) / weights.mass_per_s2;
        integrator.correct(dt_s, &u, &predicted, &mut v, &mut a);
        x += u;
    }
    let t = dt_s * f64::from(steps);
    assert!((x - start * t - 0.5 * gravity * t * t).norm() < 1e-12, "constant acceleration is not exact");
    assert!((v - start - gravity * t).norm() < 1e-12);

    let (mut v, mut a) = (Vec3::x(), Vec3::zeros());
    let predicted = integrator.predict(dt_s, &v, &a);
    integrator.correct(dt_s, &predicted.clone(), &predicted, &mut v, &mut a);
    let change = (v - Vec3::x()).norm() + dt_s * a.norm();
    assert!(change <= 1e-12, "a step without force changes the velocity by {change} of 1 m/s");
}

/// The weights say what `correct` does: ∂v₁/∂u, the mean velocity, and Newmark's β and γ.
fn check_correction(integrator: &dyn TimeIntegrator, dt_s: f64) {
    let weights = integrator.weights(dt_s);
    let (v0, a0) = (Vec3::new(1.0, -2.0, 0.5), Vec3::new(3.0, 0.1, -7.0));
    let predicted = integrator.predict(dt_s, &v0, &a0);
    let end = |u: &Vec3| {
        let (mut v, mut a) = (v0, a0);
        integrator.correct(dt_s, u, &predicted, &mut v, &mut a);
        (v, a)
    };
    let (u, by) = (predicted + Vec3::new(2e-6, -1e-6, 3e-6), Vec3::new(1e-3, 2e-3, -1e-3));
    let ((v, a), (moved, _)) = (end(&u), end(&(u + by)));
    let expected = weights.velocity_per_m * by;
    let off = (moved - v - expected).norm() / expected.norm();
    assert!(off < 1e-9, "velocity_per_m is off by {off:e} of what `correct` does");
    if weights.mean_velocity {
        let off = (u - 0.5 * dt_s * (v0 + v)).norm() / u.norm();
        assert!(off < 1e-12, "u is not Δt (v₀ + v₁)/2: off by {off:e}");
    }
    if weights.needs_acceleration {
        let beta = weights.beta(dt_s);
        let by_beta = dt_s * v0 + dt_s * dt_s * ((0.5 - beta) * a0 + beta * a);
        let off = (u - by_beta).norm() / u.norm();
        assert!(off < 1e-9, "u is not Δt v₀ + Δt² [(½ − β) a₀ + β a₁]: off by {off:e}");
    }
}

/// An elastic oscillator of frequency 1, x = cos t: the error shrinks at least in proportion to the step, and no step makes it grow.
fn check_oscillator(integrator: &dyn TimeIntegrator) {
    let error = |steps: u32| {
        let dt_s = std::f64::consts::TAU / f64::from(steps);
        let (mut x, mut v, mut a) = (Vec3::x(), Vec3::zeros(), -Vec3::x());
        (0..steps).for_each(|_| elastic_step(integrator, dt_s, (&mut x, &mut v, &mut a)));
        (x - Vec3::x()).norm().hypot(v.norm())
    };
    let (coarse, fine) = (error(200), error(400));
    assert!(fine < 0.1, "an oscillation of 400 steps is off by {fine} of its amplitude");
    assert!(fine <= 0.6 * coarse + 1e-9, "half the step does not halve the error: {coarse:e}, {fine:e}");
    for dt_s in [0.1, 1.0, 10.0, 1e3] {
        let (mut x, mut v, mut a) = (Vec3::x(), Vec3::zeros(), -Vec3::x());
        // Long steps may overshoot at first.
        let [early, late] = [0, 1].map(|_| {
            (0..1000).fold(0.0f64, |most, _| {
                elastic_step(integrator, dt_s, (&mut x, &mut v, &mut a));
                most.max(x.norm().hypot(v.norm()))
            })
        });
        assert!(
            late <= (1.0 + 1e-6) * early,
            "an elastic oscillation grows from {early:e} to {late:e} at ω Δt = {dt_s}"
        );
    }
}

/// (θ K + c M)(u − û) = −α_m M a − (1 − θ) K d − θ K (d + û) with K = M = 1.
fn elastic_step(integrator: &dyn TimeIntegrator, dt_s: f64, (x, v, a): (&mut Vec3, &mut Vec3, &mut Vec3)) {
    let weights = integrator.weights(dt_s);
    let theta = weights.stiffness;
    let predicted = integrator.predict(dt_s, v, a);
    let load = -weights.old_inertia * *a - (1.0 - theta) * *x - theta * (*x + predicted);
    let u = predicted + load / (theta + weights.mass_per_s2);
    integrator.correct(dt_s, &u, &predicted, v, a);
    *x += u;
}

/// Spectral radius of a step of a mass that contact holds as a spring of frequency ω_c, by h = ω_c Δt.
pub fn contact_radius(integrator: &dyn TimeIntegrator, h: f64) -> f64 {
    let weights = integrator.weights(1.0);
    let mut map = Mat3::zeros();
    for (k, mut column) in map.column_iter_mut().enumerate() {
        let start = [0, 1, 2].map(|i| if i == k { Vec3::x() } else { Vec3::zeros() });
        let [x, mut v, mut a] = start;
        let place = x + weights.contact_lead * v + weights.contact_lead_acceleration * a;
        let predicted = integrator.predict(1.0, &v, &a);
        let u = predicted + (-h * h * place - weights.old_inertia * a) / weights.mass_per_s2;
        integrator.correct(1.0, &u, &predicted, &mut v, &mut a);
        column.copy_from_slice(&[x.x + u.x, v.x, if weights.needs_acceleration { a.x } else { 0.0 }]);
    }
    map.complex_eigenvalues().iter().map(|value| value.norm()).fold(0.0, f64::max)
}

/// Panics unless `solver` keeps the contract of [`LinearSolver`]: it solves positive definite systems to round-off, refuses others, and makes no
/// numbers of a load that is none.
pub fn check_linear_solver(solver: &dyn LinearSolver) {
    for n in [1, 2, 40, 400] {
        // −1, 4 + i/n, −1 on and next to the diagonal, one long-range coupling.
        let entry = |i: usize, j: usize| match i - j {
            0 => 4.0 + i as f64 / n as f64,
            1 => -1.0,
            d if d == n / 2 && n > 4 => -0.5,
            _ => 0.0,
        };
        let matrix = SymmetricMatrix::from_lower(n, |j, out| {
            out.extend((j..n).map(|i| (i, entry(i, j))).filter(|&(i, value)| i == j || value != 0.0));
        });
        let exact: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).sin() + 0.1).collect();
        let mut x = matrix.times(&exact);
        let factor = solver.factor(&matrix).expect("the matrix is positive definite");
        assert_eq!(factor.unknowns(), n);
        let mut scratch = factor.new_scratch();
        factor.solve_in_place(&mut x, &mut scratch).expect("a solution");
        let error = x.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 1e-13, "n = {n}: error {error}");
        check_multi(factor.as_ref());
        for load in [f64::NAN, f64::INFINITY] {
            let mut x = vec![1.0; n];
            x[n / 2] = load;
            let solved = factor.solve_in_place(&mut x, &mut scratch);
            assert!(
                solved.is_err() || !x[n / 2].is_finite(),
                "n = {n}: a load of {load} moves by {}",
                x[n / 2]
            );
        }
    }
    let indefinite = SymmetricMatrix::from_lower(2, |j, out| {
        out.extend([(j, if j == 0 { 1.0 } else { -1.0 })]);
    });
    assert!(solver.factor(&indefinite).is_err(), "an indefinite matrix must be refused");
}

/// Panics if a solve allocates; `allocations` counts those of the thread so far, as a global allocator of the caller's test can.
pub fn check_solves_allocate_nothing(solver: &dyn LinearSolver, allocations: &dyn Fn() -> usize) {
    for n in [3, 400] {
        let matrix = SymmetricMatrix::from_lower(n, |j, out| {
            out.extend((j..n.min(j + 2)).map(|i| (i, if i == j { 4.0 } else { -1.0 })));
        });
        let factor = solver.factor(&matrix).expect("the matrix is positive definite");
        let (mut scratch, mut multi) = (factor.new_scratch(), factor.new_multi_scratch());
        let (mut one, mut many) = (vec![1.0; n], vec![[1.0; MULTI]; n]);
        let before = allocations();
        factor.solve_in_place(&mut one, &mut scratch).expect("a solution");
        factor.solve_multi_in_place(&mut many, &mut multi).expect("a solution");
        let made = allocations() - before;
        assert_eq!(made, 0, "solves of {n} unknowns made {made} allocations");
    }
}

/// Panics unless eight right-hand sides get the bits that each gets alone, with a scratch that was used before too.
pub(crate) fn check_multi(factor: &dyn Factor) {
    let n = factor.unknowns();
    let mut scratch = factor.new_multi_scratch();
    for round in 0..2 {
        let load = |i: usize, lane: usize| ((i * (lane + 1)) as f64 * 0.3 + f64::from(round)).sin();
        let mut eight: Vec<[f64; MULTI]> =
            (0..n).map(|i| std::array::from_fn(|lane| load(i, lane))).collect();
        factor.solve_multi_in_place(&mut eight, &mut scratch).expect("a solution");
        for lane in 0..MULTI {
            let mut one: Vec<f64> = (0..n).map(|i| load(i, lane)).collect();
            factor.solve_in_place(&mut one, &mut scratch).expect("a solution");
            let same = one.iter().zip(&eight).all(|(x, lanes)| x.to_bits() == lanes[lane].to_bits());
            assert!(same, "n = {n}: lane {lane} of eight has other bits than alone");
        }
    }
}
