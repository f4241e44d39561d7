//! Loads and motions that come and go between two steps (`pulse_between_steps.ron`).

use ndda::judge::verdict;
use ndda::summary::LabelWord;
use ndda_solver::Simulation;

use super::labelled::{SPEED, summary_of, word};
use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::{rounding, row};
use crate::simulation;

const STEP_S: f64 = 1e-3;
/// Speed that a push gives a cube [m/s].
const SPEED_M_S: f64 = 2.0;

/// A cube of 1 m of which a force makes 1 m/s² at a factor of one, and the state after 0.1 s.
fn pushed(integrator: &str, body: &str, rows: &[(f64, f64)]) -> Simulation {
    let rows: String = rows.iter().map(|(t, f)| format!("(time_s: {t:e}, factor: {f:e}),")).collect();
    run(&format!(
        "(title: \"push\", time: (step_s: {STEP_S:e}, end_s: 1, integrator: {integrator}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
          blocks: [(name: \"cube\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
          forces: [(block: \"cube\", force_n: (2500, 0, 0), factor: [{rows}])])"
    ))
}

fn run(text: &str) -> Simulation {
    let mut simulation = simulation(text);
    simulation.sample().unwrap();
    for _ in 0..100 {
        simulation.step().unwrap();
        simulation.sample().unwrap();
    }
    simulation
}

fn is_accurate(simulation: &Simulation) -> bool {
    verdict::label(simulation, None).word == LabelWord::Accurate
}

#[test]
fn a_push_brings_its_impulse_however_short_it_is() {
    let mut worst = 0.0f64;
    for integrator in
        ["Midpoint(theta: 0.5)", "Newmark(alpha: 0.5, delta: 1)", "GeneralizedAlpha(radius: 0.8)"]
    {
        for width in [0.001, 0.01, 0.1, 0.5, 1.0, 2.0, 10.0] {
            for begins in [0.02013, 0.0205, 0.0209] {
                let (middle, end) = (begins + 0.5 * width * STEP_S, begins + width * STEP_S);
                let height = SPEED_M_S / (0.5 * (end - begins));
                let rows = [(0.0, 0.0), (begins, 0.0), (middle, height), (end, 0.0)];
                let simulation = pushed(integrator, "Rigid", &rows);
                let speed = simulation.state().velocity[0].x;
                worst = worst.max((speed / SPEED_M_S - 1.0).abs());
                // The last remembers accelerations: what a push leaves of them takes some steps to die out.
                let remembers = integrator.starts_with("Gen");
                assert!(remembers || is_accurate(&simulation), "{integrator}, {width} steps wide");
            }
        }
    }
    // The impulse of a table is summed exactly: rounding of 100 steps, twentyfold.
    let rounds = 20.0 * rounding(100);
    row("extreme: penalty, step and label", "speed after a push of 0.001 to 10 steps", worst, AtMost(rounds));
    let summary = summary_of("extreme/pulse_between_steps.ron", &[]);
    let summary = summary.unwrap();
    let speed = summary["monitors"]["cube"]["velocity"][0].as_f64().unwrap();
    row(
        "extreme: penalty, step and label",
        "a push between two steps [m/s]",
        speed,
        Within(1e4 / 2650.0, rounds),
    );
    assert_eq!(word(&summary), "accurate");
}

#[test]
fn what_comes_and_goes_within_a_step_says_so() {
    let (mut claimed_wrongly, mut too_modest) = (0, 0);
    for period in [0.02, 0.1, 0.25, 1.0 / 3.0, 0.5] {
        for speed_m_s in [1e-3, 0.1] {
            // There and back, then one push of 1 m/s over ten steps.
            let (quarter, height) = (0.25 * period * STEP_S, 4.0 * speed_m_s / (period * STEP_S));
            let mut rows = vec![(0.02, 0.0)];
            for k in 0..(2.0 / period) as u32 {
                let start = 0.02 + f64::from(4 * k) * quarter;
                rows.extend([
                    (start + quarter, height),
                    (start + 3.0 * quarter, -height),
                    (start + 4.0 * quarter, 0.0),
                ]);
            }
            rows.extend([(0.05, 0.0), (0.055, 200.0), (0.06, 0.0)]);
            let says = is_accurate(&pushed("Midpoint(theta: 0.5)", "Rigid", &rows));
            println!("{speed_m_s} m/s there and back in {period} of a step: accurate {says}");
            claimed_wrongly += u32::from(says && speed_m_s > SPEED);
            too_modest += u32::from(!says && speed_m_s < SPEED);
        }
    }
    // The statement: none is, in either direction.
    row(
        "extreme: penalty, step and label",
        "loads within a step called accurate that are not",
        f64::from(claimed_wrongly),
        AtMost(0.0),
    );
    row(
        "extreme: penalty, step and label",
        "loads within a step called inaccurate that are not",
        f64::from(too_modest),
        AtMost(0.0),
    );
}

#[test]
fn a_motion_there_and_back_within_a_step_says_so() {
    let moved = |there_s: f64| {
        run(&format!(
            "(title: \"moved\", time: (step_s: {STEP_S:e}, end_s: 1),
              materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
              blocks: [(name: \"cube\", material: \"rock\", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
              supports: [(block: \"cube\", on: All, hold: Motion([
                (time_s: 0, displacement_m: (0, 0, 0)), (time_s: 0.0201, displacement_m: (0, 0, 0)),
                (time_s: {:e}, displacement_m: (0.01, 0, 0)), (time_s: {:e}, displacement_m: (0, 0, 0)),
              ]))])",
            0.0201 + there_s,
            0.0201 + 2.0 * there_s
        ))
    };
    assert!(is_accurate(&moved(0.02)));
    let unseen = moved(2e-4);
    assert!(!is_accurate(&unseen));
    let reasons = verdict::label(&unseen, None).reasons.join(", ");
    assert!(reasons.contains("within a step"), "{reasons}");
}
