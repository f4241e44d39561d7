//! Every way in which a scene can be wrong, with the place that the message must point at.
//!
//! A case replaces a part of `scene.ron`; the mark `@` in the replacement is taken out and stands for the place.

use ndda_io::diagnostic::{Diagnostic, SceneErrors, Severity};
use ndda_io::read::load_text;
use proptest::prelude::*;

const SCENE: &str = include_str!("scene.ron");

/// The scene with `old` replaced by `new` (its mark taken out), and the byte of the mark.
fn broken(old: &str, new: &str) -> (String, usize) {
    assert_eq!(SCENE.matches(old).count(), 1, "{old:?} must be in the scene once");
    let marked = SCENE.replace(old, new);
    let at = marked.find('@').unwrap_or_else(|| panic!("no mark in {new:?}"));
    (marked.replacen('@', "", 1), at)
}

fn refused(text: &str) -> SceneErrors {
    match load_text("s.ron", text, &[], None) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(errors) => errors,
    }
}

fn line_of(diagnostic: &Diagnostic, text: &str) -> Option<usize> {
    diagnostic.line_column(text).map(|(line, _)| line)
}

/// Every case is refused with an error on the line of the mark, which is shown as `s.ron:line:column`.
fn assert_refused(cases: &[(&str, &str)]) {
    let mut missed = Vec::new();
    for (old, new) in cases {
        let (text, at) = broken(old, new);
        let Err(errors) = load_text("s.ron", &text, &[], None) else {
            missed.push(format!("{new:?} is accepted"));
            continue;
        };
        let line = 1 + text[..at].matches('\n').count();
        let hit = errors
            .diagnostics
            .iter()
            .any(|d| d.severity == Severity::Error && line_of(d, &text) == Some(line));
        assert!(!errors.to_string().contains('\u{1b}'), "colours in a text that asked for none");
        if !hit {
            missed.push(format!("{new:?} must be refused in line {line}, not as\n{errors}"));
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

#[test]
fn the_unbroken_scene_is_clean() {
    let loaded = load_text("s.ron", SCENE, &[], None).unwrap_or_else(|errors| panic!("{errors}"));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
}

#[test]
fn water_that_cannot_be_is_pointed_at() {
    let part = "on: Part(block: \"slider\", region: Set(\"z_min\"))";
    let water =
        |on: &str, pressure: &str| format!("water: [({on}, pressure: {pressure})],\n    contact: Potential(");
    let cases = [
        water("on: @Joint(\"bedding\")", "Level(at_m: (0, 0, 1))"),
        water("on: Part(block: @\"slidr\", region: All)", "Level(at_m: (0, 0, 1))"),
        water(part, "Level(at_m: (0, 0, 1), density_kg_m3: @0)"),
        water(part, "Points(along: @(0, 0, 0), rows: [(0, 0)])"),
        water(part, "Points(along: (1, 0, 0), rows: @[])"),
        water(part, "Points(along: (1, 0, 0), rows: [(1, 0), @(1, 2)])"),
        water(part, "Points(along: (1, 0, 0), rows: [@(1, -5)])"),
        water(part, "@Least([])"),
        water(part, "Linear(pressure_pa: 1, gradient_pa_m: @(1e308, inf, 0))"),
    ];
    let cases: Vec<(&str, &str)> = cases.iter().map(|new| ("contact: Potential(", new.as_str())).collect();
    assert_refused(&cases);
}

#[test]
fn names_that_do_not_exist_are_pointed_at() {
    assert_refused(&[
        ("    title:", "    @titel:"),
        ("step_s: 1e-4", "@step: 1e-4"),
        ("poisson: 0.25, density_kg_m3", "poisson: 0.25, @density"),
        ("size_m: (1", "@size: (1"),
        ("(theta: 0.5)", "(@tetha: 0.5)"),
        ("(xx: -1e5)", "(@xx_pa: -1e5)"),
        ("Midpoint(", "@MidPoint("),
        ("Box(", "@Cube("),
        ("pattern: TwentyFour", "pattern: @Twenty"),
        ("hold: Fixed", "hold: @fixed"),
        ("on: All", "on: @Everything"),
        ("Potential(", "@Potenzial("),
        ("SlidingBlock(", "@SlideBlock("),
    ]);
}

#[test]
fn missing_fields_are_pointed_at_in_their_struct() {
    assert_refused(&[
        ("(\n    title: \"A block slides down a ramp\",\n", "@(\n"),
        ("time: (step_s: 1e-4, end_s: 0.5", "time: @(step_s: 1e-4"),
        ("(name: \"rock\", young_pa: 20e9, ", "@(name: \"rock\", "),
        ("Box(size_m: (1, 1, 0.5), ", "@Box("),
        ("(friction_deg: 25, shear_penalty_pa_m: 2e9)", "@(shear_penalty_pa_m: 2e9)"),
        ("(time_s: 0.1, displacement_m: (0, 0, 0.1))", "@(time_s: 0.1)"),
        ("reference: SlidingBlock(\n        monitor: \"centre\",", "reference: @SlidingBlock("),
        ("        (\n            name: \"slider\",", "        @("),
    ]);
}

#[test]
fn duplicate_fields_are_pointed_at_where_they_repeat() {
    assert_refused(&[
        ("    gravity_m_s2:", "    @title: \"again\",\n    gravity_m_s2:"),
        ("end_s: 0.5", "end_s: 0.5, @step_s: 1e-3"),
        ("(xx: -1e5)", "(xx: -1e5, yy: 0, @xx: 0)"),
    ]);
}

#[test]
fn wrong_types_are_pointed_at() {
    assert_refused(&[
        ("step_s: 1e-4", "step_s: @\"1e-4\""),
        ("step_s: 1e-4", "step_s: @fast"),
        ("title: \"A block slides down a ramp\"", "title: @5"),
        ("block: \"slider\", on: All", "block: @slider, on: All"),
        ("(0, 0, -9.8)", "@[0, 0, -9.8]"),
        ("(0, 0, -9.8)", "@(0, -9.8)"),
        ("(0, 0, -9.8)", "(0, 0, -9.8, @0)"),
        ("(0, 0, -9.8)", "@-9.8"),
        ("cells: (2, 2, 1)", "cells: (2, @-2, 1)"),
        ("cells: (2, 2, 1)", "cells: (2, @5000000000, 1)"),
        ("frames: 10", "frames: @1.5"),
        ("Direction((0, 1, 0))", "Direction(@0, 1, 0)"),
        ("time: (step_s", "time: @Tim(step_s"),
        ("shape: Box(", "shape: @("),
    ]);
}

#[test]
fn broken_text_is_pointed_at_where_it_breaks() {
    assert_refused(&[
        ("step_s: 1e-4, end_s", "step_s: 1e-4 @end_s"),
        ("step_s: 1e-4,", "step_s: 1e-4 @;"),
        ("    materials: [", "    materials: [ @]]"),
        ("// A block", "@/* A block"),
        ("step_s: 1e-4", "step_s: @1.2.3"),
        ("step_s: 1e-4", "step_s: @1e-4s"),
        ("step_s: 1e-4", "step_s@ 1e-4"),
        ("step_s: 1e-4", "step_s: @, end_s: 3"),
    ]);
}

#[test]
fn values_out_of_range_are_pointed_at() {
    assert_refused(&[
        ("density_kg_m3: 2650", "density_kg_m3: @0"),
        ("density_kg_m3: 2650", "density_kg_m3: @-2650"),
        ("young_pa: 20e9", "young_pa: @-20e9"),
        ("poisson: 0.25", "poisson: @0.5"),
        ("poisson: 0.25", "poisson: @-1"),
        ("friction: (friction_deg: 25", "friction: (friction_deg: @-1"),
        ("friction: (friction_deg: 25", "friction: (friction_deg: @90"),
        ("penalty_pa: 2e6", "penalty_pa: @0"),
        ("shear_penalty_pa_m: 2e9", "shear_penalty_pa_m: @0"),
        ("step_s: 1e-4", "step_s: @0"),
        ("step_s: 1e-4", "step_s: @-1e-4"),
        ("step_s: 1e-4", "step_s: @1e-10"),
        ("(theta: 0.5)", "(theta: @0.49)"),
        ("(theta: 0.5)", "(theta: @1.01)"),
        ("Midpoint(theta: 0.5)", "Newmark(alpha: @0.25, delta: 1)"),
        ("Midpoint(theta: 0.5)", "Newmark(alpha: @0, delta: 1)"),
        ("Midpoint(theta: 0.5)", "Newmark(alpha: 0.5, delta: @0.4)"),
        ("size_m: (1, 1, 0.5)", "size_m: (1, @0, 0.5)"),
        ("cells: (2, 2, 1)", "cells: (2, 2, @0)"),
        ("cells: (2, 2, 1)", "cells: @(1000, 1000, 100)"),
        ("cells: (4, 2)", "cells: (@0, 2)"),
        ("height_m: 2", "height_m: @-2"),
        ("((0, 0), (4, 0), (0, 4))", "@((0, 0), (0, 4), (4, 0))"),
        ("((0, 0), (4, 0), (0, 4))", "@((0, 0), (4, 0), (8, 0))"),
        ("axis: (1, 0, 0)", "axis: @(0, 0, 0)"),
        ("axis: (1, 0, 0)", "axis: @(1e-200, 0, 0)"),
        ("normal: (0, 0, 1)", "normal: @(0, 0, 0)"),
        ("hold: Direction((0, 1, 0))", "hold: @Direction((0, 0, 0))"),
        ("stiffness_n_m: 1e15", "stiffness_n_m: @-1"),
        ("velocity_m_s: (0, 0, 0)", "velocity_m_s: @(1e200, 0, 0)"),
        ("end_s: 0.5", "end_s: @1e-5"),
    ]);
}

#[test]
fn joints_that_cannot_be_are_pointed_at() {
    assert_refused(&[
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, roughness: (jrc: @25, jcs_pa: 1e8)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, roughness: (jrc: 10, jcs_pa: @0)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, roughness: (jrc: 10, jcs_pa: 1e8, sample_m: @0)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, roughness: (jrc: 10, jcs_pa: 1e8, length_m: @-1)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, roughness: (jrc: 10, jcs_pa: 1e8, strength_factor: @0)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, residual: (friction_deg: 20, opening_m: @-1)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, cohesion_pa: 1e5, roughness: @(jrc: 10, jcs_pa: 1e8)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, dilation: (psi_deg: @26, to_slip_m: 0.01)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, residual: (friction_deg: 20), dilation: (psi_deg: @21, to_slip_m: 0.01)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, dilation: (psi_deg: 10, to_slip_m: @-0.01)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, dilation: @(psi_deg: 10, to_slip_m: 0.01)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, roughness: (jrc: 10, jcs_pa: 1e8, dilates: @true)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, roughness: (jrc: 10, jcs_pa: 1e8), dilation: @(psi_deg: 10, to_slip_m: 0.01)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, roughness: @(jrc: 10, jcs_pa: 1e8)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, dilation: @(psi_deg: 10, to_slip_m: 0.01)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, cohesion_pa: 2e5, tension_pa: 1e5, fracture: (tension_j_m2: @2, shear_j_m2: 20)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, cohesion_pa: 2e5, tension_pa: 1e5, fracture: (tension_j_m2: 20, shear_j_m2: @9)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, shear_penalty_pa_m: 2e9, cohesion_pa: 2e5, fracture: @(tension_j_m2: 20, shear_j_m2: 20)",
        ),
        (
            "(friction_deg: 25, shear_penalty_pa_m: 2e9",
            "(friction_deg: 25, fracture: @(tension_j_m2: 1, shear_j_m2: 1)",
        ),
        ("penalty_pa: 2e6", "penalty_pa: 2e6, potential: Closure(max_closure_m: @0)"),
    ]);
}

#[test]
fn references_to_nothing_are_pointed_at() {
    assert_refused(&[
        ("material: \"rock\"", "material: @\"rok\""),
        ("block: \"slider\", on: All", "block: @\"slidr\", on: All"),
        ("[(block: \"slider\", on: Set", "[(block: @\"x\", on: Set"),
        ("name: \"corner\", block: \"slider\"", "name: \"corner\", block: @\"slide\""),
        ("monitor: \"centre\"", "monitor: @\"center\""),
        ("(name: \"corner\"", "(name: @\"centre\""),
        ("(name: \"corner\"", "(name: @\"\""),
        ("(name: \"corner\"", "(name: @\"../x\""),
        ("(name: \"corner\"", "(name: @\"a,b\""),
        ("(name: \"corner\"", "(name: @\"a\\\"b\""),
        ("(name: \"corner\"", "(name: @\"a\\nb\""),
        ("(name: \"corner\"", "(name: @\"..\""),
        ("(name: \"steel\"", "(name: @\"rock\""),
        ("            name: \"slider\"", "            name: @\"ramp\""),
    ]);
}

#[test]
fn parts_that_do_not_fit_together_are_pointed_at() {
    assert_refused(&[
        ("hold: Direction((0, 1, 0))", "hold: @Normal"),
        ("            (time_s: 0, ", "            (time_s: @-1, "),
        ("(time_s: 0.1, ", "(time_s: @0, "),
        ("slope_deg: 45", "slope_deg: @90"),
        ("downhill: (1, 0, -1)", "downhill: @(0, 0, 0)"),
        ("slope_deg: 45, friction_deg: 25", "slope_deg: 45, friction_deg: @45"),
        ("thickness_m: 0.5", "thickness_m: @0"),
        ("after_s: 0.1", "after_s: @0.5"),
        ("after_s: 0.1", "after_s: @-0.1"),
    ]);
}

#[test]
fn numbers_that_are_none_are_all_pointed_at() {
    for number in ["NaN", "-NaN", "inf", "-inf", "1e400", "-1e400"] {
        for old in ["1e-4", "-1e5", "1e15", "density_kg_m3: 2650"] {
            let key = old.rfind(' ').map_or("", |i| &old[..=i]);
            assert_refused(&[(old, &format!("{key}@{number}"))]);
        }
    }
}

#[test]
fn all_errors_of_meaning_come_at_once_in_the_order_of_the_file() {
    let text = SCENE
        .replace("step_s: 1e-4", "step_s: 0")
        .replace("20e9", "-1")
        .replace("poisson: 0.3", "poisson: 0.7")
        .replace("material: \"rock\"", "material: \"rok\"")
        .replace("normal: (0, 0, 1)", "normal: (0, 0, 0)")
        .replace("penalty_pa: 2e6", "penalty_pa: -2");
    let errors = refused(&text);
    let places = errors.diagnostics.iter().filter(|d| d.severity == Severity::Error);
    let lines: Vec<usize> = places.filter_map(|d| line_of(d, &text)).collect();
    assert_eq!(lines, [4, 7, 8, 19, 28, 36], "{errors}");
}

#[test]
fn every_truncation_is_refused() {
    let last = SCENE.rfind(')').unwrap();
    for end in (0..=last).filter(|end| SCENE.is_char_boundary(*end)) {
        assert!(load_text("s.ron", &SCENE[..end], &[], None).is_err(), "cut after {}", &SCENE[..end]);
    }
}

#[test]
fn deep_nesting_is_refused_without_panic() {
    for text in ["[".repeat(50_000), "(a:".repeat(50_000), "Some(".repeat(50_000), "{1:".repeat(50_000)] {
        assert!(load_text("s.ron", &text, &["a.b=1".into()], None).is_err());
        assert!(load_text("s.ron", SCENE, &[format!("title={text}")], None).is_err());
    }
}

/// Reads and shows; nothing may panic.
fn read(text: &str, overrides: &[String]) {
    if let Err(errors) = load_text("s.ron", text, overrides, None) {
        assert!(!errors.diagnostics.is_empty());
        assert!(errors.to_string().contains("s.ron"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn changed_bytes_do_not_panic(changes in prop::collection::vec((0usize..4000, any::<u8>(), 0u8..3), 1..6)) {
        let mut bytes = SCENE.as_bytes().to_vec();
        for (at, byte, how) in changes {
            let at = at % bytes.len();
            match how {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                _ => drop(bytes.remove(at)),
            }
        }
        read(&String::from_utf8_lossy(&bytes), &["time.step_s=1e-3".to_string(), "output.frames=5".to_string()]);
    }

    #[test]
    fn any_override_does_not_panic(path in "[a-z_.\\[\\]\"0-9=]{0,20}", value in "\\PC{0,12}", head in 0usize..6) {
        let heads = ["", "time.", "blocks[1].", "blocks.slider.shape.", "supports[2].hold", "contact.friction."];
        let source = format!("{}{path}={value}", heads[head]);
        read(SCENE, &[source.clone(), "time.end_s=0.6".to_string(), source]);
    }
}
