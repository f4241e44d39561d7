//! Newton's cradle: a rigid cube hits a row of touching ones, compared with the differential equation of a chain of
//! masses whose springs are the contacts (Herrmann & Schmälzle 1981; Herrmann & Seitz 1982): springs of equal
//! stiffness share the momentum, so that the last cube does not take all of it.

use ndda::judge::verdict;
use ndda::summary::LabelWord;
use ndda_mesh::BlockId;
use ndda_solver::Simulation;

use crate::evidence::Answer::{AtMost, Near};
use crate::evidence::{rounding, row};
use crate::simulation;

const CASE: &str = "Newton's cradle";
const PENALTY_PA: f64 = 4e6;
const DENSITY: f64 = 2500.0;
const SPEED_M_S: f64 = 0.5;
/// Five cubes have parted after 0.3 s.
const END_S: f64 = 0.35;
const STEPS_S: [f64; 4] = [2e-3, 1e-3, 5e-4, 2.5e-4];

/// A row of touching cubes of 1 m, the first of which arrives.
fn cubes(count: usize, step_s: f64) -> Simulation {
    let cube = |i: usize| {
        let velocity = if i == 0 { SPEED_M_S } else { 0.0 };
        format!(
            "(name: \"cube_{i}\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)),
              at_m: ({i}, 0, 0), velocity_m_s: ({velocity}, 0, 0)),"
        )
    };
    simulation(&format!(
        "(title: \"cradle\", time: (step_s: {step_s:e}, end_s: {END_S}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: {DENSITY})],
          blocks: [{}],
          contact: Potential(penalty_pa: {PENALTY_PA:e}, potential: Smooth(reference_m: 1)))",
        (0..count).map(cube).collect::<String>()
    ))
}

/// Force between two cubes of 1 m at depth h [N], 2 k_n/L₀ ∫ φ dA: φ is the depth below the nearest face, which within h of an edge is the side, so that
/// the integral is the volume of a frustum of height h.
fn force_n(depth_m: f64) -> f64 {
    let h = depth_m.max(0.0);
    2.0 * PENALTY_PA * (h - 2.0 * h * h + 4.0 / 3.0 * h * h * h)
}

/// Accelerations of a chain of displaced masses.
fn accelerations(x: &[f64]) -> Vec<f64> {
    let mut a = vec![0.0; x.len()];
    for i in 1..x.len() {
        let push = force_n(x[i - 1] - x[i]) / DENSITY;
        a[i - 1] -= push;
        a[i] += push;
    }
    a
}

fn plus(x: &[f64], v: &[f64], dt: f64) -> Vec<f64> {
    x.iter().zip(v).map(|(x, v)| x + dt * v).collect()
}

fn start(count: usize) -> (Vec<f64>, Vec<f64>) {
    let mut v = vec![0.0; count];
    v[0] = SPEED_M_S;
    (vec![0.0; count], v)
}

/// Velocities and displacements at the end by the classical Runge–Kutta method in 100 000 steps.
fn chain(count: usize) -> (Vec<f64>, Vec<f64>) {
    let (mut x, mut v) = start(count);
    let steps = 100_000;
    let dt = END_S / f64::from(steps);
    for _ in 0..steps {
        let a1 = accelerations(&x);
        let (v2, a2) = (plus(&v, &a1, 0.5 * dt), accelerations(&plus(&x, &v, 0.5 * dt)));
        let (v3, a3) = (plus(&v, &a2, 0.5 * dt), accelerations(&plus(&x, &v2, 0.5 * dt)));
        let (v4, a4) = (plus(&v, &a3, dt), accelerations(&plus(&x, &v3, dt)));
        for i in 0..count {
            x[i] += dt / 6.0 * (v[i] + 2.0 * (v2[i] + v3[i]) + v4[i]);
            v[i] += dt / 6.0 * (a1[i] + 2.0 * (a2[i] + a3[i]) + a4[i]);
        }
    }
    (v, x)
}

/// The same by the midpoint rule of the program, in its steps.
fn stepped(count: usize, step_s: f64) -> Vec<f64> {
    let (mut x, mut v) = start(count);
    for _ in 0..(END_S / step_s).round() as u32 {
        let a = accelerations(&plus(&x, &v, 0.5 * step_s));
        let middle = plus(&v, &a, 0.5 * step_s);
        x = plus(&x, &middle, step_s);
        v = plus(&v, &a, step_s);
    }
    v
}

