//! Laws of joints that a stage changes: cohesion and softening that it gives to joints in contact, and dilation that it takes.

use ndda::Model;
use ndda::run::{Outcome, Run};

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;

const SHEAR_PA_M: f64 = 1e9;

fn run(law: &str, stages: &str, more: &str) -> Outcome {
    let text = format!(
        "(title: \"joint\", time: (step_s: 1e-4, end_s: 0.01), gravity_m_s2: (0, 0, -10),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
          blocks: [
              (name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (8, 8, 6), cells: (1, 1, 1)), at_m: (-3, -3, -6)),
              (name: \"b\", material: \"rock\", body: Rigid, shape: Box(size_m: (2, 2, 1), cells: (2, 2, 2))),
          ],
          {more} settle: (),
          contact: Potential(penalty_pa: 2e9, potential: Smooth(), restitution: 0.3, friction: ({law})),
          stages: [{stages}], monitors: [(name: \"b\", block: \"b\")], output: (frames: 0, history_rows: 100))"
    );
    let model = Model::from_text(&text).unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    Run::new(model).finish(&mut []).unwrap()
}

/// Displacement of the block at the end [m].
fn moved_m(outcome: &Outcome) -> [f64; 3] {
    outcome
        .summary
        .blocks
        .0
        .iter()
        .find(|(name, _)| name == "b")
        .expect("it is in the scene")
        .1
        .motion
        .displacement_m
}

/// N tan 30° + c A = 57.7 + 80 kN hold 80 kN; friction alone does not. The shear of the spring is F/(k_s A).
#[test]
fn cohesion_that_a_stage_gives_to_a_joint_holds_a_push_with_softening_or_without() {
    let friction = format!("friction_deg: 30, shear_penalty_pa_m: {SHEAR_PA_M:e}");
    let push = "(name: \"push\", forces: [(block: \"b\", at_m: (1, 1, 0), force_n: (80e3, 0, 0))], over_s: 0.2, then: Settle())";
    for (name, more) in [
        ("", ""),
        (", softening", ", residual: (friction_deg: 25, cohesion_pa: 5e3, tension_pa: 5e3, over_m: 0.01)"),
    ] {
        let stage = format!(
            "(name: \"grout\", laws: (friction: ({friction}, cohesion_pa: 20e3, tension_pa: 20e3{more})), over_s: 0.1, then: Settle())"
        );
        let outcome = run(&friction, &format!("{stage}, {push}"), "");
        let expected_m = 80e3 / (SHEAR_PA_M * 4.0);
        let what = format!("slip of a block that a stage has grouted{name}, over F/(k_s A)");
        row("joints in stages", &what, moved_m(&outcome)[0] / expected_m, Within(1.0, 0.02));
    }
}

/// A bond that a stage makes stiffer carries what it did: nothing draws the block back, and the next push stretches it by 1/k of what is added.
#[test]
fn a_block_stays_where_it_is_when_a_stage_makes_its_bonds_stiffer() {
    let law = |shear_pa_m: f64| {
        format!("friction_deg: 30, shear_penalty_pa_m: {shear_pa_m:e}, cohesion_pa: 40e3, tension_pa: 40e3")
    };
    let push = |force_n: f64| {
        format!(
            "(name: \"push {force_n}\", forces: [(block: \"b\", at_m: (1, 1, 0), force_n: ({force_n:e}, 0, 0))], over_s: 0.1, then: Settle())"
        )
    };
    let stiffer =
        format!("(name: \"stiffer\", laws: (friction: ({})), over_s: 0.1, then: Settle())", law(4e9));
    let [first_m, _, _] = moved_m(&run(&law(1e9), &push(80e3), ""));
    let [then_m, _, _] = moved_m(&run(&law(1e9), &format!("{}, {stiffer}", push(80e3)), ""));
    row(
        "joints in stages",
        "slip of a block whose bonds a stage makes four times as stiff, over that before",
        then_m / first_m,
        Within(1.0, 0.01),
    );
}

/// A joint that has opened by tan 10° of its slip stays open where a stage leaves less dilation, or none.
#[test]
fn a_joint_that_has_opened_by_slip_stays_open_where_a_stage_changes_its_dilation() {
    let law = |psi_deg: f64| {
        format!(
            "friction_deg: 30, shear_penalty_pa_m: {SHEAR_PA_M:e}, dilation: (psi_deg: {psi_deg}, to_slip_m: 0.02)"
        )
    };
    let pushed = "forces: [(block: \"b\", at_m: (1, 1, 0), force_n: (100e3, 0, 0), factor: [(time_s: 0, factor: 0), (time_s: 0.02, factor: 1), (time_s: 0.05, factor: 1), (time_s: 0.07, factor: 0)])],";
    let wait = "(name: \"wait\", over_s: 0.1, then: Run(0.1))";
    let less = format!("(name: \"less\", laws: (friction: ({})), over_s: 0.05, then: Run(0.1))", law(1.0));
    let [slip_m, _, before_m] = moved_m(&run(&law(10.0), wait, pushed));
    let [_, _, after_m] = moved_m(&run(&law(10.0), &format!("{wait}, {less}"), pushed));
    assert!(slip_m > 1e-3, "{slip_m}");
    row(
        "joints in stages",
        "by how much a joint that has opened closes when a stage takes its dilation, over the opening",
        (before_m - after_m).abs() / before_m,
        AtMost(0.01),
    );
}
