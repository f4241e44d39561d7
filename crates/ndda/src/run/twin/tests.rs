//! When runs are repeated, and what is found.

use std::sync::atomic::Ordering;

use super::*;
use crate::{Model, Run};

/// A floor, and blocks above it.
fn label(
    gravity: &str,
    (penalty_pa, step_s): (f64, f64),
    blocks: &[&str],
    sensitivity: Sensitivity,
) -> Summary {
    let block = |(name, more): (usize, &&str)| {
        format!(
            "(name: \"{name}\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), {more}),"
        )
    };
    let blocks: String = blocks.iter().enumerate().map(block).collect();
    let text = format!(
        "(title: \"twins\", time: (step_s: {step_s:e}, end_s: 1.1), gravity_m_s2: {gravity},
        materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
        blocks: [(name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (40, 20, 1), cells: (1, 1, 1)),
            at_m: (-10, -10, -1)), {blocks}],
        contact: Potential(penalty_pa: {penalty_pa:e}, potential: Smooth(), friction: (friction_deg: 25)))"
    );
    Run::new(Model::from_text(&text).unwrap()).sensitivity(sensitivity).finish(&mut []).unwrap().summary
}

const TUMBLING: [&str; 4] = [
    "at_m: (0, 0, 0.5), spin_rad_s: (0.5, 0.2, 0)",
    "at_m: (0.6, 0.1, 1.8), spin_rad_s: (1, 0, 0.3)",
    "at_m: (-0.3, 0.4, 3.2), spin_rad_s: (0, 0.7, 0)",
    "at_m: (0.2, -0.3, 4.6)",
];

#[test]
fn cubes_that_tumble_over_each_other_are_sensitive_and_the_run_keeps_its_bits() {
    let [with, without] = [Sensitivity::Auto, Sensitivity::Never]
        .map(|sensitivity| label("(0, 0, -9.81)", (1e10, 5e-5), &TUMBLING, sensitivity));
    assert_eq!(without.label.word, LabelWord::Accurate, "{:?}", without.label.reasons);
    assert_eq!(with.label.word, LabelWord::Sensitive, "{:?}", with.label.reasons);
    assert_eq!((with.state_crc32, with.verdicts), (without.state_crc32, without.verdicts));
}

#[test]
fn cubes_that_slide_side_by_side_are_not_sensitive_though_they_part() {
    let sliding = ["at_m: (0, 0, 0)", "at_m: (3, 0, 0)", "at_m: (0, 3, 0)"];
    let summary = label("(5.5, 0, -8.1)", (2e9, 2e-4), &sliding, Sensitivity::Auto);
    assert_eq!(summary.label.word, LabelWord::Accurate, "{:?}", summary.label.reasons);
    assert!(summary.stages_s.0.iter().any(|(stage, _)| stage == "sensitivity"));
}

#[test]
fn a_cube_that_hops_on_undamped_contact_is_sensitive_in_its_velocity_and_told_how_to_end_that() {
    let undamped = pulled("");
    assert!(
        undamped.contains("with other velocities") && undamped.contains("restitution of 0.5"),
        "{undamped}"
    );
    let damped = pulled("restitution: 0.99,");
    assert!(damped.contains("with other velocities") && !damped.contains("not damped"), "{damped}");
}

/// Why a cube that gravity loads suddenly, and that is pulled, is sensitive; `contact` is more of the contact.
fn pulled(contact: &str) -> String {
    let text = "(title: \"pulled\", time: (step_s: 3e-5, end_s: 1), gravity_m_s2: (3.92, 0, -9.81),
        materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.2, density_kg_m3: 2600)],
        blocks: [
            (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (4, 2, 0.5), cells: (1, 1, 1)), at_m: (0, 0, -0.5)),
            (name: \"cube\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (1, 0.5, 0)),
        ],
        contact: Potential(penalty_pa: 2e8, friction: (friction_deg: 35)))";
    let text = text.replace("Potential(", &format!("Potential({contact}"));
    let summary = Run::new(Model::from_text(&text).unwrap()).finish(&mut []).unwrap().summary;
    let reason = summary.label.reasons.join("; ");
    assert_eq!(summary.label.word, LabelWord::Sensitive, "{reason}");
    reason
}

#[test]
fn an_elastic_block_whose_face_hops_while_it_slides_is_sensitive() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../scenes/extreme/elastic_block_stands.ron");
    let set = ["gravity_ramp_s=0", "contact.penalty_pa=6e10", "output.frames=0"].map(String::from);
    let summary = Run::new(Model::open(&file, &set).unwrap()).finish(&mut []).unwrap().summary;
    assert_eq!(summary.label.word, LabelWord::Sensitive, "{:?}", summary.label.reasons);
}

