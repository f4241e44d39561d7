//! Damping of contact against independent equations of motion: a mass that sinks into a damped contact, two in a stack, and a block that is pushed against
//! the dashpots of its shear springs. What is called accurate is right within 1 % of the largest speed, and within 2 % for
//! masses that sink, part of which their equations leave out.

use ndda::judge::verdict;
use ndda::summary::LabelWord;
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;

use crate::evidence::Answer::AtMost;
use crate::evidence::row;
use crate::simulation;

const CASE: &str = "damping of contact against equations of motion";
const GRAVITY_M_S2: f64 = 9.81;
const MASS_KG: f64 = 2500.0;
/// α of docs/theory/contact.md.
const FACTORS: [(f64, f64); 4] = [(0.0, 34.5007), (0.05, 7.1730), (0.3, 1.6706), (0.6, 0.7341)];

/// Masses in a stack on one-sided springs of k, damped by 1 + α δ̇/√(δ̇² + k δ²/m), under gravity that comes suddenly: velocities at these times, by
/// Heun's rule in far shorter steps.
fn sinking_masses(count: usize, spring_n_m: f64, factor: f64, times_s: &[f64]) -> Vec<Vec<f64>> {
    let push_n = |i: usize, y: &[f64], v: &[f64]| {
        let (below, speed) = if i == 0 { (0.0, 0.0) } else { (y[i - 1], v[i - 1]) };
        let (depth, rate) = (below - y[i], speed - v[i]);
        let reduced_kg = if i == 0 { MASS_KG } else { 0.5 * MASS_KG };
        let energy = (rate * rate + spring_n_m * depth * depth / reduced_kg).sqrt();
        if depth <= 0.0 { 0.0 } else { spring_n_m * depth * (1.0 + factor * rate / energy).max(0.0) }
    };
    let rates = |y: &[f64], v: &[f64]| -> Vec<f64> {
        let pushes: Vec<f64> = (0..count).map(|i| push_n(i, y, v)).collect();
        let above = |i: usize| pushes.get(i + 1).copied().unwrap_or(0.0);
        (0..count).map(|i| (pushes[i] - above(i)) / MASS_KG - GRAVITY_M_S2).collect()
    };
    let dt_s = 2e-4 / (spring_n_m / MASS_KG).sqrt();
    let (mut y, mut v, mut t_s) = (vec![0.0; count], vec![0.0; count], 0.0);
    let mut found = Vec::new();
    for &end_s in times_s {
        while t_s < end_s - 1e-9 * end_s {
            let dt_s = dt_s.min(end_s - t_s);
            let first = rates(&y, &v);
            let y1: Vec<f64> = (0..count).map(|i| y[i] + dt_s * v[i]).collect();
            let v1: Vec<f64> = (0..count).map(|i| v[i] + dt_s * first[i]).collect();
            let second = rates(&y1, &v1);
            for i in 0..count {
                y[i] += 0.5 * dt_s * (v[i] + v1[i]);
                v[i] += 0.5 * dt_s * (first[i] + second[i]);
            }
            t_s += dt_s;
        }
        found.push(v.clone());
    }
    found
}

