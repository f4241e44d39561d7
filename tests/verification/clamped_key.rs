//! A key block between two walls, whose prop is taken out. Its joints bear at most its initial stress, p A on each wall, and no less than nothing, so that it
//! falls with g (1 − s) for 0 ≤ s ≤ 2 μ p A/W once it has begun to slip.

use ndda::summary::{LabelWord, Summary};
use ndda::{Model, Run, run::Sensitivity};

/// μ, initial stress times area [N], weight [N].
const FRICTION: f64 = 0.577_350_269_189_625_7;
const PRESSED_N: f64 = 10.6e3;
const WEIGHT_N: f64 = 24.5e3;

/// The scene with settings, as it is without repetitions.
fn run(settings: &[&str]) -> Summary {
    let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/failures/clamped_key.ron");
    let settings: Vec<String> = settings.iter().map(|s| (*s).into()).collect();
    let run = Run::new(Model::open(&scene, &settings).unwrap()).sensitivity(Sensitivity::Never);
    run.finish(&mut []).unwrap().summary
}

/// Velocity at the end of the stage, which takes the prop's force away over 0.02 s of its 0.2 s: the key slips once the part s of its weight has come on the walls.
fn falls_at_m_s(s: f64) -> f64 {
    9.8 * (0.01 * (1.0 - s).powi(2) + 0.18 * (1.0 - s))
}

#[test]
fn a_key_block_that_vibrates_between_walls_hangs_and_its_label_says_so_however_short_the_step() {
    for step in ["time.step_s=2e-5", "time.step_s=1e-5"] {
        let label = run(&[step, "contact.friction=(friction_deg:30)", "stages.out.then=Run(0.06)"]).label;
        assert_eq!(label.word, LabelWord::Inaccurate, "{step}");
        let says = |reason: &String| reason.contains("`key` vibrates between others");
        assert!(label.reasons.iter().any(says), "{step}: {:?}", label.reasons);
    }
}

#[test]
fn a_key_block_of_damped_rock_falls_and_is_accurate() {
    let summary = run(&["materials.rock.damping.stiffness_s=1.9e-5"]);
    assert_eq!(summary.label.word, LabelWord::Accurate, "{:?}", summary.label.reasons);
    let (_, key) = summary.blocks.0.iter().find(|(name, _)| name == "key").unwrap();
    let speed_m_s = -key.velocity[2];
    let (slowest_m_s, fastest_m_s) = (falls_at_m_s(2.0 * FRICTION * PRESSED_N / WEIGHT_N), falls_at_m_s(0.0));
    assert!(slowest_m_s < speed_m_s && speed_m_s < fastest_m_s, "{speed_m_s}");
}

#[test]
fn a_rigid_key_block_that_vibrates_between_elastic_walls_is_found_too() {
    let walls = ["left", "right"].map(|wall| {
        let shape = format!("blocks.{wall}.shape=Box(size_m:(1,1,1),cells:(2,2,2))");
        [
            format!("blocks.{wall}.body=Elastic"),
            shape,
            format!("blocks.{wall}.initial_stress_pa=(xx:-10.6e3)"),
        ]
    });
    let backs = "supports=[
        (block:\"left\",on:Plane(point_m:(-1,0,0),normal:(1,0,0)),hold:Fixed),
        (block:\"right\",on:Plane(point_m:(2,0,0),normal:(1,0,0)),hold:Fixed)]";
    let key = ["blocks.key.body=Rigid", "blocks.key.initial_stress_pa=None", backs];
    let settings: Vec<&str> = walls.iter().flatten().map(String::as_str).chain(key).collect();
    let label = run(&settings).label;
    assert_eq!(label.word, LabelWord::Inaccurate);
    let says = |reason: &String| {
        reason.contains("`key` vibrates between others") && reason.contains("the blocks that press it")
    };
    assert!(label.reasons.iter().any(says), "{:?}", label.reasons);
}
