//! What is refused or warned of because it would have no effect, or cannot be done.

#[allow(dead_code, reason = "other tests use more of it")]
mod common;

use std::path::Path;

use common::{exit, ndda};

/// Two cubes, one on the other; `body` is that of the upper one.
fn cubes(body: &str) -> String {
    let cube = |name: &str, z: u32, body: &str| {
        format!(
            "(name: \"{name}\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, {z})),"
        )
    };
    format!(
        "(title: \"cubes\", time: (end_s: 1e-3), gravity_m_s2: (0, 0, -9.81),
  materials: [(name: \"rock\", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
  blocks: [{} {}],
  contact: Potential(potential: Smooth(), friction: (friction_deg: 30)))",
        cube("lower", 0, "Fixed"),
        cube("upper", 1, body)
    )
}

/// Exit code of a call in a folder, and all that it says.
fn said(folder: &Path, words: &str) -> (i32, String) {
    let done = ndda().args(words.split(' ')).current_dir(folder).output().unwrap();
    let text = [done.stdout, done.stderr].map(|bytes| String::from_utf8(bytes).unwrap()).concat();
    (done.status.code().unwrap(), text)
}

fn folder_with(scenes: &[(&str, String)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in scenes {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

#[test]
fn a_scene_in_which_nothing_can_move_is_warned_of_and_not_certified_or_tuned() {
    let folder = folder_with(&[("still.ron", cubes("Fixed"))]);
    let (code, text) = said(folder.path(), "check still.ron");
    assert!(code == exit::DONE && text.contains("no block can move: every block is fixed"), "{text}");
    // The penalty that is chosen is no mistake of the scene, and no line has it.
    assert!(!text.contains("error[") && !text.contains("penalty_pa: "), "{text}");
    for words in ["certify still.ron", "tune still.ron --error 1e-2"] {
        let (code, text) = said(folder.path(), words);
        assert!(code == exit::BAD_INPUT && text.contains("error: no block can move"), "{words}: {text}");
    }
    let (_, text) = said(folder.path(), "picture still.ron --size 200x160");
    assert!(text.contains("0 of 2 blocks may move"), "{text}");
}

#[test]
fn names_that_no_column_begins_with_are_refused_before_anything_runs() {
    let folder = folder_with(&[("fall.ron", cubes("Rigid"))]);
    for words in ["certify fall.ron --of foo", "tune fall.ron --error 1e-2 --of foo"] {
        let (code, text) = said(folder.path(), words);
        assert!(code == exit::BAD_INPUT && text.contains("--of foo: no column"), "{words}: {text}");
        assert!(text.contains("block upper.displacement_x_m"), "{text}");
    }
    assert!(!folder.path().join("out/fall_certified/runs").exists());
}

#[test]
fn options_that_would_have_no_effect_are_refused() {
    let folder = folder_with(&[("fall.ron", cubes("Rigid"))]);
    const USAGE: i32 = 2;
    for (words, code, reason) in [
        ("plot out --log", USAGE, "--columns"),
        ("plot out --against time_s", USAGE, "--columns"),
        ("stereonet fall.ron --friction 30", USAGE, "--slope"),
        ("stereonet fall.ron --lateral 30", USAGE, "--slope"),
        ("mesh fall.ron --within 1e-3", USAGE, "--fix"),
        (
            "picture fall.ron --no-outlines",
            exit::BAD_INPUT,
            "--no-outlines is for the output folder of a run",
        ),
        ("study fall.ron --vary time.end_s=1,2 --seed x", USAGE, "write a whole number"),
        ("resume nofolder", exit::BAD_INPUT, "nofolder does not exist"),
        ("joint fall.ron --of bedding", exit::BAD_INPUT, "there is no joint of this name"),
    ] {
        let (found, text) = said(folder.path(), words);
        assert!(found == code && text.contains(reason), "{words}: {found} {text}");
    }
    for option in ["--amplitude 0.1", "--cycles 2", "--constant-volume", "--spring 1e9"] {
        let words = format!("joint --test closure --joint-stiffness 1e9 {option}");
        let (code, text) = said(folder.path(), &words);
        assert!(code == exit::BAD_INPUT && text.contains("has no effect on the closure"), "{option}: {text}");
    }
}

#[test]
fn an_option_that_a_command_does_not_have_is_not_advised_as_a_value() {
    let folder = folder_with(&[("fall.ron", cubes("Rigid"))]);
    for words in ["joint fall.ron --threads 2", "mesh fall.ron -o x"] {
        let (code, text) = said(folder.path(), words);
        assert!(code == 2 && text.contains("unexpected argument"), "{words}: {code} {text}");
        assert!(!text.contains("as a value"), "{words}: {text}");
    }
    let (_, text) = said(folder.path(), "run fall.ron --thread 2");
    assert!(text.contains("--threads"), "{text}");
}

#[test]
fn a_picture_of_another_kind_is_bad_input_whichever_command_draws_it() {
    let folder = folder_with(&[
        ("joints.csv", "dip_deg,dip_direction_deg\n40,130\n".into()),
        ("history.csv", "time_s,kinetic_j\n0,1\n1,2\n".into()),
    ]);
    for words in ["stereonet joints.csv -o net.jpg", "plot history.csv --columns kinetic -o net.jpg"] {
        let (code, text) = said(folder.path(), words);
        assert!(code == exit::BAD_INPUT && text.contains(".svg or .png"), "{words}: {code} {text}");
    }
}

#[test]
fn overrides_that_lead_nowhere_and_lines_of_a_table_that_are_wrong_are_told_at_once() {
    let folder = folder_with(&[
        ("fall.ron", cubes("Rigid")),
        ("joints.csv", "dip_deg,dip_direction_deg\n138,115\n38,500\nx,3\n40,20,J1\n".into()),
    ]);
    let words = "check fall.ron --set blocks[7].at_m=(0,0,0) --set time.end_s=1e-3,2 --set parameters.dip=3";
    let (code, text) = said(folder.path(), words);
    assert_eq!(code, exit::BAD_INPUT);
    assert_eq!(text.matches("error[override]").count(), 3, "{text}");
    let (code, text) = said(folder.path(), "stereonet joints.csv");
    assert_eq!(code, exit::BAD_INPUT);
    for line in ["line 2, column 1", "line 3, column 2", "line 4, column 1", "line 5 has 3 values"] {
        assert!(text.contains(line), "{line}: {text}");
    }
}

#[test]
fn blocks_are_measured_again_only_when_asked_to() {
    let folder = folder_with(&[("fall.ron", cubes("Rigid"))]);
    assert_eq!(said(folder.path(), "mesh fall.ron").0, exit::DONE);
    let (code, text) = said(folder.path(), "mesh fall.ron");
    assert!(code == exit::INPUT_OUTPUT && text.contains("--force"), "{text}");
    assert_eq!(said(folder.path(), "mesh fall.ron --force").0, exit::DONE);
}
