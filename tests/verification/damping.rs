//! Rayleigh damping against closed forms, and its place in the ledger.

use ndda_mesh::Vec3;

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::{rounding, row};
use crate::{POISSON, YOUNG_PA, assert_uniform_strain, rollers, simulation};

/// A unit cube in free space; `more` goes into the scene.
fn cube(step_s: f64, damping: &str, more: &str) -> ndda_solver::Simulation {
    simulation(&format!(
        "(title: \"cube\", time: (step_s: {step_s}, end_s: 10),
          materials: [(name: \"rock\", young_pa: 1e9, poisson: 0, density_kg_m3: 2500, damping: ({damping}))],
          blocks: [(name: \"cube\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), spin_rad_s: (0, 0, 1))],
          {more})"
    ))
}

#[test]
fn mass_damping_lets_a_block_fall_no_faster_than_g_over_a_and_stops_its_spin() {
    let (g, a) = (9.8, 4.0f64);
    let mut simulation = cube(1e-3, "mass_per_s: 4", "gravity_m_s2: (0, 0, -9.8)");
    let start = simulation.sample().unwrap();
    for _ in 0..500 {
        simulation.step().unwrap();
    }
    // v = g/a (1 − e^{−at}), L = L₀ e^{−at}, which each step follows exactly: rounding of 500 steps, fivefold.
    let rounds = 5.0 * rounding(500);
    let (sample, decay) = (simulation.sample().unwrap(), (-a * simulation.time_s()).exp());
    let speed = -sample.momentum.z / 2500.0;
    row("damping", "speed of a fall with drag at 0.5 s [m/s]", speed, Within(g / a * (1.0 - decay), rounds));
    let spin = sample.angular_momentum.z / start.angular_momentum.z;
    row("damping", "spin left by drag", spin, Within(decay, rounds));
    assert!(sample.damping_work_j < 0.0);
    // Momentum is what weight and drag leave of it, to rounding; energy is accounted for.
    let worst = simulation.invariants();
    row("damping", "momentum that drag does not explain", worst.linear_momentum, AtMost(1e-12));
    // Work of drag is a sum over steps: that of the trapezoidal rule would be off by (a Δt)²/12.
    row(
        "damping",
        "energy that drag does not explain",
        worst.energy_gain.max(worst.energy_loss),
        AtMost((a * 1e-3).powi(2) / 12.0),
    );
    for _ in 0..4500 {
        simulation.step().unwrap();
    }
    let speed = -simulation.sample().unwrap().momentum.z / 2500.0;
    row("damping", "speed of a fall with drag in the end [m/s]", speed, Within(g / a, 1e-8));
}

#[test]
fn a_bar_of_much_stiffness_damping_creeps_to_its_strain_as_an_exponential() {
    // K d + b K ḋ = F with next to no inertia: d = F/K (1 − e^{−t/b}), uniform.
    let (b, step_s, strain) = (0.05, 1e-3, 1e5 / YOUNG_PA);
    let mut simulation = simulation(&format!(
        "(title: \"bar\", time: (step_s: {step_s}, end_s: 1),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: {POISSON}, density_kg_m3: 2500, damping: (stiffness_s: {b}))],
          blocks: [(name: \"bar\", material: \"rock\", shape: Box(size_m: (2, 1, 0.5), cells: (4, 2, 1)))],
          supports: [{}],
          tractions: [(block: \"bar\", on: Set(\"x_max\"), traction_pa: (1e5, 0, 0))])",
        rollers("")
    ));
    simulation.sample().unwrap();
    for _ in 0..75 {
        simulation.step().unwrap();
    }
    let reached = strain * (1.0 - (-simulation.time_s() / b).exp());
    let sideways = -POISSON * reached;
    assert_uniform_strain(&simulation, Vec3::new(reached, sideways, sideways), 1e-3);
    // The load has done twice the work that is stored at the end; here it is known at any time, too.
    let sample = simulation.sample().unwrap();
    let lost = sample.load_j + sample.strain_j;
    row("damping", "work of damping in a bar that creeps [J]", sample.damping_work_j, Within(lost, 1e-3));
    // Places are rounded by ε, which is that over the strain of what it stretches.
    let rounds = f64::EPSILON / strain;
    row("damping", "energy gained by a bar that creeps", simulation.invariants().energy_gain, AtMost(rounds));
}

#[test]
fn stiffness_damping_leaves_rigid_motion_alone() {
    let mut simulation = cube(1e-3, "stiffness_s: 1e-3", "");
    let start = simulation.sample().unwrap();
    for _ in 0..1000 {
        simulation.step().unwrap();
    }
    let sample = simulation.sample().unwrap();
    let turned = (sample.angular_momentum - start.angular_momentum).norm() / start.angular_momentum.norm();
    row(
        "damping",
        "kinetic energy of a spin that stiffness damps [J]",
        sample.kinetic_j,
        Within(start.kinetic_j, 1e-6),
    );
    row("damping", "angular momentum lost by it, relative", turned, AtMost(1e-12));
}
