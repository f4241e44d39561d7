//! Bolts that stages of construction install and release: what the rock did before strains nothing of them.

use ndda::Model;
use ndda::run::{Outcome, Run};
use ndda::summary::LabelWord;

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::{rounding, row};

const EA_N: f64 = 98.6e9 * 181e-6;
const BOND_N_M2: f64 = 112e6;
const BOLT: &str = "steel: (young_pa: 98.6e9, area_m2: SquareMillimetre(181)), plate: (), grout: (stiffness_n_m2: 112e6, strength_n_m: 1.75e6, from_m: 1)";
const ROCK: &str = "materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)]";
const GRAVITY: f64 = 9.81;
const WEIGHT_N: f64 = 2600.0 * GRAVITY;

/// A block of 1 m³ above another, and a bolt from its top that is free in it and bonded in 2 m of the lower one.
fn scene(top: &str, pretension: &str, rest: &str) -> Outcome {
    run(&format!(
        "(title: \"bolt in a stage\", {ROCK},
          blocks: [
            (name: \"below\", material: \"rock\", body: Fixed, shape: Box(size_m: (1, 1, 2), cells: (1, 1, 2)), at_m: (0, 0, -2)),
            (name: \"above\", material: \"rock\", body: {top}, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
          ],
          bolts: [(name: \"bolt\", at: Line(from_m: (0.5, 0.5, 1), to_m: (0.5, 0.5, -2)), {BOLT}, {pretension})], {rest})"
    ))
}

fn run(text: &str) -> Outcome {
    let model = Model::from_text(text).unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    Run::new(model).finish(&mut []).unwrap()
}

/// Tension at the head over the pull-out there: a free metre of steel, and a bond of two.
fn stiffness_n_m() -> f64 {
    let lambda = (BOND_N_M2 / EA_N).sqrt();
    1.0 / (1.0 / EA_N + 1.0 / (EA_N * lambda * (2.0 * lambda).tanh()))
}

fn tension_n(outcome: &Outcome) -> f64 {
    outcome.summary.bolts.0.iter().find(|(name, _)| name == "bolt").map_or(0.0, |(_, end)| end.axial_n)
}

fn largest(outcome: &Outcome, column: &str) -> f64 {
    let history = outcome.history.as_ref().unwrap();
    let index = history.names.iter().position(|name| name == column).unwrap();
    history.columns[index].iter().map(|value| value.abs()).fold(0.0, f64::max)
}

#[test]
fn a_bolt_of_a_later_stage_carries_what_the_joint_opens_by_after_that() {
    let outcome = scene(
        "Fixed",
        "",
        "time: (step_s: 1e-3, end_s: 0.5), contact: Off,
         supports: [(block: \"above\", on: All, hold: Motion([(time_s: 0, displacement_m: (0, 0, 0)), (time_s: 1, displacement_m: (0, 0, 4e-3))]))],
         stages: [(name: \"bolts\", install: [\"bolt\"], then: Run(0.5))], output: (history_rows: 100, frames: 0)",
    );
    let answer_n = 2e-3 * stiffness_n_m();
    row(
        "bolts in stages",
        "tension of a bolt installed half-way [N]",
        tension_n(&outcome),
        Within(answer_n, 1e-2),
    );
    let stored_j = 0.5 * 2e-3 * answer_n;
    // Work and energy of a linear bolt agree exactly: rounding of 1000 steps, summed over fewer than 100 segments.
    row(
        "bolts in stages",
        "balance of energy across it, over what it stores",
        largest(&outcome, "balance_j") / stored_j,
        AtMost(100.0 * rounding(1000)),
    );
}

#[test]
fn an_anchor_that_is_tensioned_in_a_stage_keeps_what_the_joint_leaves_of_its_pretension() {
    let (pretension_n, penalty_pa) = (2e5, 1e9);
    let outcome = scene(
        "Rigid",
        &format!("pretension_n: {pretension_n}"),
        &format!(
            "time: (step_s: 1e-4, end_s: 1e-4), gravity_m_s2: (0, 0, -{GRAVITY}), settle: (tolerance: 1e-6),
             contact: Potential(penalty_pa: {penalty_pa}, potential: Smooth(reference_m: 1)),
             stages: [(name: \"anchor\", install: [\"bolt\"], over_s: 0.1, then: Settle(tolerance: 1e-6))], output: (history_rows: 100, frames: 0)"
        ),
    );
    // The joint, of stiffness 2 k_n over 1 m², closes by what the anchor adds to its force.
    let answer_n = pretension_n / (1.0 + stiffness_n_m() / (2.0 * penalty_pa));
    row(
        "bolts in stages",
        "tension of an anchor when the joint has closed [N]",
        tension_n(&outcome),
        Within(answer_n, 1e-4),
    );
    assert_eq!(outcome.summary.label.word, LabelWord::Accurate, "{:?}", outcome.summary.label.reasons);
}

#[test]
fn a_block_falls_when_the_bolt_that_holds_it_is_released() {
    let hangs = "(title: \"a block that hangs\", MATERIALS,
          blocks: [
            (name: \"roof\", material: \"rock\", body: Fixed, shape: Box(size_m: (1, 1, 2), cells: (1, 1, 2)), at_m: (0, 0, 0.5)),
            (name: \"block\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, -1)),
          ],
          bolts: [(name: \"bolt\", at: Line(from_m: (0.5, 0.5, -1), to_m: (0.5, 0.5, 2.5)), BOLT)],
          time: (step_s: 1e-4, end_s: 1e-4), gravity_m_s2: (0, 0, -9.81), settle: (), contact: Off,
          stages: [(name: \"let go\", release: [\"bolt\"], reset_displacements: true, over_s: OVER, then: Run(RUN))],
          monitors: [(name: \"block\", block: \"block\")], output: (history_rows: 100, frames: 0))"
        .replace("MATERIALS", ROCK)
        .replace("BOLT", &BOLT.replace("from_m: 1", "from_m: 1.5"));
    let at_once = run(&hangs.replace("OVER", "0").replace("RUN", "0.2"));
    let fall_m = -at_once.monitor("block").unwrap().displacement[2];
    row(
        "bolts in stages",
        "fall in 0.2 s of a block whose bolt is released [m]",
        fall_m,
        // A fall is exact in every step: rounding of 2000 steps at places five times as far as the fall, twentyfold.
        Within(0.5 * GRAVITY * 0.04, 100.0 * rounding(2000)),
    );
    assert!(at_once.summary.bolts.0.is_empty(), "a released bolt is gone");
    let lambda = (BOND_N_M2 / EA_N).sqrt();
    let stiffness_n_m = 1.0 / (1.5 / EA_N + 1.0 / (EA_N * lambda * (2.0 * lambda).tanh()));
    let stored_j = 0.5 * WEIGHT_N * WEIGHT_N / stiffness_n_m;
    row(
        "bolts in stages",
        "energy of the released bolt [J]",
        largest(&at_once, "removed_j"),
        Within(stored_j, 1e-2),
    );
    row(
        "bolts in stages",
        "balance of energy across the release, over that",
        largest(&at_once, "balance_j") / stored_j,
        // Rounding of 2000 steps, fiftyfold, in the energy of the fall, which is 145 times what the bolt has stored.
        AtMost(50.0 * rounding(2000) * WEIGHT_N * fall_m / stored_j),
    );
    // A force that falls by 1 − 3 u² + 2 u³ over T leaves W t²/2 less the weight that it still bears: 7 T²/20 of it at T, and T/2 of the speed.
    let slowly = run(&hangs.replace("OVER", "0.1").replace("RUN", "0.2"));
    let (speed_m_s, at_m) = (GRAVITY * 0.05, GRAVITY * (0.5 - 0.35) * 0.01);
    let answer_m = at_m + speed_m_s * 0.1 + 0.5 * GRAVITY * 0.01;
    let fall_m = -slowly.monitor("block").unwrap().displacement[2];
    row(
        "bolts in stages",
        "the same when its force ramps down over 0.1 s [m]",
        fall_m,
        // (Δt/T)² of a scheme of second order, fivefold, T the time over which its force falls.
        Within(answer_m, 5.0 * (1e-4f64 / 0.1).powi(2)),
    );
}
