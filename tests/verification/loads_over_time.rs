//! Loads that change over time: closed forms of ramped gravity, and the energy that they bring.

use ndda_mesh::Vec3;

use crate::evidence::Answer::{AtMost, Near, Within};
use crate::evidence::{rounding, row};
use crate::{YOUNG_PA, bar, rollers, simulation};

#[test]
fn under_gravity_that_grows_a_block_falls_by_the_cube_of_time() {
    // a = g t/T: v = g t²/2T, x = g t³/6T until T.
    let (step_s, ramp_s, g) = (1e-3, 0.5, 9.8);
    let mut simulation = simulation(&format!(
        "(title: \"fall\", time: (step_s: {step_s}, end_s: 1), gravity_m_s2: (0, 0, -{g}), gravity_ramp_s: {ramp_s},
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
          blocks: [(name: \"block\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))])"
    ));
    simulation.sample().unwrap();
    for _ in 0..500 {
        simulation.step().unwrap();
    }
    let t = simulation.time_s();
    let fallen = simulation.blocks().rest_position[0].z - simulation.state().position[0].z;
    // The middle of each step has its mean force: only the distance within a step is off, by g Δt² t/12T.
    let exact = g * t.powi(3) / (6.0 * ramp_s);
    let misses = 1.01 * g * step_s * step_s * t / (12.0 * ramp_s);
    row("loads", "fall under gravity that grows [m]", fallen, Near(exact, misses));
    let sample = simulation.sample().unwrap();
    row("loads", "kinetic energy of that fall [J]", sample.kinetic_j, Within(sample.load_work_j, 1e-12));
    row(
        "loads",
        "momentum of it [kg m/s]",
        sample.momentum.z,
        Within(-g * 0.5 * t * t / ramp_s * 2500.0, 1e-12),
    );
}

#[test]
fn a_slow_pull_brings_half_the_force_times_the_way() {
    // Ramped over twenty periods of the bar it hardly swings; W = ½ F u.
    let traction_pa = 1e5;
    let mut simulation = bar(
        "",
        &rollers(""),
        &format!(
            "tractions: [(block: \"bar\", on: Set(\"x_max\"), traction_pa: ({traction_pa}, 0, 0),
                          factor: [(time_s: 0, factor: 0), (time_s: 0.08, factor: 1)])]"
        ),
    );
    simulation.sample().unwrap();
    for _ in 0..600 {
        simulation.step().unwrap();
    }
    let sample = simulation.sample().unwrap();
    let stored = 0.5 * traction_pa * traction_pa / YOUNG_PA;
    row("loads", "energy stored by a slow pull [J]", sample.strain_j, Within(stored, 1e-3));
    row("loads", "work of a slow pull [J]", sample.load_work_j, Within(stored, 2e-2));
}

