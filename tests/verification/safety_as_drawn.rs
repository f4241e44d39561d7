//! Scenes that do not stand as they are drawn, and answers to several errors.

use std::path::Path;
use std::sync::Arc;

use ndda::choose;
use ndda::safety::{self, Kind, Plan, Question, Safety, Watch};
use ndda_io::read;
use ndda_mesh::Vec3;

use crate::evidence::Answer::{AtLeast, AtMost};
use crate::evidence::row;
use crate::safety_factor::{bracket, found, holds, kind, limit_equilibrium, normal, scene};

/// The scene of a cube on a plane of 30°, beside a block on rough faces that hangs 0.7 m above the plane, and falls whatever the strength of joints is.
fn beside_a_block_that_hangs() -> String {
    let hangs = "(name: \"hangs\", material: \"rough\", body: Rigid, shape: Box(size_m: (0.5, 0.5, 0.5), cells: (1, 1, 1)), at_m: (1.5, 0, 0.7)),";
    let text = scene("plane_dry").replace("    ],\n    contact", &format!("{hangs}    ],\n    contact"));
    let rough = "(name: \"rough\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)";
    let text = text.replace("density_kg_m3: 2600)]", &format!("density_kg_m3: 2600), {rough}]"));
    let pair = "material_pairs: [(between: (\"rock\", \"rough\"), friction: (friction_deg: 60))]";
    text.replace("friction: (friction_deg: 40))", &format!("friction: (friction_deg: 40), {pair})"))
}

#[test]
fn a_block_that_does_not_stand_as_drawn_has_no_factor_but_a_bound() {
    let text = scene("plane_dry").replace("at_m: (0, 0, 0)", "at_m: (0, 0, 0.7)");
    let safety = found(&text, Question::Strength);
    // It fails with 32 times its strength.
    assert_eq!((safety.factor_of_safety.lower, safety.factor_of_safety.upper), (None, Some(1.0 / 32.0)));
    assert!(safety.trials.is_empty() && safety.mechanism.is_none() && !safety.stands_as_drawn());
    let moved = &safety.not_standing[0];
    assert!(moved.block == "cube" && moved.moved_m >= 0.7, "{moved:?}");
    assert!(moved.direction[2] < 0.0, "{moved:?}");
    let told = safety::text(&safety);
    assert!(
        told.contains(
            "does not stand as drawn, even with joints 32 times as strong: factor of safety below 0.032"
        ),
        "{told}"
    );
}

/// Friction of 1° and 1.5° on 45°, of which 32 times as much still leaves 0.44 and 0.16 of the weight along the plane: damping on the way to rest holds the slab back, which slides all the same.
#[test]
fn a_slab_that_slides_with_32_times_its_strength_does_not_stand_as_drawn() {
    for (friction_deg, cells) in [(1.0, "(2, 2, 1)"), (1.5, "(1, 1, 1)")] {
        let text = format!(
            "(title: \"slab\", time: (end_s: 1), gravity_m_s2: (6.936717523440031, 0, -6.9367175234400325),
              materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
              blocks: [
                (name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (6, 2, 0.2), cells: (1, 1, 1)), at_m: (-1.5, -0.5, -0.2)),
                (name: \"slab\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 0.5), cells: {cells}))],
              contact: Potential(potential: Smooth(), friction: (friction_deg: {friction_deg})))"
        );
        let safety = to_error(&text, 0.01);
        assert_eq!((safety.factor_of_safety.lower, safety.factor_of_safety.upper), (None, Some(1.0 / 32.0)));
        let moved = &safety.not_standing[0];
        assert!(moved.block == "slab" && moved.direction[0] > 0.99, "{moved:?}");
    }
}

