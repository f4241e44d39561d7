//! Blocks that slide on a shaken base as Newmark's sliding block does (Newmark 1965): a pulse, a slope, and a sine.

use std::f64::consts::TAU;

use ndda::shaking::{Slide, slip};
use ndda_mesh::BlockId;

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;
use crate::quiet::with_record;

const G: f64 = 9.81;
/// The promise of docs/verification/verification.md for closed forms: 0.5 %.
const PROMISED: f64 = 5e-3;

/// Slip of a rigid block on a base that dips by `slope_deg` towards x, along the base after each of some steps, under a record of accelerations along
/// a direction.
fn slips(
    (slope_deg, friction_deg): (f64, f64),
    rows: &[(f64, f64)],
    direction: [f64; 2],
    (step_s, steps): (f64, usize),
) -> Vec<f64> {
    let [x, z] = direction;
    // The base turns about its own origin, on its upper face; the block lies in the middle of it.
    let text = format!(
        "(title: \"shaken\", time: (step_s: {step_s:e}, end_s: 1), gravity_m_s2: (0, 0, -{G}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.2, density_kg_m3: 2500)],
          blocks: [
            (name: \"base\", material: \"rock\", body: Fixed, turns: [(axis: (0, 1, 0), angle_deg: {slope_deg})],
             shape: Hexahedron(corners_m: ((-3, -0.5, -0.5), (3, -0.5, -0.5), (3, 0.5, -0.5), (-3, 0.5, -0.5),
                                           (-3, -0.5, 0), (3, -0.5, 0), (3, 0.5, 0), (-3, 0.5, 0)), cells: (6, 1, 1))),
            (name: \"block\", material: \"rock\", body: Rigid, turns: [(axis: (0, 1, 0), angle_deg: {slope_deg})],
             shape: Hexahedron(corners_m: ((-0.2, -0.2, 0), (0.2, -0.2, 0), (0.2, 0.2, 0), (-0.2, 0.2, 0),
                                           (-0.2, -0.2, 0.05), (0.2, -0.2, 0.05), (0.2, 0.2, 0.05), (-0.2, 0.2, 0.05)), cells: (2, 2, 1))),
          ],
          supports: [(block: \"base\", on: All, hold: Shaking([(direction: ({x}, 0, {z}), record: (file: \"quake.csv\"))]))],
          contact: Potential(penalty_pa: 2e9, potential: Smooth(reference_m: 1), friction: (friction_deg: {friction_deg})))"
    );
    let mut simulation = with_record(&text, rows);
    simulation.settle(&ndda_solver::Settle::new(1e-5, 40_000)).unwrap();
    let start = simulation.start_position().to_vec();
    let down = slope_deg.to_radians();
    let moved = |simulation: &ndda_solver::Simulation, block: BlockId| {
        let nodes = simulation.blocks().nodes_of(block);
        let along = nodes.clone().map(|n| {
            let u = simulation.state().position[n] - start[n];
            u.x * down.cos() - u.z * down.sin()
        });
        along.sum::<f64>() / nodes.len() as f64
    };
    (0..steps)
        .map(|_| {
            simulation.step().unwrap();
            moved(&simulation, BlockId(1)) - moved(&simulation, BlockId(0))
        })
        .collect()
}

/// A constant acceleration that begins and ends within a nanosecond.
fn pulse(a: f64, length_s: f64) -> Vec<(f64, f64)> {
    vec![(0.0, a), (length_s, a), (length_s + 1e-9, 0.0)]
}

/// When a slip ends that slows down evenly: the line through half and a tenth of its largest speed meets zero [s].
fn ends_s(found: &[f64], step_s: f64) -> f64 {
    let speeds: Vec<f64> = found.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    let fastest = (0..speeds.len()).max_by(|&a, &b| speeds[a].total_cmp(&speeds[b])).expect("steps");
    let falls_below_s = |part: f64| {
        let slow = (fastest..speeds.len()).find(|&step| speeds[step] < part * speeds[fastest]);
        step_s * (slow.expect("it slows down") as f64 + 1.5)
    };
    let (half_s, tenth_s) = (falls_below_s(0.5), falls_below_s(0.1));
    tenth_s + 0.25 * (tenth_s - half_s)
}

#[test]
fn a_pulse_slides_a_block_on_level_ground() {
    let friction_deg = 0.1f64.atan().to_degrees();
    let rows = pulse(0.3 * G, 0.5);
    let found = slips((0.0, friction_deg), &rows, [1.0, 0.0], (2e-4, 8000));
    row(
        "sliding block",
        "slip, pulse of 0.3 g for 0.5 s, μ 0.1 [m]",
        -found[found.len() - 1],
        Within(0.735750, PROMISED),
    );
    row("sliding block", "end of that slip [s]", ends_s(&found, 2e-4), Within(1.5, PROMISED));
    let exact = slip(&rows, &Slide::Yield(0.1 * G)).last_m;
    assert!((exact + 0.735750).abs() < 1e-6, "{exact}");
}

#[test]
fn a_pulse_slides_a_block_down_a_slope() {
    for (along_slope, exact) in [(false, 0.204775), (true, 0.146524)] {
        // The block is driven down by a base that accelerates against the way down.
        let slope = 20f64.to_radians();
        let direction = if along_slope { [-slope.cos(), slope.sin()] } else { [-1.0, 0.0] };
        let found = slips((20.0, 30.0), &pulse(0.5 * G, 0.2), direction, (2e-4, 3500));
        let which = if along_slope { "along it" } else { "horizontally" };
        let name = format!("slip down a slope of 20°, φ 30°, shaken {which} by 0.5 g for 0.2 s [m]");
        row("sliding block", &name, found[found.len() - 1], Within(exact, PROMISED));
        if !along_slope {
            row(
                "sliding block",
                "end of that slip down a slope [s]",
                ends_s(&found, 2e-4),
                Within(0.567128, PROMISED),
            );
        }
    }
}

#[test]
fn a_sine_slides_a_block_to_and_fro_and_brings_it_back() {
    let a = |t: f64| 0.5 * G * (2.0 * TAU * t).sin();
    let rows: Vec<_> = (0..=4000).map(|i| 2.5e-4 * f64::from(i)).map(|t| (t, a(t))).collect();
    let friction_deg = 0.3f64.atan().to_degrees();
    let found = slips((0.0, friction_deg), &rows, [1.0, 0.0], (1e-4, 5500));
    let farthest = found.iter().copied().fold(0.0, f64::min);
    row(
        "sliding block",
        "farthest slip, sine of 0.5 g and 2 Hz, μ 0.3 [mm]",
        1e3 * farthest,
        Within(-24.4878, PROMISED),
    );
    row("sliding block", "slip after it has come back [m]", found[5450].abs(), AtMost(1e-5));
}
