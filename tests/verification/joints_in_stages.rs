//! Laws of joints that a stage changes: cohesion and softening that it gives to joints in contact or takes from them, and dilation that it takes.

use ndda::Model;
use ndda::run::{Outcome, Run};

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;

const SHEAR_PA_M: f64 = 1e9;

fn run(law: &str, stages: &str, more: &str) -> Outcome {
    run_under([0.0, 0.0, -10.0], law, stages, more)
}

/// The block under this gravity [m/s²].
fn run_under([x, y, z]: [f64; 3], law: &str, stages: &str, more: &str) -> Outcome {
    let text = format!(
        "(title: \"joint\", time: (step_s: 1e-4, end_s: 0.01), gravity_m_s2: ({x}, {y}, {z}),
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

/// A block on a slope of 35°, held by 40° on shear springs or by cohesion: whatever law a stage gives it that holds it, too, it stays. The shear of the joint stretches its
/// springs by 14 µm; where it was lost, the block fell through twice that, and slid where it could not be held any more. What is left of the way to rest counts, and where friction
/// takes over from cohesion, or bonds of limited strength from friction, facets that are pressed less leave some of their shear to others.
#[test]
fn a_stage_that_leaves_a_standing_block_strength_enough_does_not_move_it() {
    let slope = [10.0 * 35f64.to_radians().sin(), 0.0, -10.0 * 35f64.to_radians().cos()];
    let springs = |deg: f64, pa_m: f64| format!("friction_deg: {deg}, shear_penalty_pa_m: {pa_m:e}");
    let glue = "cohesion_pa: 20e3, tension_pa: 20e3";
    let stands = springs(40.0, SHEAR_PA_M);
    let bonded = format!("{}, {glue}", springs(30.0, SHEAR_PA_M));
    for (before, after, what, shares) in [
        (&stands, bonded.clone(), "cohesion to a joint on springs", false),
        (&stands, format!("{}, {glue}", springs(30.0, 4e9)), "cohesion and stiffer springs", false),
        (&stands, format!("{stands}, residual: (friction_deg: 20, over_m: 1e-3)"), "softening", false),
        (
            &stands,
            format!(
                "{bonded}, residual: (friction_deg: 30, cohesion_pa: 20e3, tension_pa: 20e3, opening_m: 0.1)"
            ),
            "cohesion that yields",
            false,
        ),
        (
            &stands,
            format!("{bonded}, fracture: (tension_j_m2: 100, shear_j_m2: 100)"),
            "bonds with a fracture energy",
            true,
        ),
        (&bonded, stands.clone(), "friction in the place of cohesion", true),
        (&bonded, springs(40.0, 4e9), "friction on stiffer springs in the place of cohesion", true),
    ] {
        let stage = format!("(name: \"after\", laws: (friction: ({after})), then: Run(0.1))");
        let wait = "(name: \"wait\", then: Run(0.1))";
        let [moved, stays] = [&stage, wait].map(|stage| moved_m(&run_under(slope, before, stage, "")));
        let most_m = (0..3).map(|k| (moved[k] - stays[k]).abs()).fold(0.0, f64::max);
        let what = format!("by how far a stage moves a block that stands, which gives it {what} [m]");
        row("joints in stages", &what, most_m, AtMost(if shares { 1e-5 } else { 5e-7 }));
    }
}

/// A joint that yields has slipped by millimetres under a push when a stage leaves it friction alone: its bonds leave their shear to the springs of its facets, which share it
/// anew, as they are not pressed alike.
#[test]
fn a_joint_whose_bonds_have_slipped_goes_on_under_a_law_without_bonds() {
    let slope = [10.0 * 35f64.to_radians().sin(), 0.0, -10.0 * 35f64.to_radians().cos()];
    let glue = "cohesion_pa: 20e3, tension_pa: 20e3";
    let yields = format!(
        "friction_deg: 30, shear_penalty_pa_m: {SHEAR_PA_M:e}, {glue}, residual: (friction_deg: 30, {glue}, opening_m: 0.1)"
    );
    let pushed = "forces: [(block: \"b\", at_m: (1, 1, 0), force_n: (100e3, 0, 0), factor: [(time_s: 0, factor: 0), (time_s: 0.02, factor: 1), (time_s: 0.05, factor: 1), (time_s: 0.07, factor: 0)])],";
    let wait = "(name: \"wait\", then: Run(0.1))";
    let friction = format!("(friction_deg: 40, shear_penalty_pa_m: {SHEAR_PA_M:e})");
    let after = format!("(name: \"after\", laws: (friction: {friction}), then: Run(0.1))");
    let [before_m, _, _] = moved_m(&run_under(slope, &yields, wait, pushed));
    let [after_m, _, _] = moved_m(&run_under(slope, &yields, &format!("{wait}, {after}"), pushed));
    assert!(before_m > 1e-3, "{before_m}");
    row(
        "joints in stages",
        "by how far a block that has slipped on bonds moves when a stage leaves it friction that holds it [m]",
        (after_m - before_m).abs(),
        AtMost(1e-5),
    );
}
