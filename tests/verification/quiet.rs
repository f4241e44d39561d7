//! Quiet boundaries: what they send back, what arrives through them, and what they hold up (Lysmer & Kuhlemeyer 1969).

use std::f64::consts::{PI, TAU};

use ndda_mesh::Vec3;
use ndda_solver::{Settle, Simulation};

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;

const YOUNG_PA: f64 = 20e9;
const DENSITY: f64 = 2650.0;
/// Edge of a cell of columns [m].
const CELL_M: f64 = 1.0;

/// c_p and c_s at ν = ¼ [m/s].
fn speeds() -> (f64, f64) {
    ((1.2 * YOUNG_PA / DENSITY).sqrt(), (0.4 * YOUNG_PA / DENSITY).sqrt())
}

/// A column of cells along z of which the nodes of each level move alike; `more` goes into the scene.
fn column(cells: u32, step_s: f64, mass: &str, more: &str) -> Simulation {
    let height = CELL_M * f64::from(cells);
    let text = format!(
        "(title: \"column\", time: (step_s: {step_s:e}, end_s: 1, mass: {mass}),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: 0.25, density_kg_m3: {DENSITY})],
          blocks: [(name: \"column\", material: \"rock\",
                    shape: Box(size_m: ({CELL_M}, {CELL_M}, {height}), cells: (1, 1, {cells})))],
          ties: [(block: \"column\", on: [All])], {more})"
    );
    let loaded = ndda_io::read::load_text("case.ron", &text, &[], None).unwrap_or_else(|e| panic!("{e}"));
    let folder = std::env::temp_dir();
    let blocks = ndda::build::blocks(&loaded.scene, &folder).unwrap();
    ndda::build::simulation(&loaded.scene, blocks, &folder).unwrap_or_else(|faults| panic!("{faults:?}"))
}

/// Velocity of a level, along an axis.
fn velocity(simulation: &Simulation, z_m: f64, axis: usize) -> f64 {
    let blocks = simulation.blocks();
    let at = |x: &Vec3| ((x + blocks.origin_m).z - z_m).abs() < 1e-6;
    let node = blocks.rest_position.iter().position(at).expect("a level of nodes");
    simulation.state().velocity[node][axis]
}

/// A column under a sine traction at its top, quiet at its foot: amplitudes of the waves down and up, by least squares over a period.
fn reflected(nodes_a_wave: u32, mass: &str) -> f64 {
    let c = speeds().0;
    let cells = 6 * nodes_a_wave;
    let period_s = f64::from(nodes_a_wave) * CELL_M / c;
    let steps_a_period = 40 * nodes_a_wave;
    let step_s = period_s / f64::from(steps_a_period);
    let omega = TAU / period_s;
    // A ramp of three periods, then a steady state.
    let factor: String = (0..=40 * 40)
        .map(|k| f64::from(k) * period_s / 40.0)
        .map(|t| (t, (omega * t).sin() * (1.0 - (PI * (t / (6.0 * period_s)).min(1.0)).cos()) / 2.0))
        .map(|(t, f)| format!("(time_s: {t:e}, factor: {f:e}),"))
        .collect();
    let mut simulation = column(
        cells,
        step_s,
        mass,
        &format!(
            "quiet: [(block: \"column\", on: Set(\"z_min\")), (block: \"column\", on: Set(\"z_max\"))],
             tractions: [(block: \"column\", on: Set(\"z_max\"), traction_pa: (0, 0, 1e6), factor: [{factor}])]"
        ),
    );
    let levels: Vec<f64> = (1..=2 * nodes_a_wave).map(|k| CELL_M * f64::from(k)).collect();
    (0..18 * steps_a_period).for_each(|_| {
        simulation.step().unwrap();
    });
    // Complex amplitude of each level, over one period.
    let mut amplitude = vec![(0.0, 0.0); levels.len()];
    for k in 0..steps_a_period {
        simulation.step().unwrap();
        let phase = TAU * f64::from(k) / f64::from(steps_a_period);
        for (sum, z) in amplitude.iter_mut().zip(&levels) {
            let v = velocity(&simulation, *z, 2);
            *sum = (sum.0 + v * phase.cos(), sum.1 - v * phase.sin());
        }
    }
    let h = omega * CELL_M / c;
    let q = wave_number(h, mass);
    split(&levels, &amplitude, q)
}

/// q h of the mesh at ω h/c: sin(q h/2) = ω h/2c for lumped masses, 6 (1 − cos q h)/(2 + cos q h) = (ω h/c)² for consistent ones.
fn wave_number(h: f64, mass: &str) -> f64 {
    match mass {
        "Lumped" => 2.0 * (0.5 * h).asin() / CELL_M,
        _ => ((6.0 - 2.0 * h * h) / (6.0 + h * h)).acos() / CELL_M,
    }
}

/// |B|/|A| of the best A exp(i q z) + B exp(−i q z): the wave down over which the one up.
fn split(levels: &[f64], amplitude: &[(f64, f64)], q: f64) -> f64 {
    let n = levels.len() as f64;
    let mut cross = (0.0, 0.0);
    let (mut down, mut up) = ((0.0, 0.0), (0.0, 0.0));
    for (z, v) in levels.iter().zip(amplitude) {
        let (c, s) = ((q * z).cos(), (q * z).sin());
        // conj(exp(i q z)) v and conj(exp(−i q z)) v, and the product of the two.
        down = (down.0 + c * v.0 + s * v.1, down.1 + c * v.1 - s * v.0);
        up = (up.0 + c * v.0 - s * v.1, up.1 + c * v.1 + s * v.0);
        cross = (cross.0 + (2.0 * q * z).cos(), cross.1 - (2.0 * q * z).sin());
    }
    // [n x; x̄ n] (A, B) = (down, up).
    let times = |a: (f64, f64), b: (f64, f64)| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
    let (xu, xd) = (times(cross, up), times((cross.0, -cross.1), down));
    let a = (n * down.0 - xu.0, n * down.1 - xu.1);
    let b = (n * up.0 - xd.0, n * up.1 - xd.1);
    b.0.hypot(b.1) / a.0.hypot(a.1)
}

/// |R| at the foot of a mesh with a dashpot ρ c: of A exp(i q z) + B exp(−i q z), the equation of the last node.
fn discrete(nodes_a_wave: u32, mass: &str) -> f64 {
    let h = TAU / f64::from(nodes_a_wave);
    let q = wave_number(h, mass) * CELL_M;
    let (own, other) = if mass == "Lumped" { (0.5, 0.0) } else { (1.0 / 3.0, 1.0 / 6.0) };
    // (1 − own h²) u₀ − (1 + other h²) u₁ + i h u₀ = 0.
    let (a, b) = (1.0 - own * h * h, -(1.0 + other * h * h));
    let size = |sign: f64| (a + b * q.cos()).hypot(h + sign * b * q.sin());
    size(1.0) / size(-1.0)
}

#[test]
fn a_quiet_face_sends_back_what_the_mesh_makes_of_it() {
    for (mass, printed) in
        [("Lumped", [0.0260, 0.00625, 0.00155]), ("Consistent", [0.00836, 0.00206, 0.000515])]
    {
        for (nodes, printed) in [10, 20, 40].into_iter().zip(printed) {
            let exact = discrete(nodes, mass);
            assert!((exact / printed - 1.0f64).abs() < 5e-3, "{mass} {nodes}: {exact}");
        }
        for nodes in [10, 20] {
            row(
                "quiet face",
                &format!("reflected amplitude, normal incidence, {nodes} nodes a wave, {mass} mass"),
                reflected(nodes, mass),
                Within(discrete(nodes, mass), 0.05),
            );
        }
    }
}