#[test]
fn a_block_that_does_not_stand_leaves_the_factor_of_the_others() {
    let safety = found(&beside_a_block_that_hangs(), Question::Strength);
    holds(
        "cube on 30°, beside a block that falls",
        &safety,
        40f64.to_radians().tan() / 30f64.to_radians().tan(),
    );
    assert_eq!(safety.not_standing.iter().map(|moved| moved.block.as_str()).collect::<Vec<_>>(), ["hangs"]);
    assert!(
        safety.remarks.iter().any(|remark| remark.contains("the factor is that of the others")),
        "{:?}",
        safety.remarks
    );
}

/// A slab on J1, cut off by the model's side, that J2 holds at its other side: water on both joints leaves a twentieth of the force on J2.
fn wet_wedge() -> String {
    let plane = |name: &str, dip: f64, direction: f64| {
        format!("Plane(name: \"{name}\", dip_deg: {dip}, dip_direction_deg: {direction}, point_m: (0, 0, 0))")
    };
    let beyond = |side: f64, dip: f64, direction: f64| {
        let n = side * normal(dip, direction);
        format!("Beyond(point_m: (0, 0, 0), normal: ({:e}, {:e}, {:e}))", n.x, n.y, n.z)
    };
    format!(
        "(title: \"wet wedge\", time: (end_s: 1), gravity_m_s2: (0, 0, -9.81),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
          rock: [(name: \"slope\", material: \"rock\", body: Rigid, domain: Box(min_m: (-24, -24, -4), max_m: (24, 24, 15)),
            joints: [{}, {}, {}], removed: [{}], fixed: [{}, {}])],
          water: [(on: Joint(\"J*\"), pressure: Linear(pressure_pa: 10e3))],
          contact: Potential(potential: Smooth(), friction: (friction_deg: 45)))",
        plane("face", 65.0, 120.0),
        plane("J1", 38.0, 115.0),
        plane("J2", 78.0, 30.0),
        beyond(1.0, 65.0, 120.0),
        beyond(-1.0, 38.0, 115.0),
        beyond(-1.0, 78.0, 30.0),
    )
}

fn to_error(text: &str, error: f64) -> Safety {
    let loaded = read::load_text("case.ron", text, &[], None);
    let complete = |loaded| choose::complete(loaded, Path::new("."));
    let loaded = loaded.and_then(complete).unwrap_or_else(|e| panic!("{}", e.render(false)));
    let (plan, stop) = (Plan { error, ..Plan::default() }, Arc::default());
    let watch = Watch { out: None, stop: &stop, tell: &|_| {} };
    safety::find(&loaded, ("case", Path::new(".")), &plan, &watch).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn answers_to_several_errors_contain_the_same_factor() {
    let (text, (exact, _)) = (scene("wedge"), limit_equilibrium([(40.0, 130.0), (60.0, 220.0)], 40.0));
    for error in [0.02, 0.05] {
        let (lower, upper) = bracket(&to_error(&text, error));
        row(
            "safety",
            &format!("wedge 40/130, 60/220 to an error of {error}: lower end [-]"),
            lower,
            AtMost(exact),
        );
        row(
            "safety",
            &format!("wedge 40/130, 60/220 to an error of {error}: upper end [-]"),
            upper,
            AtLeast(exact),
        );
    }
}

#[test]
fn a_slab_that_a_second_joint_guides_is_a_wedge_to_any_error() {
    let answers = [0.01, 0.02].map(|error| to_error(&wet_wedge(), error));
    let [(a, b), (c, d)] = [0, 1].map(|k| bracket(&answers[k]));
    assert!(a.max(c) <= b.min(d), "{a} to {b}, {c} to {d}");
    let line = normal(38.0, 115.0).cross(&normal(78.0, 30.0)).normalize();
    for answer in &answers {
        // Its line of 110.5°/37.9° is 4.5° from the dip direction of J1, on which 95 % of its weight rests.
        let direction = Vec3::from(answer.moving_blocks[0].direction);
        row(
            "safety",
            "direction of a wedge of which one joint carries little: cosine to its line [-]",
            direction.dot(&line).abs(),
            AtLeast(0.9994),
        );
        assert_eq!(kind(answer), Kind::Wedge, "{:?}", answer.moving_blocks);
    }
}