#[test]
fn a_stone_whose_impacts_have_grown_an_error_is_inaccurate_until_its_step_is_halved() {
    let stone = |step_s: f64| {
        let text = format!(
            "(title: \"stone\", time: (step_s: {step_s:e}, end_s: 2), gravity_m_s2: (4.905, 0, -8.496),
            materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
            blocks: [
                (name: \"slope\", material: \"rock\", body: Fixed, shape: Box(size_m: (60, 20, 1), cells: (1, 1, 1)), at_m: (-5, -10, -1)),
                (name: \"stone\", material: \"rock\", body: Rigid,
                    shape: Prism(outline_m: ((0, 0), (1, 0), (0.4, 0.8)), height_m: 0.7, cells: (1, 1)),
                    turns: [(axis: (0.941, -0.234, 0.225), angle_deg: 110.73)], at_m: (0, 0, 1.88),
                    velocity_m_s: (0.341, 0.105, 0), spin_rad_s: (1.441, -0.666, 0)),
            ],
            contact: Potential(penalty_pa: 1e10, potential: Smooth(), friction: (friction_deg: 60)))"
        );
        Run::new(Model::from_text(&text).unwrap()).finish(&mut []).unwrap().summary.label
    };
    let (long, short) = (stone(2e-4), stone(1e-4));
    assert_eq!(long.word, LabelWord::Inaccurate, "{:?}", long.reasons);
    assert!(long.reasons[0].contains("errors of impacts grow"), "{:?}", long.reasons);
    assert_eq!(short.word, LabelWord::Accurate, "{:?}", short.reasons);
}

#[test]
fn blocks_that_rounding_alone_moves_are_not_sensitive() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/extreme/at_rest.ron");
    let run = Run::new(Model::open(&file, &[]).unwrap()).sensitivity(Sensitivity::Always);
    let summary = run.finish(&mut []).unwrap().summary;
    assert_eq!(summary.label.word, LabelWord::Accurate, "{:?}", summary.label.reasons);
}

#[test]
fn a_short_run_of_one_block_is_repeated_unless_that_is_switched_off() {
    let sliding = ["at_m: (0, 0, 0)"];
    for (sensitivity, has_twin) in [(Sensitivity::Auto, true), (Sensitivity::Never, false)] {
        let summary = label("(5.5, 0, -8.1)", (2e9, 2e-4), &sliding, sensitivity);
        assert_eq!(summary.stages_s.0.iter().any(|(stage, _)| stage == "sensitivity"), has_twin);
    }
}

