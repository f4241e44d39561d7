//! Rayleigh damping in steps that do not resolve it: monotone at any a Δt and b ω² Δt, second order in short steps, and no work on
//! rigid motion.

use ndda::judge::verdict;
use ndda::summary::LabelWord;
use ndda_mesh::Vec3;
use ndda_solver::Simulation;

use crate::evidence::Answer::{AtMost, Near};
use crate::evidence::{rounding, row};
use crate::simulation;

const DENSITY: f64 = 2500.0;

/// Integrators that remember no accelerations, and those that do.
const PLAIN: [&str; 2] = ["Midpoint(theta: 0.5)", "Newmark(alpha: 0.5, delta: 1)"];
const REMEMBERING: [&str; 3] =
    ["Newmark(alpha: 0.25, delta: 0.5)", "GeneralizedAlpha(radius: 0)", "GeneralizedAlpha(radius: 0.8)"];

/// A unit cube in free space.
fn cube(step_s: f64, integrator: &str, body: &str, young_pa: f64, damping: &str, motion: &str) -> Simulation {
    simulation(&format!(
        "(title: \"cube\", time: (step_s: {step_s:e}, end_s: 10, integrator: {integrator}),
          materials: [(name: \"rock\", young_pa: {young_pa:e}, poisson: 0, density_kg_m3: {DENSITY}, damping: ({damping}))],
          blocks: [(name: \"cube\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), {motion})])"
    ))
}

/// Gives an affine cube the velocity x along x about its centre, which stretches it alone: ω² = 12 E/ρ for a unit cube.
fn stretch(simulation: &mut Simulation, rate_per_s: f64) {
    let mut snapshot = simulation.snapshot();
    let places = snapshot.state.position.clone();
    let center = places.iter().map(|x| x.x).sum::<f64>() / places.len() as f64;
    for (v, x) in snapshot.state.velocity.iter_mut().zip(&places) {
        *v = rate_per_s * (x.x - center) * Vec3::x();
    }
    simulation.restore(snapshot).unwrap();
}

/// The rate of stretching, and the strain, by the extreme nodes.
fn stretching(simulation: &Simulation) -> (f64, f64) {
    let (state, rest) = (simulation.state(), &simulation.blocks().rest_position);
    let ends = |field: &[Vec3]| {
        let near = (0..rest.len()).min_by(|&i, &j| rest[i].x.total_cmp(&rest[j].x)).unwrap();
        let far = (0..rest.len()).max_by(|&i, &j| rest[i].x.total_cmp(&rest[j].x)).unwrap();
        field[far].x - field[near].x
    };
    (ends(&state.velocity), ends(&state.position) - ends(rest))
}

#[test]
fn damping_on_mass_is_exact_for_any_step_integrator_and_body() {
    for (z, tells) in [(0.01, false), (1.0, true), (10.0, true), (1e6f64, true)] {
        let mut worst = 0.0f64;
        for integrator in PLAIN.iter().chain(&REMEMBERING) {
            for body in ["Rigid", "Affine", "Elastic"] {
                let damping = format!("mass_per_s: {:e}", z / 1e-3);
                let moving = "velocity_m_s: (3, 0, 0)";
                let mut simulation = cube(1e-3, integrator, body, 1e9, &damping, moving);
                simulation.sample().unwrap();
                for n in 1..=5 {
                    simulation.step().unwrap();
                    let exact = 3.0 * (-z * f64::from(n)).exp();
                    let off = simulation.state().velocity.iter().map(|v| (v.x - exact).abs());
                    worst = worst.max(off.fold(0.0, f64::max) / 3.0);
                }
                simulation.sample().unwrap();
                let invariants = simulation.invariants();
                // The impulse of drag is a Δt times velocities that are known to rounding.
                assert!(
                    invariants.linear_momentum < 1e-12 + 1e-14 * z,
                    "{integrator}, {body}: {invariants:?}"
                );
                let resolved = invariants.damping_speed <= 0.01;
                assert_eq!(resolved, !tells, "a Δt = {z}, {integrator}, {body}");
            }
        }
        let what =
            format!("largest error of e^(−a t) at a Δt = {z:e}, five integrators, three kinds of bodies");
        // Places that are rounded to ε of a metre leave accelerations of E ε/ρ, of which drag lets a part of 1/z act: five steps of that, sixtyfold.
        let rounds = 60.0 * 5.0 * 1e9 * f64::EPSILON / DENSITY * 1e-3 / 3.0 / z.max(1.0);
        row("damping", &what, worst, AtMost(rounds));
    }
}

#[test]
fn damping_on_stiffness_falls_monotonically_however_long_the_step() {
    // Rock so soft that elasticity does nothing while damping acts.
    let (young_pa, step_s) = (1e-3, 1e-3);
    let omega2 = 12.0 * young_pa / DENSITY;
    let mut rise = 0.0f64;
    for z in [1e-2, 0.1, 0.5, 1.0, 2.0, 4.0, 10.0, 1e2, 1e4, 1e6] {
        for integrator in PLAIN.iter().chain(&REMEMBERING) {
            let damping = format!("stiffness_s: {:e}", z / (omega2 * step_s));
            let mut simulation = cube(step_s, integrator, "Affine", young_pa, &damping, "");
            stretch(&mut simulation, 1e-3);
            let (mut last, y) = (1e-3, 0.5 * z);
            for _ in 0..12 {
                simulation.step().unwrap();
                let rate = stretching(&simulation).0;
                rise = rise.max((rate - last).max(-rate) / 1e-3);
                if PLAIN.contains(integrator) {
                    let left = (1.0 + 3.0 * y) / ((1.0 + y) * (1.0 + 2.0 * y).powi(2));
                    assert!((rate / last - left).abs() < 1e-6, "z = {z}: {} and {left}", rate / last);
                    assert!((left - (-z).exp()).abs() < 0.5 * z.powi(3).min(0.19), "z = {z}: {left}");
                }
                last = rate;
                // Later the creep of the strain shows, at a rate of 1/b.
                if last < 1e-6 {
                    break;
                }
            }
        }
    }
    row(
        "damping",
        "most that a rate of strain grows or turns over, b ω² Δt from 1e-2 to 1e6, of the first",
        rise,
        AtMost(1e-9),
    );
}

#[test]
fn a_damped_vibration_converges_with_the_square_of_the_step() {
    let young_pa = 1e7;
    let omega = (12.0 * young_pa / DENSITY).sqrt();
    let (on_mass, on_stiffness) = (0.2 * omega, 0.3 / omega);
    // ζ = a/2ω + b ω/2; strain v₀/ω_d e^{−ζωt} sin ω_d t.
    let zeta = 0.5 * (on_mass / omega + on_stiffness * omega);
    let (end_s, damped) = (4.0 / omega, omega * (1.0 - zeta * zeta).sqrt());
    let exact = 1e-3 * omega / damped * (-zeta * omega * end_s).exp() * (damped * end_s).sin();
    let damping = format!("mass_per_s: {on_mass:e}, stiffness_s: {on_stiffness:e}");
    let error = |steps: u32| {
        let step_s = end_s / f64::from(steps);
        let mut simulation = cube(step_s, PLAIN[0], "Affine", young_pa, &damping, "");
        stretch(&mut simulation, 1e-3 * omega);
        simulation.sample().unwrap();
        for _ in 0..steps {
            simulation.step().unwrap();
        }
        let balance_j = simulation.sample().unwrap().balance_j.abs();
        let start_j = 0.5 * DENSITY / 12.0 * (1e-3 * omega).powi(2);
        assert!(balance_j < 1e-10 * start_j, "{balance_j} of {start_j} J");
        (stretching(&simulation).1 - exact).abs() / 1e-3
    };
    let errors = [100, 200, 400].map(error);
    row(
        "damping",
        "error of a damped vibration after 4 rad, 400 steps, over its amplitude",
        errors[2],
        AtMost(5e-5),
    );
    let order = (errors[1] / errors[2]).log2();
    row("damping", "order of a damped vibration in the step", order, Near(2.0, 0.1));
}

#[test]
fn damping_on_stiffness_does_no_work_on_a_spinning_boulder() {
    // A cube turns steadily about any axis: once what centrifugal forces stretch has come to rest, nothing deforms.
    for body in ["Elastic", "Affine"] {
        for (b, integrator) in [("1e-2", PLAIN[0]), ("0.2", PLAIN[0]), ("1e-2", REMEMBERING[2])] {
            let damping = format!("stiffness_s: {b}");
            let moving = "velocity_m_s: (5, 0, 3), spin_rad_s: (3, 5, -4)";
            let mut simulation = cube(1e-3, integrator, body, 20e9, &damping, moving);
            let start = simulation.sample().unwrap();
            for _ in 0..if b == "0.2" { 6000 } else { 300 } {
                simulation.step().unwrap();
            }
            let mut last = simulation.sample().unwrap();
            let first_j = last.damping_work_j;
            let mut growth = 0.0f64;
            for _ in 0..67 {
                for _ in 0..10 {
                    simulation.step().unwrap();
                }
                let sample = simulation.sample().unwrap();
                growth = growth.max(sample.total_j() - last.total_j());
                last = sample;
            }
            // Nothing deforms, so that both are rounding of the energy in 670 steps.
            let rounds = rounding(670);
            let what = |what: &str| format!("{what} of its kinetic energy, {body}, b = {b} s, {integrator}");
            let work = (last.damping_work_j - first_j).abs() / start.kinetic_j;
            row(
                "damping",
                &what("work of stiffness damping on a boulder that spins for 0.67 s"),
                work,
                AtMost(rounds),
            );
            row(
                "damping",
                &what("most that its energy grows in 10 ms"),
                growth / start.kinetic_j,
                AtMost(rounds),
            );
            // All that damping may take is what the spin stores as strain: ρ ω² r²/E of the kinetic energy, 5e-6 here.
            let transient = first_j.abs() / start.kinetic_j;
            row("damping", &what("work of damping until it turns steadily"), transient, AtMost(5e-6));
            let worst = simulation.invariants();
            assert!(worst.angular_momentum < 1e-11 && worst.linear_momentum < 1e-11, "{worst:?}");
            assert_eq!(verdict::label(&simulation, None).word, LabelWord::Accurate, "{body}, b = {b}");
        }
    }
}

#[test]
fn strong_stiffness_damping_raises_no_false_alarm_of_energy() {
    // A block that hits nothing but is pulled all at once: damping takes what the load brings, far beyond the step.
    for b in [1e-4, 1e-2, 1.0] {
        let mut simulation = simulation(&format!(
            "(title: \"bar\", time: (step_s: 1e-4, end_s: 1),
              materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.25, density_kg_m3: 2500, damping: (stiffness_s: {b:e}))],
              blocks: [(name: \"bar\", material: \"rock\", shape: Box(size_m: (2, 1, 0.5), cells: (4, 2, 1)))],
              supports: [(block: \"bar\", on: Set(\"x_min\"), hold: Fixed)],
              tractions: [(block: \"bar\", on: Set(\"x_max\"), traction_pa: (1e5, 2e4, 0))])"
        ));
        simulation.sample().unwrap();
        for _ in 0..50 {
            for _ in 0..20 {
                simulation.step().unwrap();
            }
            simulation.sample().unwrap();
        }
        let worst = simulation.invariants();
        let off = worst.energy_gain.max(worst.energy_loss);
        row(
            "damping",
            &format!("energy from nowhere in a bar pulled at once, b = {b:e} s, of the largest"),
            off,
            // ε of a place is 2e-12 of a strain of 1e-4, and b/Δt times as much of what damping makes of it, up to 1e4: how much of that is lost
            // has no closed form.
            AtMost(1e-9),
        );
        assert!(worst.linear_momentum < 1e-10, "{worst:?}");
    }
}
