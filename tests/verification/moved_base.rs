//! The ledger of blocks on a base that moves: friction takes energy from both, and what moves the base delivers it.

use std::fmt::Write;

use ndda::judge::verdict;
use ndda::summary::LabelWord;
use ndda_solver::{Sample, Simulation};

use crate::evidence::Answer::AtMost;
use crate::evidence::{rounding, row};
use crate::simulation;

/// A stack of two slabs on a moved base; no law of shear breaks in it.
fn stack(body: &str, base: &str, law: &str, gravity: &str, rows: &str) -> Simulation {
    simulation(&format!(
        "(title: \"moved base\", time: (step_s: 5e-5, end_s: 1), gravity_m_s2: {gravity},
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
          blocks: [
            (name: \"base\", material: \"rock\", body: {base}, shape: Box(size_m: (3, 1, 0.5), cells: (3, 1, 1)), at_m: (-1.5, -0.5, -0.5)),
            (name: \"a\", material: \"rock\", body: {body}, shape: Box(size_m: (0.5, 0.5, 0.1), cells: (2, 2, 1)), at_m: (-0.25, -0.25, 0)),
            (name: \"b\", material: \"rock\", body: {body}, shape: Box(size_m: (0.5, 0.5, 0.1), cells: (2, 2, 1)), at_m: (-0.25, -0.25, 0.1)),
          ],
          supports: [(block: \"base\", on: All, hold: Motion([(time_s: 0, displacement_m: (0, 0, 0)), {rows}]))],
          contact: Potential(penalty_pa: 5e8, potential: Smooth(), friction: (friction_deg: 30, {law})))"
    ))
}

/// Balances of a run at every tenth step: the largest error, over the work done by what moves the base, less what explicit contact holds back, h²/4 of its
/// energy, over the same; and the last sample.
fn balance(simulation: &mut Simulation, steps: u32) -> (f64, Sample) {
    simulation.sample().unwrap();
    let (mut worst_j, mut contact_j, mut sample) = (0.0f64, 0.0f64, Sample::default());
    for _ in 0..steps / 10 {
        for _ in 0..10 {
            simulation.step().unwrap();
        }
        sample = simulation.sample().unwrap();
        contact_j = contact_j.max(sample.contact_j);
        worst_j = worst_j.max(sample.balance_j.abs());
    }
    let h = simulation.invariants().max_h;
    ((worst_j - 0.25 * h * h * contact_j).max(0.0) / sample.motion_work_j.abs(), sample)
}

/// A conveyor that starts at once, a shaken base, and a base that moves under a slanted weight.
fn cases() -> [(&'static str, &'static str, String); 3] {
    let mut shaken = String::new();
    for i in 1..=40 {
        let t = 5e-3 * f64::from(i);
        let u = 2e-3 * (1.0 - (50.0 * t).cos());
        write!(shaken, "(time_s: {t}, displacement_m: ({u:e}, {:e}, 0)),", 0.5 * u).unwrap();
    }
    let conveyor = "(time_s: 1, displacement_m: (0.5, 0, 0))".to_string();
    let tilted = "(time_s: 1, displacement_m: (-0.2, 0.1, 0))".to_string();
    [
        ("conveyor", "(0, 0, -9.81)", conveyor),
        ("shaken stack", "(0, 0, -9.81)", shaken),
        ("tilted table", "(1.7, 0, -9.66)", tilted),
    ]
}

#[test]
fn energy_is_accounted_for_on_moved_bases() {
    for (name, gravity, rows) in cases() {
        let mut worst = 0.0f64;
        for law in ["", "shear_penalty_pa_m: 1e9", "shear_penalty_pa_m: 1e10, cohesion_pa: 1e6"] {
            for (body, base) in
                [("Rigid", "Fixed"), ("Affine", "Fixed"), ("Elastic", "Fixed"), ("Elastic", "Elastic")]
            {
                let mut simulation = stack(body, base, law, gravity, &rows);
                let (off, sample) = balance(&mut simulation, 4000);
                println!("{name}, {law}, {body} on {base}: {off:e}, {sample:?}");
                worst = worst.max(off);
                assert!(sample.friction_work_j < 0.0, "{name}, {law}, {body}: {sample:?}");
            }
        }
        let what = format!(
            "energy from nowhere over the work of the base, {name}, three laws, four pairs of bodies"
        );
        // Beyond what explicit contact holds back nothing is lost: rounding of 4000 steps, tenfold.
        row("moved base", &what, worst, AtMost(10.0 * rounding(4000)));
    }
}

#[test]
fn a_block_clamped_between_moved_plates_balances_to_rounding() {
    // The plates press 20 µm into either side, so friction is the same on both: normal contact does no work, and explicit contact holds nothing back.
    for law in ["", ", shear_penalty_pa_m: 1e9", ", shear_penalty_pa_m: 1e10, cohesion_pa: 1e5"] {
        let motion = "hold: Motion([(time_s: 0, displacement_m: (0, 0, 0)), (time_s: 0.02, displacement_m: (0.01, 0.005, 0)), (time_s: 0.05, displacement_m: (0, 0, 0))])";
        let mut simulation = simulation(&format!(
            "(title: \"clamp\", time: (step_s: 1e-5, end_s: 1),
              materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
              blocks: [
                (name: \"below\", material: \"rock\", body: Fixed, shape: Box(size_m: (2, 2, 0.5), cells: (1, 1, 1)), at_m: (-1, -1, -0.49998)),
                (name: \"block\", material: \"rock\", body: Rigid, shape: Box(size_m: (0.5, 0.5, 0.1), cells: (2, 2, 1)), at_m: (-0.25, -0.25, 0)),
                (name: \"above\", material: \"rock\", body: Fixed, shape: Box(size_m: (2, 2, 0.5), cells: (1, 1, 1)), at_m: (-1, -1, 0.09998)),
              ],
              supports: [(block: \"below\", on: All, {motion}), (block: \"above\", on: All, {motion})],
              contact: Potential(penalty_pa: 5e8, potential: Smooth(), friction: (friction_deg: 30{law})))"
        ));
        let (_, sample) = balance(&mut simulation, 5000);
        let off = sample.balance_j.abs() / sample.motion_work_j.abs();
        row(
            "moved base",
            &format!("energy from nowhere over the work of the plates of a clamp{law}"),
            off,
            // Rounding of 5000 steps, tenfold.
            AtMost(10.0 * rounding(5000)),
        );
    }
}

#[test]
fn the_toppling_template_is_accurate() {
    let mut simulation = simulation(include_str!("../../crates/ndda/templates/topple.ron"));
    simulation.sample().unwrap();
    for _ in 0..400 {
        for _ in 0..25 {
            simulation.step().unwrap();
        }
        simulation.sample().unwrap();
    }
    let label = verdict::label(&simulation, None);
    assert_eq!(label.word, LabelWord::Accurate, "{:?}", label.reasons);
    row(
        "moved base",
        "lasting change of energy of the toppling template",
        simulation.invariants().lasting_loss,
        // The statement: it is accurate, with a twentieth of the 2 % that the label permits.
        AtMost(1e-3),
    );
}

/// Contact damping of a block that deforms feeds its vibrations where steps are long for them. The energy of a base that is shaken must not hide that.
#[test]
fn damping_that_feeds_a_block_on_a_shaken_base_is_not_hidden_by_the_energy_of_the_base() {
    let mut rows = String::new();
    for i in 1..=500 {
        let t = 2e-3 * f64::from(i);
        let w = 6.0 * std::f64::consts::PI;
        // 0.325 g at 3 Hz, from rest.
        let u = 0.325 * 9.81 / (w * w) * (w * t - (w * t).sin());
        write!(rows, "(time_s: {t}, displacement_m: (0, {u:e}, 0)),").unwrap();
    }
    let label = |body: &str, restitution: f64| {
        let mut simulation = simulation(&format!(
            "(title: \"plate\", time: (step_s: 4e-5, end_s: 1), gravity_m_s2: (3.3552, 0, -9.2184), settle: (),
              materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
              blocks: [
                (name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (2, 2, 0.2), cells: (2, 2, 1)), at_m: (-1, -1, -0.2)),
                (name: \"plate\", material: \"rock\", body: {body}, shape: Box(size_m: (0.4, 0.4, 0.05), cells: (2, 2, 1)), at_m: (-0.2, -0.2, 0)),
              ],
              supports: [(block: \"base\", on: All, hold: Motion([(time_s: 0, displacement_m: (0, 0, 0)), {rows}]))],
              contact: Potential(penalty_pa: 2e9, potential: Smooth(), restitution: {restitution}, friction: (friction_deg: 30)))"
        ));
        // Damping that feeds the plate keeps it from coming closer to rest.
        simulation.settle(&ndda_solver::Settle::new(1e-2, 40_000)).unwrap();
        balance(&mut simulation, 25_000);
        verdict::label(&simulation, None)
    };
    let fed = label("Elastic", 0.3);
    assert!(fed.reasons.iter().any(|reason| reason.contains("contact damping")), "{:?}", fed.reasons);
    assert_eq!(label("Rigid", 0.3).word, LabelWord::Accurate);
}
