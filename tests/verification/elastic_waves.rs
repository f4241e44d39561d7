//! Waves along bars without lateral strain (ν = 0): their speed, what a joint lets through, and a bar that hits
//! a wall (Doyen, Ern & Piperno 2011).

use std::f64::consts::PI;

use ndda_mesh::BlockId;
use ndda_solver::Simulation;

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;
use crate::simulation;

const YOUNG_PA: f64 = 20e9;
const DENSITY: f64 = 2500.0;
/// Edge of a cell, and of the bars' square section [m].
const CELL_M: f64 = 0.02;

fn speed() -> f64 {
    (YOUNG_PA / DENSITY).sqrt()
}

fn impedance() -> f64 {
    DENSITY * speed()
}

/// Bars of `cells` cells one behind the other along x; `more` goes into the scene.
fn bars(step_s: f64, cells: &[u32], velocity_m_s: f64, more: &str) -> Simulation {
    let (mut blocks, mut at) = (String::new(), 0.0);
    for (index, &n) in cells.iter().enumerate() {
        let length = CELL_M * f64::from(n);
        blocks += &format!(
            "(name: \"bar_{index}\", material: \"rock\", at_m: ({at}, 0, 0), velocity_m_s: ({velocity_m_s}, 0, 0),
              shape: Box(size_m: ({length}, {CELL_M}, {CELL_M}), cells: ({n}, 1, 1), pattern: TwentyFour)),"
        );
        at += length;
    }
    simulation(&format!(
        "(title: \"bars\", time: (step_s: {step_s:e}, end_s: 1),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: 0, density_kg_m3: {DENSITY})],
          blocks: [{blocks} {WALL}], {more})"
    ))
}

/// Far away unless a bar flies at it: contact must have something to be with.
const WALL: &str = "(name: \"wall\", material: \"rock\", body: Fixed, at_m: (-0.1, -0.04, -0.04),
    shape: Box(size_m: (0.1, 0.1, 0.1), cells: (1, 1, 1)))";

/// A pulse of pressure on the x = 0 face of the first bar: `1 + cos` over `length_s`, as a table.
fn pulse(pressure_pa: f64, length_s: f64) -> String {
    let mut factor = String::new();
    for k in 0..=200 {
        let t = f64::from(k) / 200.0;
        factor +=
            &format!("(time_s: {:e}, factor: {:e}), ", t * length_s, 0.5 * (1.0 - (2.0 * PI * t).cos()));
    }
    format!(
        "tractions: [(block: \"bar_0\", on: Plane(point_m: (0, 0, 0), normal: (1, 0, 0)),
                      traction_pa: ({pressure_pa:e}, 0, 0), factor: [{factor}])]"
    )
}

/// Nodes of a section, by where it is at rest.
fn section(simulation: &Simulation, x_m: f64) -> Vec<usize> {
    let blocks = simulation.blocks();
    let places = blocks.rest_position.iter().map(|x| (x + blocks.origin_m).x);
    let near = |(node, x): (usize, f64)| ((x - x_m).abs() < 0.1 * CELL_M).then_some(node);
    places.enumerate().filter_map(near).collect()
}

fn mean_velocity(simulation: &Simulation, nodes: &[usize]) -> f64 {
    nodes.iter().map(|&n| simulation.state().velocity[n].x).sum::<f64>() / nodes.len() as f64
}

#[test]
fn a_wave_runs_along_a_bar_at_its_speed() {
    let step_s = 0.25 * CELL_M / speed();
    let (length_s, pressure) = (0.6 / speed(), 1e6);
    let contact = "contact: Potential(penalty_pa: 1e9)";
    let mut simulation = bars(step_s, &[150], 0.0, &format!("{contact}, {}", pulse(pressure, length_s)));
    let stations = [1.0, 2.0].map(|x| section(&simulation, x));
    // Moments of the pulse at each station: how much passes, and when on average.
    let mut passed = [(0.0, 0.0); 2];
    for step in 0..(2.9 / (speed() * step_s)) as u32 {
        simulation.step().unwrap();
        for (sums, nodes) in passed.iter_mut().zip(&stations) {
            let v = mean_velocity(&simulation, nodes);
            *sums = (sums.0 + v, sums.1 + v * f64::from(step + 1) * step_s);
        }
    }
    let [first, second] = passed.map(|(sum, moment)| moment / sum);
    let measured = 1.0 / (second - first);
    // A wave as short as the pulse, k = 2π/0.6 m, is off by (k h)²/24 in this mesh; the mean of its moments is hardly off.
    let dispersion = (2.0 * PI / 0.6 * CELL_M).powi(2) / 24.0;
    row("elastic waves", "speed of a P-wave along a bar [m/s]", measured, Within(speed(), dispersion));
    // v = p/(ρ c), so its integral over time is that of the pressure.
    let impulse = 0.5 * length_s * pressure / impedance();
    row("elastic waves", "∫ v dt of the pulse [m]", passed[1].0 * step_s, Within(impulse, dispersion));
}

