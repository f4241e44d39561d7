//! A run goes on only with the files that it began with, and no run begins where it would harm others.

#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const BAD_INPUT: i32 = 3;
const INPUT_OUTPUT: i32 = 5;

/// A tetrahedron from a file that is shaken by a record.
const SCENE: &str = "(title: \"t\", time: (step_s: 1e-3, end_s: 0.05),
    include: \"rock.ron\",
    blocks: [(name: \"a\", material: \"rock\", shape: Mesh(file: \"a.ele\"), body: Fixed)],
    supports: [(block: \"a\", on: All, hold: Acceleration(file: \"quake.csv\", direction: (1, 0, 0)))],
    output: (frames: 10))";
const FILES: [(&str, &str); 5] = [
    ("scene.ron", SCENE),
    ("rock.ron", "[(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2500)]"),
    ("a.node", "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n"),
    ("a.ele", "1 4 0\n0 0 1 2 3\n"),
    ("quake.csv", "time_s,acceleration_m_s2\n0,0\n0.02,1\n0.05,-1\n"),
];

fn place() -> tempfile::TempDir {
    let place = tempfile::tempdir().expect("a folder");
    for (name, text) in FILES {
        fs::write(place.path().join(name), text).expect("a file");
    }
    place
}

fn ndda(place: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ndda"));
    command.args(arguments).arg("--quiet").current_dir(place).output().expect("the program starts")
}

/// A run that has no summary yet, as if it had been killed after its last checkpoint.
fn killed(place: &Path) {
    let done = ndda(place, &["run", "scene.ron", "--out", "out", "--force"]);
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
    fs::remove_file(place.join("out/summary.json")).expect("a summary");
}

#[track_caller]
fn assert_says(output: &Output, code: i32, words: &[&str]) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{said}");
    assert!(words.iter().all(|word| said.contains(word)), "{words:?} in: {said}");
}

#[test]
fn a_mesh_record_or_material_that_has_changed_or_gone_is_refused_by_its_name() {
    let place = place();
    let place = place.path();
    killed(place);
    for name in ["a.node", "a.ele", "quake.csv", "rock.ron"] {
        let path = place.join(name);
        let old = fs::read_to_string(&path).expect("a file");
        // As long as before, and as good a file.
        let other = if name == "a.ele" { old.replace("0 1 2 3", "1 2 0 3") } else { old.replace('1', "2") };
        assert_ne!(old, other);
        fs::write(&path, other).expect("a file");
        assert_says(&ndda(place, &["resume", "out"]), BAD_INPUT, &[name, "has changed"]);
        fs::remove_file(&path).expect("a file");
        assert_says(&ndda(place, &["resume", "out"]), BAD_INPUT, &[name, "is missing"]);
        fs::write(&path, old).expect("a file");
    }
    fs::write(place.join("a.face"), "1 1\n0 0 1 2 7\n").expect("a file");
    assert_says(&ndda(place, &["resume", "out"]), BAD_INPUT, &["a.face", "has changed"]);
    fs::remove_file(place.join("a.face")).expect("a file");
    assert_says(&ndda(place, &["resume", "out"]), 0, &[]);
}

#[test]
fn frames_that_are_lost_are_named() {
    let place = place();
    let place = place.path();
    killed(place);
    fs::remove_file(place.join("out/fields/frame_000003.vtu")).expect("a frame");
    fs::write(place.join("out/fields/frame_000005.vtu"), "").expect("a frame");
    let words = ["frame_000003.vtu, frame_000005.vtu", "put them back"];
    assert_says(&ndda(place, &["resume", "out"]), INPUT_OUTPUT, &words);
    fs::remove_dir_all(place.join("out/fields")).expect("frames");
    assert_says(&ndda(place, &["resume", "out"]), INPUT_OUTPUT, &["frame_000000.vtu", "and 6 more"]);
}

#[test]
fn a_checkpoint_of_an_older_format_is_refused_with_what_to_do() {
    let place = place();
    let place = place.path();
    killed(place);
    let path = place.join("out/checkpoint.ndda");
    let mut bytes = fs::read(&path).expect("a checkpoint");
    bytes[16..20].copy_from_slice(&5u32.to_le_bytes());
    let end = bytes.len() - 4;
    let sum = crc32fast::hash(&bytes[..end]).to_le_bytes();
    bytes[end..].copy_from_slice(&sum);
    fs::write(&path, bytes).expect("a checkpoint");
    fs::remove_file(place.join("out/checkpoint.previous.ndda")).expect("a checkpoint");
    assert_says(&ndda(place, &["resume", "out"]), BAD_INPUT, &["is of format 5", "the ndda that wrote it"]);
}

#[test]
fn a_record_beyond_all_numbers_is_an_error_of_input_with_its_time() {
    let place = place();
    let place = place.path();
    for value in ["1e308", "-1e300", "1e155"] {
        let text = format!("time_s,acceleration_m_s2\n0,0\n0.02,1\n0.05,{value}\n");
        fs::write(place.join("quake.csv"), text).expect("a record");
        let words = ["quake.csv: the ground would move faster than light from 0.05 s on"];
        assert_says(&ndda(place, &["run", "scene.ron", "--out", "out"]), BAD_INPUT, &words);
    }
}

#[test]
fn no_run_begins_in_a_folder_that_is_not_for_results_even_if_forced() {
    let place = place();
    let place = place.path();
    let home = place.join("home");
    fs::create_dir(&home).expect("a folder");
    let run = |out: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_ndda"));
        command.args(["run", "scene.ron", "--force", "--quiet", "--out", out]).current_dir(place);
        command.env("HOME", &home).output().expect("the program starts")
    };
    assert_says(&run("/"), INPUT_OUTPUT, &["/ is not a folder for results"]);
    assert_says(&run("home"), INPUT_OUTPUT, &["home is not a folder for results"]);
    assert_says(&run("."), INPUT_OUTPUT, &["a.ele", "choose another folder"]);
    let before: Vec<_> = fs::read_dir(place).expect("a folder").collect();
    assert_eq!(before.len(), FILES.len() + 1, "nothing is written");
    assert_says(&run("out"), 0, &[]);
    assert_says(&run("out"), 0, &[]);
}