/// Velocities of the cubes at the end, and the simulation.
fn run(count: usize, step_s: f64) -> (Vec<f64>, Simulation) {
    let mut simulation = cubes(count, step_s);
    simulation.sample().unwrap();
    for step in 1..=(END_S / step_s).round() as u32 {
        simulation.step().unwrap();
        if step % 25 == 0 {
            simulation.sample().unwrap();
        }
    }
    let velocity = (0..count as u32).map(|i| {
        let operator = &simulation.shape(BlockId(i)).operator;
        let nodes = simulation.blocks().nodes_of(BlockId(i));
        operator.momentum(&simulation.state().velocity[nodes]).x / operator.mass_kg
    });
    (velocity.collect(), simulation)
}

fn farthest(found: &[f64], exact: &[f64]) -> f64 {
    found.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / SPEED_M_S
}

/// Slope of the logarithms of errors over those of steps, by least squares.
fn order(errors: &[f64]) -> f64 {
    let points: Vec<_> = STEPS_S.iter().zip(errors).map(|(dt, e)| (dt.ln(), e.ln())).collect();
    let count = points.len() as f64;
    let mean = points.iter().fold((0.0, 0.0), |m, p| (m.0 + p.0 / count, m.1 + p.1 / count));
    let (over, under) = points
        .iter()
        .fold((0.0, 0.0), |s, p| (s.0 + (p.0 - mean.0) * (p.1 - mean.1), s.1 + (p.0 - mean.0).powi(2)));
    over / under
}

#[test]
fn cubes_part_as_masses_of_a_chain_with_the_springs_of_contact() {
    for count in 2..=5 {
        let (exact, places) = chain(count);
        assert!(accelerations(&places).iter().all(|a| *a == 0.0), "{count} cubes still touch");
        let mut errors = Vec::new();
        for step_s in STEPS_S {
            let (found, simulation) = run(count, step_s);
            let what = |what: &str| format!("{what}, {count} cubes, Δt = {step_s:e} s");
            // Places of some metres are rounded, of which depths of v/ω = 9 mm and less are the difference, in every step.
            let (steps, depth_m) =
                ((END_S / step_s).round() as u32, SPEED_M_S * (DENSITY / 2.0 / PENALTY_PA).sqrt());
            row(
                CASE,
                &what(
                    "largest difference of velocities from the chain in the same steps, over that of the first",
                ),
                farthest(&found, &stepped(count, step_s)),
                AtMost(count as f64 / depth_m * rounding(steps)),
            );
            errors.push(farthest(&found, &exact));
            // A quarter of h² of the speed is what contact that begins or ends within a step may change (bouncing_block.rs), h = ω Δt of the fastest
            // mode of a long chain, ω² = 4 k/m.
            let h = 2.0 * step_s * (2.0 * PENALTY_PA / DENSITY).sqrt();
            row(
                CASE,
                &what("largest error of velocities after they have parted, over that of the first"),
                errors[errors.len() - 1],
                Near(0.0, 0.25 * h * h),
            );
            assert_eq!(verdict::label(&simulation, None).word, LabelWord::Accurate, "{count}, {step_s}");
        }
        if count == 2 {
            // One contact that ends as it began: its error is that of a single end within a step, and has no order of its own.
            row(
                CASE,
                "velocity of the second of two cubes by the chain's equation, over that of the first",
                exact[1] / SPEED_M_S,
                Near(1.0, 1e-8),
            );
        } else {
            // Which part of a step is left when contacts begin and end moves single errors by a factor of two: by 2 ^ ±0.3 over three halvings.
            row(
                CASE,
                &format!("order of the error in the step, {count} cubes"),
                order(&errors),
                Near(2.0, 0.3),
            );
        }
        if count == 5 {
            // What the scene of the study is compared with.
            let scene = include_str!("../../scenes/studies/base/cradle.ron");
            assert!(scene.contains(&format!("displacement_m: ({:.9}, 0, 0)", places[4])), "{}", places[4]);
        }
        let last = exact[count - 1] / SPEED_M_S;
        let (found, _) = run(count, STEPS_S[3]);
        let what = format!("velocity of the last of {count} cubes, over that of the first");
        row(CASE, &what, found[count - 1] / SPEED_M_S, Near(last, 0.25 * 0.0283f64.powi(2)));
    }
}
