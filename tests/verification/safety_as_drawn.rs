//! Scenes that do not stand as they are drawn, and answers to several errors.

use std::path::Path;
use std::sync::Arc;

use ndda::safety::{self, Kind, Plan, Question, Safety, Watch};
use ndda_io::read;
use ndda_mesh::Vec3;

use crate::evidence::Answer::{AtLeast, AtMost};
use crate::evidence::row;
use crate::safety_factor::{bracket, found, holds, kind, normal, scene};

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
            "does not stand as drawn, even with joints 32 times as strong: factor of safety below 0.031"
        ),
        "{told}"
    );
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

const DIPS: [(f64, f64); 3] = [(38.0, 115.0), (78.0, 30.0), (65.0, 120.0)];
const HEIGHT_M: f64 = 15.0;
const DENSITY_KG_M3: f64 = 2650.0;
const PRESSURE_PA: f64 = 10e3;
const FRICTION_DEG: f64 = 45.0;

/// A wedge between two joints and a face, all through the origin, with the same pressure of water on both joints.
fn wet_wedge() -> String {
    let plane = |name: &str, (dip, direction): (f64, f64)| {
        format!("Plane(name: \"{name}\", dip_deg: {dip}, dip_direction_deg: {direction}, point_m: (0, 0, 0))")
    };
    let beyond = |side: f64, (dip, direction): (f64, f64)| {
        let n = side * normal(dip, direction);
        format!("Beyond(point_m: (0, 0, 0), normal: ({:e}, {:e}, {:e}))", n.x, n.y, n.z)
    };
    let [a, b, face] = DIPS;
    format!(
        "(title: \"wet wedge\", time: (end_s: 1), gravity_m_s2: (0, 0, -9.81),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: {DENSITY_KG_M3})],
          rock: [(name: \"slope\", material: \"rock\", body: Rigid, domain: Box(min_m: (-130, -130, -4), max_m: (30, 30, {HEIGHT_M})),
            joints: [{}, {}, {}], removed: [{}], fixed: [{}, {}])],
          water: [(on: Joint(\"J*\"), pressure: Linear(pressure_pa: {PRESSURE_PA:e}))],
          contact: Potential(potential: Smooth(), friction: (friction_deg: {FRICTION_DEG})))",
        plane("face", face),
        plane("J1", a),
        plane("J2", b),
        beyond(1.0, face),
        beyond(-1.0, a),
        beyond(-1.0, b),
    )
}

/// Limit equilibrium of it: tan φ (N₁ + N₂) over the weight along the line, with N₁ and N₂ beside the water from the balance across the line.
fn exact() -> f64 {
    let normals = DIPS.map(|(dip, direction)| normal(dip, direction));
    // Corners at the top of the slope, on the lines in which each two planes meet.
    let corner = |i: usize, j: usize| {
        let line: Vec3 = normals[i].cross(&normals[j]);
        line * (HEIGHT_M / line.z)
    };
    let [crest, on_a, on_b] = [corner(0, 1), corner(0, 2), corner(1, 2)];
    let volume_m3 = crest.dot(&on_a.cross(&on_b)).abs() / 6.0;
    let water_n = PRESSURE_PA * 0.5 * crest.cross(&on_a).norm() * normals[0]
        + PRESSURE_PA * 0.5 * crest.cross(&on_b).norm() * normals[1];
    let weight_n = -9.81 * DENSITY_KG_M3 * volume_m3 * Vec3::z();
    let line = crest.normalize();
    let load_n = weight_n + water_n;
    let across = load_n - load_n.dot(&line) * line;
    let cos = normals[0].dot(&normals[1]);
    let [p, q] = [0, 1].map(|k| -across.dot(&normals[k]));
    let pushes_n = [(p - cos * q) / (1.0 - cos * cos), (q - cos * p) / (1.0 - cos * cos)];
    assert!(pushes_n.iter().all(|push_n| *push_n > 0.0), "both joints are pressed: {pushes_n:?}");
    FRICTION_DEG.to_radians().tan() * (pushes_n[0] + pushes_n[1]) / load_n.dot(&line).abs()
}

fn to_error(text: &str, error: f64) -> Safety {
    let loaded =
        read::load_text("case.ron", text, &[], None).unwrap_or_else(|e| panic!("{}", e.render(false)));
    let (plan, stop) = (Plan { error, ..Plan::default() }, Arc::default());
    let watch = Watch { out: None, stop: &stop, tell: &|_| {} };
    safety::find(&loaded, ("case", Path::new(".")), &plan, &watch).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn answers_to_several_errors_agree_and_name_the_wedge() {
    let (text, exact) = (wet_wedge(), exact());
    for error in [0.01, 0.02, 0.05] {
        let safety = to_error(&text, error);
        let (lower, upper) = bracket(&safety);
        row("safety", &format!("wet wedge to an error of {error}: lower end [-]"), lower, AtMost(exact));
        row("safety", &format!("wet wedge to an error of {error}: upper end [-]"), upper, AtLeast(exact));
        // Its line of 110.5°/37.9° is 4.5° from the dip direction of J1, on which 95 % of its weight rests.
        assert_eq!(kind(&safety), Kind::Wedge, "{:?}", safety.moving_blocks);
    }
}
