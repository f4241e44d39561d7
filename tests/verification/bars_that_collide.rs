//! A bar that flies hits an equal one end to end. Bars exchange their velocities by a wave that runs there and back;
//! the error of bars with contact of a given stiffness falls with the square of mesh and step.

use ndda_mesh::BlockId;

use crate::evidence::Answer::{AtLeast, AtMost, Near};
use crate::evidence::row;
use crate::simulation;

const CASE: &str = "bars that collide";
const YOUNG_PA: f64 = 20e9;
const DENSITY: f64 = 2500.0;
const LENGTH_M: f64 = 1.0;
/// So slow that contact, v/c · L₀/4 deep, is far less so than bars are thick.
const SPEED_M_S: f64 = 0.01;
/// L₀ of the potential.
const REFERENCE_M: f64 = 0.2;

fn wave_m_s() -> f64 {
    (YOUNG_PA / DENSITY).sqrt()
}

fn there_and_back_s() -> f64 {
    2.0 * LENGTH_M / wave_m_s()
}

/// Velocity of the mass centre of the bar that is hit, over that of the other, on a grid of times of `dt` = 2L/c over `parts`, by d'Alembert's waves:
/// both ends give way by p/ρc, and by twice as much as each reflected wave comes back to them; p = k d of their overlap d. Heun's method.
fn waves(parts: usize, periods: f64) -> Vec<f64> {
    let impedance = DENSITY * wave_m_s();
    let stiffness = 2.0 * YOUNG_PA / REFERENCE_M;
    let dt = there_and_back_s() / parts as f64;
    let steps = (periods * parts as f64) as usize;
    let (mut overlap, mut pressure, mut velocity) = (0.0f64, vec![0.0f64], vec![0.0f64]);
    let echoes = |pressure: &[f64], i: usize| {
        (1..).map_while(|n| i.checked_sub(n * parts)).map(|j| pressure[j]).sum::<f64>()
    };
    for i in 0..steps {
        let closing = |i: usize, overlap: f64| {
            SPEED_M_S - 2.0 / impedance * ((stiffness * overlap).max(0.0) + 2.0 * echoes(&pressure, i))
        };
        let first = closing(i, overlap);
        let second = closing(i + 1, overlap + dt * first);
        overlap += 0.5 * dt * (first + second);
        pressure.push((stiffness * overlap).max(0.0));
        let mean = 0.5 * (pressure[i] + pressure[i + 1]);
        velocity.push(velocity[i] + dt * mean / (DENSITY * LENGTH_M * SPEED_M_S));
    }
    velocity
}

/// Largest error of the velocity of the bar that is hit, over that of the other, before the wave comes back and in all; and that velocity at the end.
fn errors(cells: usize, exact: &[f64], parts: usize) -> [f64; 3] {
    let cell = LENGTH_M / cells as f64;
    // A quarter of the time that a wave takes for a cell.
    let steps = 8 * cells;
    let step_s = there_and_back_s() / steps as f64;
    let bar = |name: &str, at: f64, velocity: f64| {
        format!(
            "(name: \"{name}\", material: \"rock\", at_m: ({at}, 0, 0), velocity_m_s: ({velocity}, 0, 0),
              shape: Box(size_m: ({LENGTH_M}, {cell}, {cell}), cells: ({cells}, 1, 1), pattern: TwentyFour)),"
        )
    };
    let mut simulation = simulation(&format!(
        "(title: \"bars\", time: (step_s: {step_s:e}, end_s: 1),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: 0, density_kg_m3: {DENSITY})],
          blocks: [{}{}],
          contact: Potential(penalty_pa: {YOUNG_PA:e}, potential: Smooth(reference_m: {REFERENCE_M})))",
        bar("a", 0.0, SPEED_M_S),
        bar("b", LENGTH_M, 0.0)
    ));
    let [mut early, mut all, mut last] = [0.0f64; 3];
    for step in 1..=steps * 3 / 2 {
        simulation.step().unwrap();
        let operator = &simulation.shape(BlockId(1)).operator;
        let nodes = simulation.blocks().nodes_of(BlockId(1));
        last = operator.momentum(&simulation.state().velocity[nodes]).x / (operator.mass_kg * SPEED_M_S);
        let error = (last - exact[step * parts / steps]).abs();
        all = all.max(error);
        if 10 * step < 9 * steps {
            early = early.max(error);
        }
    }
    [early, all, last]
}

#[test]
fn the_error_of_bars_that_collide_falls_with_the_square_of_mesh_and_step() {
    let parts = 32_000;
    let exact = waves(parts, 1.5);
    let meshes = [10, 20, 40];
    let found = meshes.map(|cells| errors(cells, &exact, parts));
    for (cells, [early, ..]) in meshes.iter().zip(found) {
        // Until waves come back bars are without end, and contact yields with the time L₀/4c, a wave's length ℓ = L₀/4. A row of lumped masses resists an angular
        // frequency ω as ρ c √(1 − (ω a/2 c)²) for masses at a distance of a, here half a cell: the impulse lacks a²/16 ℓ L of all momentum.
        let apart_m = 0.5 * LENGTH_M / *cells as f64;
        let chain = apart_m * apart_m / (16.0 * 0.25 * REFERENCE_M * LENGTH_M);
        let what = format!("largest error of the velocity until waves come back, {cells} cells");
        row(CASE, &what, early, AtMost(chain));
    }
    for (pair, cells) in found.windows(2).zip(meshes) {
        let [early, all] = [0, 1].map(|i| (pair[0][i] / pair[1][i]).log2());
        let what = |what: &str| format!("{what}, {cells} cells and Δt against twice as many of half of it");
        // The rule of the step and lumped masses are of second order.
        row(CASE, &what("order of the velocity until waves come back"), early, AtLeast(2.0));
        // Pressure begins with a kink, which meshes spread as cells^(2/3) of the length (Brenner, Thomée & Wahlbin 1975): less than the second order
        // of what is smooth, and more than the first.
        row(CASE, &what("order of the velocity until they have parted"), all, AtLeast(1.0));
    }
    let last = exact[exact.len() - 1];
    // Of what falls with the first order or more, the finer of two meshes has no more error than the two differ by.
    let differ = (found[2][2] - found[1][2]).abs();
    row(
        CASE,
        "velocity of the bar that is hit over that of the other, 40 cells",
        found[2][2],
        Near(last, differ.min(2e-3)),
    );
}
