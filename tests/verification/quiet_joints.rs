//! Waves through joints between quiet ends: transmission and lag of one joint, and the long-wave speed of many.

use std::f64::consts::TAU;

use ndda_solver::Settle;

use crate::evidence::Answer::{Near, Within};
use crate::evidence::row;
use crate::quiet::{CELL_M, Complex, DENSITY, YOUNG_PA, pulse, speeds, split, wave_number, with_record};

const NODES_A_WAVE: u32 = 40;
/// Overlap with which the columns begin [m].
const PRESSED_M: f64 = 5e-4;

/// Wave up beyond a joint of stiffness k over that below it, with x = ω ρ c/2k.
fn transmitted(x: f64) -> Complex {
    let c = speeds().0;
    let period_s = f64::from(NODES_A_WAVE) * CELL_M / c;
    let omega = TAU / period_s;
    let stiffness = omega * DENSITY * c / (2.0 * x);
    // p = 2 k_n h/L₀ of the potential `Smooth`.
    let (reference_m, penalty) = (1.0, 0.5 * stiffness);
    let cells = NODES_A_WAVE;
    let height = f64::from(cells) * CELL_M;
    let block = |name: &str, z: f64| {
        format!(
            "(name: \"{name}\", material: \"rock\", at_m: (0, 0, {z}),
               shape: Box(size_m: ({CELL_M}, {CELL_M}, {height}), cells: (1, 1, {cells}))),"
        )
    };
    // A velocity 0.001 sin ωt, grown over three periods; the columns settle pressed together, so that the joint stays closed.
    let grown = |t: f64| (t / (3.0 * period_s)).min(1.0);
    let a = |t: f64| 0.001 * omega * (omega * t).cos() * grown(t);
    let rows: Vec<(f64, f64)> =
        (0..=200 * 12).map(|k| f64::from(k) / 200.0 * period_s).map(|t| (t, a(t))).collect();
    let steps_a_period = 320;
    let step_s = period_s / f64::from(steps_a_period);
    let text = format!(
        "(title: \"joint\", time: (step_s: {step_s:e}, end_s: 1),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: 0.25, density_kg_m3: {DENSITY})],
          blocks: [{} {}],
          ties: [(block: \"lower\", on: [All]), (block: \"upper\", on: [All])],
          quiet: [(block: \"lower\", on: Set(\"z_min\"), incident: [(wave: P, record: (file: \"quake.csv\"))]),
                  (block: \"upper\", on: Set(\"z_max\"))],
          contact: Potential(penalty_pa: {penalty:e}, potential: Smooth(reference_m: {reference_m})))",
        block("lower", 0.0),
        block("upper", height - PRESSED_M)
    );
    let mut simulation = with_record(&text, &rows);
    simulation.settle(&Settle::new(1e-6, 100_000)).unwrap();
    for _ in 0..6 * steps_a_period {
        simulation.step().unwrap();
    }
    let origin = simulation.blocks().origin_m;
    let places: Vec<f64> = simulation.blocks().rest_position.iter().map(|x| (x + origin).z).collect();
    // One node of each level but those at the ends.
    let of_block = |name: &str| {
        let nodes = simulation.blocks().nodes_of(simulation.blocks().find(name).unwrap());
        let foot = nodes.clone().map(|n| places[n]).fold(f64::INFINITY, f64::min);
        let inner = |n: &usize| (1.5..height - 1.5).contains(&(places[*n] - foot));
        nodes.filter(inner).step_by(4).collect::<Vec<_>>()
    };
    let sides = [of_block("lower"), of_block("upper")];
    let mut amplitude = sides.clone().map(|nodes| vec![(0.0, 0.0); nodes.len()]);
    for k in 0..steps_a_period {
        simulation.step().unwrap();
        let phase = TAU * f64::from(k) / f64::from(steps_a_period);
        for (nodes, sums) in sides.iter().zip(&mut amplitude) {
            for (n, sum) in nodes.iter().zip(sums) {
                let v = simulation.state().velocity[*n].z;
                *sum = (sum.0 + v * phase.cos(), sum.1 - v * phase.sin());
            }
        }
    }
    let q = wave_number(omega * CELL_M / c, "Consistent");
    let [below, beyond] = [0, 1].map(|i| {
        let levels: Vec<f64> = sides[i].iter().map(|n| places[*n]).collect();
        split(&levels, &amplitude[i], q).1
    });
    let size = below.0 * below.0 + below.1 * below.1;
    ((beyond.0 * below.0 + beyond.1 * below.1) / size, (beyond.1 * below.0 - beyond.0 * below.1) / size)
}

#[test]
fn a_joint_lets_a_sine_through_with_the_size_and_lag_of_its_closed_form() {
    for (x, printed, lag) in [(0.5f64, 0.894427, 26.565), (1.0, 0.5f64.sqrt(), 45.0), (2.0, 0.447214, 63.435)]
    {
        let exact = 1.0 / (1.0 + x * x).sqrt();
        assert!((exact - printed).abs() < 1e-6 && (x.atan().to_degrees() - lag).abs() < 1e-3);
        let (real, imaginary) = transmitted(x);
        let name = |what: &str| format!("{what}, ωρc/2k = {x}");
        row("joint under a sine", &name("transmitted amplitude"), real.hypot(imaginary), Within(exact, 1e-3));
        let found = -imaginary.atan2(real).to_degrees();
        row("joint under a sine", &name("lag [°]"), found, Near(x.atan().to_degrees(), 0.1));
    }
}

#[test]
fn long_waves_run_through_many_joints_at_the_speed_of_the_rock_mass() {
    let (modulus, density, joint, spacing) = (24e9, 2650.0, 10e9, 1.0);
    let mass_modulus: f64 = 1.0 / (1.0 / modulus + 1.0 / (joint * spacing));
    let exact = (mass_modulus / density).sqrt();
    assert!((exact - 1632.09).abs() < 5e-3, "{exact}");
    let (blocks, length_m) = (150, 100.0);
    let length_s = length_m / exact;
    let boxes: String = (0..blocks)
        .map(|k| {
            format!(
                "(name: \"b{k}\", material: \"rock\", at_m: (0, 0, {k}), shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),"
            )
        })
        .collect();
    // ν = 0, so that blocks need no sides: E is the modulus of waves.
    let text = format!(
        "(title: \"joints\", time: (step_s: 5e-5, end_s: 1),
          materials: [(name: \"rock\", young_pa: {modulus:e}, poisson: 0, density_kg_m3: {density})],
          blocks: [{boxes}],
          quiet: [(block: \"b0\", on: Set(\"z_min\"), incident: [(wave: P, record: (file: \"quake.csv\"))])],
          contact: Potential(penalty_pa: {:e}, potential: Smooth(reference_m: 1)))",
        0.5 * joint
    );
    let mut simulation = with_record(&text, &pulse(length_s));
    let stations = [20u32, 60].map(|k| simulation.blocks().nodes_of(ndda_mesh::BlockId(k)));
    let mut passed = [(0.0, 0.0); 2];
    for step in 1..=((length_m + 75.0) / exact / 5e-5) as u32 {
        simulation.step().unwrap();
        for (sums, nodes) in passed.iter_mut().zip(&stations) {
            let v = nodes.clone().map(|n| simulation.state().velocity[n].z).sum::<f64>();
            *sums = (sums.0 + v, sums.1 + v * f64::from(step) * 5e-5);
        }
    }
    let [first, second] = passed.map(|(sum, moment)| moment / sum);
    row("many joints", "speed of a long P wave [m/s]", 40.0 / (second - first), Within(exact, 1e-3));
}

/// No length of the step lets quiet faces feed a column that vibrates in all its modes, by so little that its turning does not matter; with `Midpoint` its energy
/// falls in each step.
#[test]
fn quiet_faces_never_feed_a_column_whatever_the_step() {
    let cells = 20;
    for integrator in ["Midpoint()", "GeneralizedAlpha()", "Newmark(alpha: 0.25, delta: 0.5)"] {
        for courant in [0.3, 3.0, 300.0] {
            let step_s = courant * CELL_M / speeds().0;
            let text = format!(
                "(title: \"column\", time: (step_s: {step_s:e}, end_s: 1, integrator: {integrator}),
                  materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: 0.25, density_kg_m3: {DENSITY})],
                  blocks: [(name: \"column\", material: \"rock\", shape: Box(size_m: (1, 1, {cells}), cells: (1, 1, {cells})))],
                  quiet: [(block: \"column\", on: Set(\"z_min\")), (block: \"column\", on: Set(\"z_max\"))])"
            );
            let mut simulation = with_record(&text, &[]);
            let rest = simulation.blocks().rest_position.clone();
            let push = rest.iter().enumerate().map(|(i, x)| {
                ndda_mesh::Vec3::new((3.0 * x.z).sin(), (7.0 * i as f64).cos(), (0.4 * x.z).sin()) * 1e-6
            });
            simulation.push(&push.collect::<Vec<_>>());
            let mut last = simulation.sample().unwrap();
            let (first_j, mut rises) = (last.total_j(), 0.0f64);
            // Integrators that remember accelerations overshoot at first: a push does not tell them of any.
            let mut most_j = [0.0f64; 2];
            for step in 0..300 {
                simulation.step().unwrap();
                let sample = simulation.sample().unwrap();
                rises = rises.max(sample.total_j() - last.total_j());
                most_j[step / 150] = most_j[step / 150].max(sample.total_j());
                last = sample;
            }
            assert!(most_j[1] <= most_j[0], "{integrator}, {courant}: from {} to {}", most_j[0], most_j[1]);
            if integrator == "Midpoint()" {
                assert!(rises < 1e-6 * first_j, "{courant}: {rises} of {first_j}");
                assert!(last.balance_j.abs() < 1e-4 * first_j, "{courant}: {last:?}");
                assert!((first_j - last.total_j() - last.radiated_j).abs() < 1e-4 * first_j);
            }
        }
    }
}