/// Cubes on a prop that a stage takes away, above a ridge.
fn undermined(sensitivity: Sensitivity) -> Summary {
    let text = "(title: \"undermined\", time: (step_s: 5e-5, end_s: 0.01), gravity_m_s2: (0, 0, -9.81), settle: (),
        materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
        blocks: [
            (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (40, 40, 1), cells: (1, 1, 1)), at_m: (-20, -20, -1)),
            (name: \"ridge\", material: \"rock\", body: Fixed, shape: Box(size_m: (1, 9, 1), cells: (1, 1, 1)),
                turns: [(axis: (0, 1, 0), angle_deg: 45)], at_m: (-0.7, -4, 0.7)),
            (name: \"prop\", material: \"rock\", body: Fixed, shape: Box(size_m: (6, 6, 0.2), cells: (1, 1, 1)), at_m: (-3, -3, 1.6)),
            (name: \"a\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (-0.9, -0.7, 1.8)),
            (name: \"b\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (-0.5, -0.4, 2.8)),
            (name: \"c\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (-0.7, -0.6, 3.8)),
            (name: \"d\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (-0.4, -0.8, 4.8)),
        ],
        contact: Potential(penalty_pa: 1.5e10, potential: Smooth(), friction: (friction_deg: 25)),
        stages: [(name: \"prop away\", remove: [\"prop\"], then: Run(1.6))])";
    Run::new(Model::from_text(text).unwrap()).sensitivity(sensitivity).finish(&mut []).unwrap().summary
}

#[test]
fn blocks_that_a_stage_lets_fall_are_sensitive_as_those_of_a_scene_without_stages_are() {
    let [with, without] = [Sensitivity::Auto, Sensitivity::Never].map(undermined);
    assert_eq!(without.label.word, LabelWord::Accurate, "{:?}", without.label.reasons);
    assert_eq!(with.label.word, LabelWord::Sensitive, "{:?}", with.label.reasons);
    assert_eq!((with.state_crc32, with.verdicts), (without.state_crc32, without.verdicts));
}

#[test]
fn a_raft_that_its_steps_do_not_resolve_is_inaccurate_although_nothing_touches_it() {
    let raft = |step_s: f64| {
        let text = format!(
            "(title: \"raft\", time: (step_s: {step_s:e}, end_s: 30), gravity_m_s2: (0, 0, -9.81),
            materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 900)],
            blocks: [(name: \"raft\", material: \"rock\", body: Rigid, shape: Box(size_m: (2, 2, 1), cells: (1, 1, 1)), at_m: (0, 0, -0.85))],
            water: [(on: Part(block: \"raft\", region: All), pressure: Level(at_m: (0, 0, 0)))])"
        );
        let outcome = Run::new(Model::from_text(&text).unwrap()).finish(&mut []).unwrap();
        // u = −5 cm (1 − cos ω t), ω² = ρ_w g/(ρ h).
        let rate = (9810.0f64 / 900.0).sqrt();
        let exact_m_s = -0.05 * rate * (30.0 * rate).sin();
        let error = (outcome.simulation.state().velocity[0].z - exact_m_s).abs() / (0.05 * rate);
        (outcome.summary.label.word, error)
    };
    let ((long, off), (short, little)) = (raft(0.2), raft(0.01));
    assert!(long == LabelWord::Inaccurate && off > 1.0, "{long:?} {off}");
    assert!(short == LabelWord::Accurate && little < 0.01, "{short:?} {little}");
}

/// Label of a scene of rigid or elastic blocks.
fn label_of(text: &str) -> (LabelWord, String) {
    let summary = Run::new(Model::from_text(text).unwrap()).finish(&mut []).unwrap().summary;
    (summary.label.word, summary.label.reasons.join("; "))
}

#[test]
fn loads_along_the_way_of_a_block_are_judged_where_other_blocks_could_touch_it() {
    let scene = |blocks: &str, loads: &str, (step_s, end_s): (f64, f64)| {
        format!(
            "(title: \"loads\", time: (step_s: {step_s:e}, end_s: {end_s}), gravity_m_s2: (0, 0, -9.81),
            materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.25, density_kg_m3: 900)],
            blocks: [(name: \"sea\", material: \"rock\", body: Fixed, shape: Box(size_m: (9, 9, 1), cells: (1, 1, 1)), at_m: (-5, -5, -4)), {blocks}],
            contact: Potential(penalty_pa: 2e7, potential: Smooth()), {loads})"
        )
    };
    let raft = |size_m: f64| {
        format!(
            "(name: \"a\", material: \"rock\", body: Rigid, shape: Box(size_m: ({size_m}, {size_m}, {size_m}), cells: (1, 1, 1)), at_m: (0, 0, {})),",
            -0.8 * size_m
        )
    };
    let water = "water: [(on: Part(block: \"a\", region: All), pressure: Level(at_m: (0, 0, 0)))]";
    let heaves = |step_s: f64| label_of(&scene(&raft(1.0), water, (step_s, 6.0)));
    let ((long, reason), (short, none)) = (heaves(0.1), heaves(0.01));
    assert!(long == LabelWord::Inaccurate && reason.contains("half the step"), "{reason}");
    assert_eq!(short, LabelWord::Accurate, "{none}");
    // Another block touches the bed all the time.
    let rests = "(name: \"rest\", material: \"rock\", body: Rigid, shape: Box(size_m: (2, 2, 2), cells: (1, 1, 1)), at_m: (-4, -4, -3.00044145)),";
    let (word, reason) = label_of(&scene(&(raft(0.01) + rests), water, (5e-3, 2.0)));
    assert!(word == LabelWord::Inaccurate && reason.contains("`a`"), "{reason}");
    // A block that only falls needs no second run.
    let text = scene(&raft(1.0), "", (0.01, 0.5));
    let summary = Run::new(Model::from_text(&text).unwrap()).finish(&mut []).unwrap().summary;
    assert!(summary.stages_s.0.iter().all(|(stage, _)| stage != SECOND_RUN), "{:?}", summary.label);
}

#[test]
fn one_impact_of_a_block_that_deforms_on_strongly_damped_contact_is_judged_by_half_the_step() {
    let rebounds = |step_s: f64, restitution: f64| {
        label_of(&format!(
            "(title: \"rebound\", time: (step_s: {step_s:e}, end_s: 0.03),
            materials: [(name: \"rock\", young_pa: 5e9, poisson: 0.25, density_kg_m3: 2650)],
            blocks: [(name: \"wall\", material: \"rock\", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2))),
                (name: \"a\", material: \"rock\", body: Elastic, shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2), pattern: TwentyFour), at_m: (1.02, 0, 0), velocity_m_s: (-2, 0, 0))],
            contact: Potential(penalty_pa: 5e8, potential: Smooth(), restitution: {restitution}))"
        ))
    };
    let (word, reason) = rebounds(4e-5, 0.0);
    assert!(word == LabelWord::Inaccurate && reason.contains("half the step"), "{reason}");
    let (word, reason) = rebounds(4e-5, 0.3);
    assert_eq!(word, LabelWord::Accurate, "{reason}");
}

#[test]
fn a_small_block_that_settling_leaves_far_from_rest_beside_a_large_one_is_named() {
    let (word, reason) = label_of(
        "(title: \"raft\", time: (step_s: 1e-3, end_s: 0.2), gravity_m_s2: (0, 0, -9.81), settle: (),
        materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.25, density_kg_m3: 900)],
        blocks: [(name: \"sea\", material: \"rock\", body: Fixed, shape: Box(size_m: (10, 10, 1), cells: (1, 1, 1)), at_m: (-5, -5, -4)),
            (name: \"rest\", material: \"rock\", body: Rigid, shape: Box(size_m: (2, 2, 2), cells: (1, 1, 1)), at_m: (-4, -4, -3)),
            (name: \"a\", material: \"rock\", body: Rigid, shape: Box(size_m: (0.01, 0.01, 0.01), cells: (1, 1, 1)), at_m: (0, 0, -0.008))],
        contact: Potential(penalty_pa: 2e7, potential: Smooth()),
        water: [(on: Part(block: \"a\", region: All), pressure: Level(at_m: (0, 0, 0)))])",
    );
    assert!(word == LabelWord::Inaccurate && reason.contains("block `a` has not"), "{reason}");
}

#[test]
fn a_raft_that_its_water_carries_from_the_start_is_accurate() {
    for at in [0.0, 1e3] {
        let text = format!(
            "(title: \"raft\", time: (step_s: 2e-3, end_s: 2), gravity_m_s2: (0, 0, -10),
            materials: [(name: \"wood\", young_pa: 1e8, poisson: 0.25, density_kg_m3: 500)],
            blocks: [(name: \"a\", material: \"wood\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (2, 2, 4)), at_m: ({at}, 0, 0))],
            water: [(on: Part(block: \"a\", region: All), pressure: Level(at_m: (0, 0, 0.5)))])"
        );
        let summary = Run::new(Model::from_text(&text).unwrap()).finish(&mut []).unwrap().summary;
        assert_eq!(summary.label.word, LabelWord::Accurate, "at {at}: {:?}", summary.label.reasons);
    }
}

#[test]
fn a_run_that_goes_on_is_repeated_as_it_began() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("cube.ron");
    let text = "(title: \"cube\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: (0, 0, -9.81),
        materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.2, density_kg_m3: 2600)],
        blocks: [(name: \"cube\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))])";
    std::fs::write(&file, text).unwrap();
    for asked in [Sensitivity::Always, Sensitivity::Never] {
        let out = folder.path().join(format!("{asked:?}"));
        let stop = Arc::new(AtomicBool::new(true));
        let run = Run::new(Model::open(&file, &[]).unwrap());
        let run = run.record(ndda_io::OutputFolder::create(&out, false).unwrap(), file.clone()).unwrap();
        run.sensitivity(asked).stop_when(stop).finish(&mut []).unwrap();
        let resumed = Run::resume(&out).unwrap().run;
        assert_eq!(resumed.sensitivity, asked);
    }
}

#[test]
fn a_run_that_is_interrupted_while_it_runs_again_is_judged_when_it_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("cube.ron");
    let text = "(title: \"cube\", time: (step_s: 1e-3, end_s: 0.1), gravity_m_s2: (0, 0, -9.81),
        materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.2, density_kg_m3: 2600)],
        blocks: [(name: \"cube\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))])";
    std::fs::write(&file, text).unwrap();
    let (out, stop) = (folder.path().join("out"), Arc::new(AtomicBool::new(false)));
    let asked = stop.clone();
    let run = Run::new(Model::open(&file, &[]).unwrap());
    let run = run.record(ndda_io::OutputFolder::create(&out, false).unwrap(), file.clone()).unwrap();
    // Told of the repetition, somebody asks the run to end.
    let run = run.strict(true).stop_when(stop).tell(move |_| asked.store(true, Ordering::Relaxed));
    let cut = run.finish(&mut []).unwrap().summary;
    assert_eq!((cut.status, cut.steps), (Status::Interrupted, 100));
    assert_eq!(cut.label.word, LabelWord::Inaccurate);
    let words = "with half the step was interrupted: it is not known whether the result changes";
    assert!(cut.label.reasons[0].contains(words), "{:?}", cut.label.reasons);
    let done = Run::resume(&out).unwrap().run.finish(&mut []).unwrap().summary;
    assert_eq!((done.status, done.label.word), (Status::Done, LabelWord::Accurate), "{:?}", done.label);
    assert_eq!(done.state_crc32, cut.state_crc32);
    assert!(done.stages_s.0.iter().any(|(stage, _)| stage == SECOND_RUN));
    assert!(matches!(Run::resume(&out), Err(crate::run::ResumeError::HasEnded(_))));
}
