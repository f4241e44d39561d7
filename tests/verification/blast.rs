//! Blasts: the wave that a pressure sends off, and the impulse that it gives.

use ndda_mesh::{BlockId, Vec3};

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;
use crate::quiet::{CELL_M, DENSITY, YOUNG_PA, speeds, velocity, with_record};
use crate::simulation;

/// Duvall's pressure with its peak of p₀, α and β [1/s].
fn pressure(peak_pa: f64, (alpha, beta): (f64, f64), t: f64) -> f64 {
    let shape = |t: f64| (-alpha * t).exp() - (-beta * t).exp();
    if t < 0.0 { 0.0 } else { peak_pa * shape(t) / shape((beta / alpha).ln() / (beta - alpha)) }
}

/// ∫ p dt = p₀ ξ (1/α − 1/β).
fn impulse(peak_pa: f64, (alpha, beta): (f64, f64)) -> f64 {
    let peak_s = (beta / alpha).ln() / (beta - alpha);
    peak_pa / ((-alpha * peak_s).exp() - (-beta * peak_s).exp()) * (1.0 / alpha - 1.0 / beta)
}

/// v = p(t − z/c)/ρ c along a column with a quiet far end.
#[test]
fn a_blast_on_a_face_sends_off_the_velocity_of_its_pressure_over_the_impedance() {
    let (cells, c, rates, start_s) = (60, speeds().0, (40.0, 160.0), 2e-3);
    let height = CELL_M * f64::from(cells);
    let step_s = 0.1 * CELL_M / c;
    let text = format!(
        "(title: \"column\", time: (step_s: {step_s:e}, end_s: 1),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: 0.25, density_kg_m3: {DENSITY})],
          blocks: [(name: \"column\", material: \"rock\", shape: Box(size_m: (1, 1, {height}), cells: (1, 1, {cells})))],
          ties: [(block: \"column\", on: [All])],
          quiet: [(block: \"column\", on: Set(\"z_max\"))],
          blasts: [(block: \"column\", on: Part(Set(\"z_min\")),
                    pressure: Duvall(peak_pa: 10e6, alpha_per_s: {}, beta_per_s: {}), start_s: {start_s})])",
        rates.0, rates.1
    );
    let mut simulation = with_record(&text, &[]);
    let (mut error, mut gone) = (0.0f64, 0.0);
    let peak = 10e6 / (DENSITY * c);
    for step in 1..=((start_s + 2.0 * height / c + 0.15) / step_s) as u32 {
        simulation.step().unwrap();
        let t = f64::from(step) * step_s;
        let v = velocity(&simulation, 40.0, 2);
        error = error.max((v - pressure(10e6, rates, t - start_s - 40.0 / c) / (DENSITY * c)).abs());
        gone += v * step_s;
    }
    row("blast on a face", "largest error of the velocity at 40 m over its peak", error / peak, AtMost(0.05));
    let exact = impulse(10e6, rates) / (DENSITY * c);
    row("blast on a face", "∫ v dt at 40 m [m]", gone, Within(exact, 5e-3));
}

/// Four rigid blocks around a square hole of 0.4 m, of which 1 m is charged: each gets ∫ p dt A.
#[test]
fn a_charged_hole_pushes_the_blocks_around_it_apart_by_its_impulse() {
    let rates = (2000.0, 20000.0);
    let block = |name: &str, at: [f64; 2]| {
        format!(
            "(name: \"{name}\", material: \"rock\", body: Rigid, at_m: ({}, {}, 0), shape: Box(size_m: (0.4, 0.4, 2), cells: (1, 1, 2))),",
            at[0], at[1]
        )
    };
    let mut simulation = simulation(&format!(
        "(title: \"hole\", time: (step_s: 1e-5, end_s: 1),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
          blocks: [{} {} {} {}],
          blasts: [(block: \"*\", on: Hole(from_m: (0, 0, 0), to_m: (0, 0, 1), within_m: 0.3),
                    pressure: Duvall(peak_pa: 1e6, alpha_per_s: 2000, beta_per_s: 20000))],
          contact: Off)",
        block("east", [0.2, -0.2]),
        block("west", [-0.6, -0.2]),
        block("north", [-0.2, 0.2]),
        block("south", [-0.2, -0.6])
    ));
    for _ in 0..2000 {
        simulation.step().unwrap();
    }
    // The lower half of the hole is charged: 1 m of each of its sides.
    let exact = impulse(1e6, rates) * 0.4 * 1.0 / (2500.0 * 0.4 * 0.4 * 2.0);
    let ways = [Vec3::x(), -Vec3::x(), Vec3::y(), -Vec3::y()];
    for (k, way) in ways.iter().enumerate() {
        let nodes = simulation.blocks().nodes_of(BlockId(k as u32));
        let operator = &simulation.shape(BlockId(k as u32)).operator;
        let v = operator.momentum(&simulation.state().velocity[nodes]) / operator.mass_kg;
        let name = format!("speed of block {k} away from a charged hole [m/s]");
        // ∫ p dt by the middles of steps is off by α β Δt²/24 of it, since p rises at once.
        let middles = 2000.0 * 20000.0 * 1e-5f64.powi(2) / 24.0;
        row("charged hole", &name, v.dot(way), Within(exact, middles));
    }
}