#[test]
fn a_force_that_comes_and_goes_leaves_its_impulse() {
    // A triangle of 0.1 s and 1 kN on one corner: ½ · 0.1 · 1000 kg m/s, wherever it pushes.
    let mut simulation = simulation(
        "(title: \"push\", time: (step_s: 1e-3, end_s: 1),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
          blocks: [(name: \"block\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
          forces: [(block: \"block\", at_m: (1, 1, 1), force_n: (0, 1e3, 0),
                    factor: [(time_s: 0.1, factor: 0), (time_s: 0.15, factor: 1), (time_s: 0.2, factor: 0)])])",
    );
    simulation.sample().unwrap();
    for _ in 0..300 {
        simulation.step().unwrap();
    }
    let sample = simulation.sample().unwrap();
    let off = (sample.momentum - Vec3::new(0.0, 50.0, 0.0)).norm();
    // The impulse of a table is summed exactly: rounding of 300 steps, twofold, of 50 kg m/s.
    let rounds = 2.0 * rounding(300) * 50.0;
    row("loads", "momentum off what a push of 50 kg m/s leaves [kg m/s]", off, AtMost(rounds));
    row("loads", "kinetic energy of that push [J]", sample.kinetic_j, Within(sample.load_work_j, 1e-4));
    let worst = simulation.invariants();
    row("loads", "momentum of it", worst.linear_momentum, AtMost(rounding(300)));
    row("loads", "angular momentum of it", worst.angular_momentum, AtMost(rounding(300)));
}

#[test]
fn a_force_on_blocks_by_pattern_pushes_each_through_its_mass_centre() {
    let mut simulation = simulation(
        "(title: \"push\", time: (step_s: 1e-3, end_s: 1), contact: Off,
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
          blocks: [(name: \"free\", material: \"rock\", at_m: (9, 0, 0), shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
          rock: [(material: \"rock\", fill: Centre, domain: Box(min_m: (0, 0, 0), max_m: (3, 2, 1)),
                  joints: [Plane(name: \"j\", dip_deg: 60, dip_direction_deg: 90, point_m: (1, 0, 0))])],
          forces: [(block: \"rock_*\", force_n: (600, 0, 300)), (block: \"rock_*\", at_m: (0, 0, 0), force_n: (0, 100, 0))])",
    );
    for _ in 0..100 {
        simulation.step().unwrap();
    }
    let (state, blocks) = (simulation.state(), simulation.blocks());
    let momenta: Vec<(Vec3, Vec3)> = blocks
        .ids()
        .map(|block| {
            let mass = &simulation.shape(block).operator.node_mass;
            let nodes = blocks.nodes_of(block);
            let (x, v) = (&state.position[nodes.clone()], &state.velocity[nodes]);
            let whole: f64 = mass.iter().sum();
            let center = mass.iter().zip(x).map(|(&m, x)| m * x).sum::<Vec3>() / whole;
            let linear = mass.iter().zip(v).map(|(&m, v)| m * v).sum();
            (linear, mass.iter().zip(x).zip(v).map(|((&m, x), v)| (x - center).cross(&(m * v))).sum())
        })
        .collect();
    assert_eq!(momenta[0], (Vec3::zeros(), Vec3::zeros()));
    for (linear, angular) in &momenta[1..] {
        let off = linear - Vec3::new(60.0, 0.0, 30.0);
        assert!(off.x.abs().max(off.z.abs()) < 1e-9, "{linear:?}");
        assert!(linear.y.abs() > 1e-9 || angular.norm() < 1e-6, "{angular:?}");
    }
    let sideways: Vec<f64> = momenta[1..].iter().map(|(linear, _)| linear.y).collect();
    // Only the block that has the point takes the force that acts there.
    assert!(
        sideways.iter().any(|y| (y - 10.0).abs() < 1e-9) && sideways.iter().any(|y| y.abs() < 1e-9),
        "{sideways:?}"
    );
}

/// A cube of one cell has no node where the force acts.
#[test]
fn a_force_on_a_point_without_a_node_turns_a_cube_about_its_mass_centre_as_it_should() {
    for at in [Vec3::new(0.5, 1.0, 0.25), Vec3::new(0.3, 0.6, 0.9)] {
        let mut simulation = simulation(&format!(
            "(title: \"turned\", time: (step_s: 1e-4, end_s: 1), contact: Off,
              materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 6000)],
              blocks: [(name: \"free\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
              forces: [(block: \"free\", at_m: ({}, {}, {}), force_n: (30, -20, 10))])",
            at.x, at.y, at.z
        ));
        const STEPS: u32 = 10;
        for _ in 0..STEPS {
            simulation.step().unwrap();
        }
        simulation.sample().unwrap();
        let moment = (at - Vec3::new(0.5, 0.5, 0.5)).cross(&Vec3::new(30.0, -20.0, 10.0));
        let wanted = moment * 1e-4 * f64::from(STEPS);
        let mass = &simulation.shape(ndda_mesh::BlockId(0)).operator.node_mass;
        let (x, v) = (&simulation.state().position, &simulation.state().velocity);
        // Of a cube that hardly turned: I = m/6.
        let whole: f64 = mass.iter().sum();
        let center = x.iter().sum::<Vec3>() / x.len() as f64;
        let mean = v.iter().sum::<Vec3>() / v.len() as f64;
        // ∑ r × v over the corners of a unit cube is 4 ω.
        let spin = x.iter().zip(v).map(|(x, v)| (x - center).cross(&(v - mean))).sum::<Vec3>() / 4.0;
        let found = spin * whole / 6.0;
        assert!((found - wanted).norm() < 1e-6 * wanted.norm(), "{at:?}: {found:?}, not {wanted:?}");
    }
}