/// Cubes of a metre on each other on a plate, whose contacts have springs of 2 k_n.
fn stack(count: usize, body: &str, penalty_pa: f64, restitution: f64, step_s: f64) -> Simulation {
    let cube = |i: usize| {
        format!(
            "(name: \"cube_{i}\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)), at_m: (0, 0, {i})),"
        )
    };
    let cubes: String = (0..count).map(cube).collect();
    simulation(&format!(
        "(title: \"stack\", time: (step_s: {step_s:e}, end_s: 10), gravity_m_s2: (0, 0, -{GRAVITY_M_S2}),
          materials: [(name: \"rock\", young_pa: 2e10, poisson: 0, density_kg_m3: {MASS_KG})],
          blocks: [
            (name: \"plate\", material: \"rock\", body: Fixed, shape: Box(size_m: (3, 3, 1), cells: (2, 2, 1)), at_m: (-1, -1, -1)),
            {cubes}
          ],
          contact: Potential(penalty_pa: {penalty_pa:e}, potential: Smooth(reference_m: 1), restitution: {restitution}))"
    ))
}

/// Mean velocity of a block [m/s].
pub(crate) fn velocity(simulation: &Simulation, block: u32) -> Vec3 {
    let nodes = simulation.blocks().nodes_of(BlockId(block));
    let velocity = &simulation.state().velocity[nodes];
    velocity.iter().sum::<Vec3>() / velocity.len() as f64
}

#[test]
fn masses_sink_into_damped_contacts_as_their_equations_say_where_the_run_is_called_accurate() {
    let penalty_pa = 4e6;
    let spring_n_m = 2.0 * penalty_pa;
    let omega = (spring_n_m / MASS_KG).sqrt();
    let mut found_accurate = Vec::new();
    for body in ["Rigid", "Elastic"] {
        for count in [1, 2] {
            for (restitution, factor) in FACTORS {
                let times_s: Vec<f64> = (1..=10).map(|i| 2.0 * f64::from(i) / omega).collect();
                let truth = sinking_masses(count, spring_n_m, factor, &times_s);
                let fastest = truth.iter().flatten().fold(0.0f64, |most, v| most.max(v.abs()));
                for steps in [10u32, 20, 40] {
                    let step_s = 2.0 / omega / f64::from(steps);
                    let mut simulation = stack(count, body, penalty_pa, restitution, step_s);
                    simulation.sample().unwrap();
                    let mut worst = 0.0f64;
                    for expected in &truth {
                        crate::advance(&mut simulation, u64::from(steps));
                        for (i, expected) in expected.iter().enumerate() {
                            let found = velocity(&simulation, i as u32 + 1).z;
                            worst = worst.max((found - expected).abs() / fastest);
                        }
                        simulation.sample().unwrap();
                    }
                    let label = verdict::label(&simulation, None);
                    println!(
                        "{count} {body}, e = {restitution}, {steps} steps: {worst:.4}, {:?} {:?}",
                        label.word, label.reasons
                    );
                    if label.word == LabelWord::Accurate {
                        let what = format!(
                            "{count} mass(es) that sink, {body}, e = {restitution}, ω Δt = {}: error of velocities over the largest",
                            2.0 / f64::from(steps)
                        );
                        found_accurate.push((what, worst));
                    }
                }
            }
        }
    }
    // 1 % is promised. The cubes are 3 and 6 mm deep, over which the depth below their sides is less at the edges: up to 1 % of the force.
    found_accurate.into_iter().for_each(|(what, error)| row(CASE, &what, error, AtMost(0.02)));
}

/// A plate of a metre square, 0.1 m thick, on shear springs of K that a growing force pushes: its velocity along them [m/s], and the label.
fn pushed_plate(body: &str, restitution: f64, step_s: f64) -> (f64, LabelWord, Vec<String>) {
    let mut simulation = simulation(&format!(
        "(title: \"pushed\", time: (step_s: {step_s:e}, end_s: {PUSHED_S}), gravity_m_s2: (0, 0, -{GRAVITY_M_S2}),
          materials: [(name: \"rock\", young_pa: 2e9, poisson: 0.25, density_kg_m3: {})],
          blocks: [
            (name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (3, 3, 0.5), cells: (2, 2, 1)), at_m: (-1, -1, -0.5)),
            (name: \"plate\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 0.1), cells: (3, 3, 1)), at_m: (0, 0, 0)),
          ],
          forces: [(block: \"plate\", force_n: ({PUSH_N}, 0, 0), factor: [(time_s: 0, factor: 0), (time_s: {PUSHED_S}, factor: 1)])],
          contact: Potential(penalty_pa: 2e6, potential: Smooth(reference_m: 1), restitution: {restitution},
            friction: (friction_deg: 45, shear_penalty_pa_m: {SPRING_N_M:e})))",
        PLATE_KG / 0.1
    ));
    simulation.sample().unwrap();
    crate::advance(&mut simulation, (PUSHED_S / step_s).round() as u64);
    simulation.sample().unwrap();
    let label = verdict::label(&simulation, None);
    (velocity(&simulation, 1).x, label.word, label.reasons)
}

const PLATE_KG: f64 = 500.0;
const PUSH_N: f64 = 2e3;
const PUSHED_S: f64 = 0.24;
const SPRING_N_M: f64 = 1e5;

/// The same of one mass, m x'' = F t/T − K x − α √(m K) x', by the midpoint rule in steps that are far shorter.
fn pushed_mass_m_s(factor: f64) -> f64 {
    let dashpot = factor * (PLATE_KG * SPRING_N_M).sqrt();
    let steps = 200_000;
    let dt_s = PUSHED_S / f64::from(steps);
    let (mut x, mut v) = (0.0, 0.0);
    for step in 0..steps {
        let push_n = PUSH_N * (f64::from(step) + 0.5) / f64::from(steps);
        let rate = |x: f64, v: f64| (push_n - SPRING_N_M * x - dashpot * v) / PLATE_KG;
        let (mid_x, mid_v) = (x + 0.5 * dt_s * v, v + 0.5 * dt_s * rate(x, v));
        x += dt_s * mid_v;
        v += dt_s * rate(mid_x, mid_v);
    }
    v
}

#[test]
fn a_block_against_the_dashpots_of_its_shear_springs_moves_as_one_mass_whatever_the_step() {
    let mut found_accurate = Vec::new();
    for body in ["Rigid", "Affine", "Elastic"] {
        for (restitution, factor) in FACTORS {
            let exact = pushed_mass_m_s(factor);
            for step_s in [4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4] {
                let (found, word, reasons) = pushed_plate(body, restitution, step_s);
                let error = (found / exact - 1.0).abs();
                println!(
                    "{body}, e = {restitution}, {step_s} s: {found:.6} of {exact:.6} m/s, {error:.5} off, {word:?} {reasons:?}"
                );
                // From where the label has nothing to say against the step.
                assert!(
                    restitution < 0.3 || step_s > 1e-3 || word == LabelWord::Accurate,
                    "{body}, {restitution}, {step_s} s: {reasons:?}"
                );
                if word == LabelWord::Accurate {
                    let what = format!(
                        "a plate pushed on springs with dashpots, {body}, e = {restitution}, Δt = {step_s} s: error of its velocity"
                    );
                    found_accurate.push((what, error));
                }
            }
        }
    }
    found_accurate.into_iter().for_each(|(what, error)| row(CASE, &what, error, AtMost(0.01)));
}
