//! The error of a small block is not hidden by a large one (`small_beside_large.ron`), far away or hit by it.

use ndda::judge::verdict;
use ndda::summary::LabelWord;

use super::labelled::{SPEED, summary_of, word};
use crate::evidence::Answer::{AtLeast, AtMost, Within};
use crate::evidence::row;
use crate::simulation;

/// Speed at which the two meet [m/s].
const CLOSING_M_S: f64 = 5.0;

/// A small cube meets one of `mass_ratio` times its mass, which moves at 20 m/s across: the error of the speed at which they part, over
/// the largest speed, and whether the run calls itself accurate.
fn meeting(integrator: &str, step_s: f64, mass_ratio: f64) -> (f64, bool) {
    let density = 2000.0 * mass_ratio * 0.064 / 19.36;
    let mut simulation = simulation(&format!(
        "(title: \"meeting\", time: (step_s: {step_s:e}, end_s: 1, integrator: {integrator}),
          materials: [
            (name: \"light\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2000),
            (name: \"heavy\", young_pa: {:e}, poisson: 0.25, density_kg_m3: {:e}),
          ],
          blocks: [
            (name: \"small\", material: \"light\", body: Rigid, at_m: (2, 2, 1.02), velocity_m_s: (20, 0, -{CLOSING_M_S}),
             shape: Box(size_m: (0.4, 0.4, 0.4), cells: (1, 1, 1))),
            (name: \"large\", material: \"heavy\", body: Rigid, velocity_m_s: (20, 0, 0),
             shape: Box(size_m: (4.4, 4.4, 1), cells: (1, 1, 1))),
          ],
          contact: Potential(penalty_pa: 2e8, potential: Smooth()))",
        20e9 * density / 2000.0,
        density
    ));
    simulation.sample().unwrap();
    for _ in 0..(0.03 / step_s) as u64 {
        simulation.step().unwrap();
    }
    simulation.sample().unwrap();
    let vertical = |name: &str| {
        let block = simulation.blocks().find(name).unwrap();
        let velocity = &simulation.state().velocity[simulation.blocks().nodes_of(block)];
        simulation.shape(block).operator.center(velocity).z
    };
    let parting = vertical("small") - vertical("large");
    let says = verdict::label(&simulation, None).word == LabelWord::Accurate;
    ((parting / CLOSING_M_S - 1.0).abs() * CLOSING_M_S / 20f64.hypot(CLOSING_M_S), says)
}

#[test]
fn a_small_block_answers_for_its_own_energy() {
    let summary = summary_of("extreme/small_beside_large.ron", &[]);
    let summary = summary.unwrap();
    let gain = summary["verdicts"]["spurious contact energy"]["value"].as_f64().unwrap();
    let leaves = summary["monitors"]["cube"]["velocity"][2].as_f64().unwrap();
    assert_eq!(word(&summary), "inaccurate");
    // Energy that the cube has gained, over m v V: it came at 5 m/s, and nothing is faster than it leaves. Contact of the
    // paper's scheme stores a little more than the cube brought.
    let more = (leaves * leaves - 25.0) / (5.0 * leaves);
    row(
        "extreme: penalty, step and label",
        "energy that a bounce gives a cube beside a block of 2e6 times its mass",
        gain,
        Within(more, 0.1),
    );
    let midpoint = ["time.integrator=Midpoint(theta: 0.5)".to_string()];
    let summary = summary_of("extreme/small_beside_large.ron", &midpoint);
    assert_eq!(word(&summary.unwrap()), "accurate");
}

#[test]
fn whatever_the_masses_of_two_blocks_a_wrong_meeting_is_not_called_accurate() {
    let (mut claimed_wrongly, mut too_modest, mut accurate) = (0, 0, 0);
    for integrator in ["Midpoint(theta: 0.5)", "Newmark(alpha: 0.5, delta: 1)"] {
        for mass_ratio in [1.0, 10.0, 1e3, 1e6, 1e9] {
            for step_s in [1e-5, 5e-5, 2e-4, 5e-4] {
                let (error, says) = meeting(integrator, step_s, mass_ratio);
                println!(
                    "{integrator}, 1:{mass_ratio:e}, Δt = {step_s:e} s: error {error:.1e}, accurate {says}"
                );
                claimed_wrongly += u32::from(says && error > SPEED);
                too_modest += u32::from(!says && error < 0.25 * SPEED);
                accurate += u32::from(says);
            }
        }
    }
    // The statement: none is, in either direction.
    row(
        "extreme: penalty, step and label",
        "meetings of unlike blocks called accurate that are not",
        f64::from(claimed_wrongly),
        AtMost(0.0),
    );
    row(
        "extreme: penalty, step and label",
        "meetings of unlike blocks called inaccurate that are not",
        f64::from(too_modest),
        AtMost(0.0),
    );
    row(
        "extreme: penalty, step and label",
        "meetings of unlike blocks called accurate, of 40",
        f64::from(accurate),
        AtLeast(20.0),
    );
}