/// Wave transmitted by a joint of stiffness k [Pa/m] for an incident wave of velocity v(t): v_T′ = (2 k/ρ c)(v − v_T), so that
/// |T| = 1/√(1 + (ω ρ c/2k)²) for waves of one frequency.
fn transmitted(incident: impl Fn(f64) -> f64, stiffness_pa_m: f64, end_s: f64) -> impl Fn(f64) -> f64 {
    let rate = 2.0 * stiffness_pa_m / impedance();
    let steps = 20_000;
    let dt = end_s / f64::from(steps);
    let mut history = vec![0.0];
    for k in 0..steps {
        let v = history[k as usize];
        let middle = incident((f64::from(k) + 0.5) * dt);
        // Exact for an incident wave that is constant within the small step.
        history.push(middle + (v - middle) * (-rate * dt).exp());
    }
    move |t: f64| if t <= 0.0 { 0.0 } else { history[((t / dt) as usize).min(history.len() - 1)] }
}

#[test]
fn a_joint_lets_through_what_its_stiffness_allows() {
    let (length_s, pressure) = (0.6 / speed(), 1e6);
    let step_s = 0.25 * CELL_M / speed();
    for part in [0.3, 1.0, 3.0] {
        // k such that ω ρ c/2k = part, by the pulse's own frequency.
        let stiffness = PI / length_s * impedance() / part;
        let reference_m = 0.1;
        let penalty = 0.5 * stiffness * reference_m;
        let contact = format!(
            "contact: Potential(penalty_pa: {penalty:e}, potential: Smooth(reference_m: {reference_m}))"
        );
        let mut simulation =
            bars(step_s, &[60, 100], 0.0, &format!("{contact}, {}", pulse(pressure, length_s)));
        let station = section(&simulation, 2.0);
        let amplitude = pressure / impedance();
        let incident = |t: f64| {
            if t < length_s { 0.5 * amplitude * (1.0 - (2.0 * PI * t / length_s).cos()) } else { 0.0 }
        };
        let end_s = 3.0 / speed();
        let exact = transmitted(incident, stiffness, end_s);
        let (mut error, mut peak, mut largest) = (0.0f64, 0.0f64, 0.0f64);
        for step in 0..(end_s / step_s) as u32 {
            simulation.step().unwrap();
            let v = mean_velocity(&simulation, &station);
            let expected = exact(f64::from(step + 1) * step_s - 2.0 / speed());
            error = error.max((v - expected).abs());
            (peak, largest) = (peak.max(v), largest.max(expected));
        }
        let named = |what: &str| format!("{what}, over the incident wave, ωρc/2k = {part}");
        row(
            "joint between bars",
            &named("peak of what a joint lets through"),
            peak / amplitude,
            Within(largest / amplitude, 5e-3),
        );
        row(
            "joint between bars",
            &named("largest difference from the joint's equation"),
            error / amplitude,
            AtMost(0.02),
        );
    }
}

#[test]
fn a_bar_leaves_a_wall_after_its_wave_has_run_there_and_back() {
    let (cells, reference_m) = (50, CELL_M);
    let length = CELL_M * f64::from(cells);
    let step_s = 0.05 * CELL_M / speed();
    let contact = format!(
        "contact: Potential(penalty_pa: {YOUNG_PA:e}, potential: Smooth(reference_m: {reference_m}))"
    );
    let mut simulation = bars(step_s, &[cells], -1.0, &contact);
    let operator_momentum = |simulation: &Simulation| {
        simulation
            .shape(BlockId(0))
            .operator
            .momentum(&simulation.state().velocity[simulation.blocks().nodes_of(BlockId(0))])
            .x
    };
    let area = CELL_M * CELL_M;
    let (there_and_back, plateau) = (2.0 * length / speed(), impedance() * 1.0);
    let (mut pressed_s, mut pressure, mut count) = (0.0, 0.0, 0);
    let steps = (1.5 * there_and_back / step_s) as u32;
    let mut before = operator_momentum(&simulation);
    for step in 0..steps {
        simulation.step().unwrap();
        let after = operator_momentum(&simulation);
        let p = (after - before) / (step_s * area);
        before = after;
        if p > 0.5 * plateau {
            pressed_s += step_s;
        }
        let part = f64::from(step) * step_s / there_and_back;
        if (0.2..0.8).contains(&part) {
            (pressure, count) = (pressure + p, count + 1);
        }
    }
    let (pressure, rebound) = (pressure / f64::from(count), before / (DENSITY * area * length));
    row("bar on a wall", "time that a bar presses on a wall [s]", pressed_s, Within(there_and_back, 0.02));
    row("bar on a wall", "pressure of a bar on a wall [Pa]", pressure, Within(plateau, 5e-3));
    row("bar on a wall", "rebound of a bar from a wall over its speed", rebound, Within(1.0, 0.02));
}
