//! Vibrations that steps do not resolve (`coarse_vibration.ron`), against that of a mass on springs.

use ndda::judge::verdict;
use ndda::summary::LabelWord;
use ndda_solver::Simulation;

use super::labelled::{SPEED, summary_of, word};
use crate::evidence::Answer::AtMost;
use crate::evidence::row;
use crate::simulation;

const GRAVITY: f64 = 10.0;
/// Eight springs under 2500 kg: ω² = 8 k/m.
const SPRING_N_M: f64 = 1e9;
const MASS_KG: f64 = 2500.0;

/// A cube that is much harder than the springs at its corners, and that its own weight pulls suddenly.
fn cube(integrator: &str, step_s: f64) -> Simulation {
    simulation(&format!(
        "(title: \"cube\", time: (step_s: {step_s:e}, end_s: 1, integrator: {integrator}),
          gravity_m_s2: ({GRAVITY}, 0, 0),
          materials: [(name: \"rock\", young_pa: 1e16, poisson: 0, density_kg_m3: {MASS_KG})],
          blocks: [(name: \"cube\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
          supports: [(block: \"cube\", on: All, hold: Fixed, by: Springs(stiffness_n_m: {SPRING_N_M:e}))])"
    ))
}

/// Error of the speed in the first radian, or the first step, over its largest; and whether the run calls itself
/// accurate.
fn vibrates(integrator: &str, theta: f64) -> (f64, bool) {
    let rate = (8.0 * SPRING_N_M / MASS_KG).sqrt();
    let largest = GRAVITY / rate;
    let mut simulation = cube(integrator, theta / rate);
    simulation.sample().unwrap();
    let mut worst = 0.0f64;
    for step in 1..=(1.0 / theta).ceil() as u32 {
        simulation.step().unwrap();
        simulation.sample().unwrap();
        let exact = largest * (f64::from(step) * theta).sin();
        worst = worst.max((simulation.state().velocity[0].x - exact).abs() / largest);
    }
    (worst, verdict::label(&simulation, None).word == LabelWord::Accurate)
}

#[test]
fn a_vibration_that_steps_do_not_resolve_says_so() {
    let (mut claimed_wrongly, mut too_modest) = (0, 0);
    for integrator in
        ["Midpoint(theta: 0.5)", "GeneralizedAlpha(radius: 1)", "Newmark(alpha: 0.25, delta: 0.5)"]
    {
        for theta in [0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 2.0, 5.0, 10.0, 100.0] {
            let (error, says) = vibrates(integrator, theta);
            println!("{integrator}, ω Δt = {theta}: error {error:.1e}, accurate {says}");
            claimed_wrongly += u32::from(says && error > SPEED);
            too_modest += u32::from(!says && error < 0.5 * SPEED);
        }
    }
    // The statement: none is, in either direction.
    row(
        "extreme: penalty, step and label",
        "vibrations called accurate that are not",
        f64::from(claimed_wrongly),
        AtMost(0.0),
    );
    row(
        "extreme: penalty, step and label",
        "vibrations called inaccurate that are not by half",
        f64::from(too_modest),
        AtMost(0.0),
    );
}

#[test]
fn a_cantilever_in_steps_of_half_its_period_says_so() {
    for (step, expected) in [("0.1", "inaccurate"), ("1e-3", "inaccurate"), ("2e-4", "accurate")] {
        let summary = summary_of("extreme/coarse_vibration.ron", &[format!("time.step_s={step}")]);
        assert_eq!(word(&summary.unwrap()), expected, "Δt = {step} s");
    }
}

#[test]
fn what_is_only_rounding_is_no_error() {
    let summary = summary_of("extreme/at_rest.ron", &[]);
    let summary = summary.unwrap();
    assert_eq!(word(&summary), "accurate", "{}", summary["label"]["reasons"]);
}
