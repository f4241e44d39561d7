//! A penalty and a step that a scene leaves out are chosen, said with their reason, and are as if they were written.

use std::fs;
use std::path::Path;

mod common;

use common::{exit, ndda};
use serde_json::Value;

/// A cube of 1 m that is put on a plate, 2 m high altogether.
const SCENE: &str = "(
    title: \"A cube on a plate\", time: (end_s: 0.2), gravity_m_s2: (0, 0, -10),
    materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
    blocks: [
        (name: \"plate\", material: \"rock\", body: Fixed, shape: Box(size_m: (3, 3, 1), cells: (1, 1, 1))),
        (name: \"cube\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (1, 1, 1)),
    ],
    contact: Potential(potential: Smooth(), friction: (friction_deg: 30)),
    monitors: [(name: \"m\", block: \"cube\")], output: (frames: 0),
)";

fn said(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let done = ndda().args(arguments).current_dir(folder).output().unwrap();
    let text = [done.stderr, done.stdout].concat();
    (done.status.code().unwrap(), String::from_utf8(text).unwrap())
}

fn folder(scene: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("s.ron"), scene).unwrap();
    folder
}

fn summary(run: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(run.join("summary.json")).unwrap()).unwrap()
}

fn run(folder: &Path, out: &str, sets: &[&str]) -> Value {
    let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
    let (code, text) = said(folder, &[&["run", "s.ron", "--out", out, "--quiet"], &sets[..]].concat());
    assert_eq!(code, exit::DONE, "{text}");
    summary(&folder.join(out))
}

#[test]
fn blocks_lie_in_each_other_by_the_part_of_their_size_that_is_asked_for() {
    let folder = folder(SCENE);
    for (ratio, penalty) in [(1e-4, 5e8), (1e-3, 5e7)] {
        let found = run(folder.path(), &format!("{ratio:e}"), &[&format!("contact.depth_ratio={ratio:e}")]);
        // L₀ ρ 2 g H/(2 ε s) with H = 2 m, s = 1 m: 5e4/ε, rounded up.
        assert_eq!(found["chosen"][0]["path"], "contact.penalty_pa");
        assert_eq!(found["chosen"][0]["value"].as_f64(), Some(penalty), "{found}");
        // At rest ρ g s L₀/(2 k_n), of which gravity that comes suddenly makes twice as much.
        let at_rest_m = 2500.0 * 10.0 / (2.0 * penalty);
        let table = fs::read_to_string(folder.path().join(format!("{ratio:e}/history.csv"))).unwrap();
        let mut rows = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let place = rows.next().unwrap().iter().position(|name| *name == "m.displacement_z_m").unwrap();
        let depth_m = rows.map(|row| -row[place].parse::<f64>().unwrap()).fold(0.0, f64::max);
        assert!((depth_m / (2.0 * at_rest_m) - 1.0).abs() < 0.05, "{depth_m} {at_rest_m}");
        assert!(at_rest_m <= ratio, "{at_rest_m}");
    }
}

#[test]
fn what_is_chosen_is_as_if_it_were_written() {
    let folder = folder(SCENE);
    let chosen = run(folder.path(), "chosen", &[]);
    let values: Vec<String> = chosen["chosen"]
        .as_array()
        .unwrap()
        .iter()
        .map(|c| format!("{}={}", c["path"].as_str().unwrap(), c["value"]))
        .collect();
    assert_eq!(values.len(), 2);
    let sets: Vec<&str> = values.iter().map(String::as_str).collect();
    let written = run(folder.path(), "written", &sets);
    assert!(written["chosen"].is_null());
    assert_eq!(written["state_crc32"], chosen["state_crc32"]);
    // Into the file, with the reason; nothing else in it changes.
    let (code, text) = said(folder.path(), &["check", "s.ron", "--write"]);
    assert!(
        code == exit::DONE && text.contains("chosen: contact.penalty_pa = 5e8 (blocks of 1.00 m"),
        "{text}"
    );
    assert!(
        text.contains("chosen: time.step_s = ") && text.contains("stable step of contact, at block `cube`"),
        "{text}"
    );
    let file = fs::read_to_string(folder.path().join("s.ron")).unwrap();
    assert!(
        file.contains("end_s: 0.2, step_s: ") && file.contains("penalty_pa: 5e8 /* blocks of 1.00 m"),
        "{file}"
    );
    let again = run(folder.path(), "again", &[]);
    assert_eq!((&again["state_crc32"], &again["chosen"]), (&chosen["state_crc32"], &Value::Null));
    let (_, text) = said(folder.path(), &["check", "s.ron", "--write"]);
    assert!(!text.contains("chosen"), "{text}");
    assert_eq!(fs::read_to_string(folder.path().join("s.ron")).unwrap(), file);
}

#[test]
fn a_run_goes_on_with_what_was_chosen() {
    let folder = folder(&SCENE.replace("frames: 0", "frames: 0, checkpoint_wall_s: 0"));
    let whole = run(folder.path(), "whole", &[]);
    let (code, text) = said(folder.path(), &["resume", "whole", "--quiet"]);
    assert_eq!(code, exit::DONE, "{text}");
    assert_eq!(summary(&folder.path().join("whole"))["state_crc32"], whole["state_crc32"]);
}

#[test]
fn cases_of_a_study_share_what_is_chosen_for_its_scene() {
    let folder = folder(SCENE);
    let vary = [
        "study",
        "s.ron",
        "--vary",
        "gravity_m_s2[2]=-10,-40",
        "--of",
        "m.displacement_z_m,label",
        "--quiet",
    ];
    let (code, text) = said(folder.path(), &vary);
    assert_eq!(code, exit::DONE, "{text}");
    let logs = ["-10", "-40"].map(|gravity| {
        let run = folder.path().join(format!("out/s_study/cases/2={gravity}/run"));
        fs::read_to_string(run.join("run.log")).unwrap_or_else(|_| panic!("{}: {text}", run.display()))
    });
    assert!(logs.iter().all(|log| log.contains("penalty_pa: 5e8")), "{}", logs[1]);
}

#[test]
fn a_step_follows_speeds_loads_and_the_length_of_a_run_where_nothing_touches() {
    for (change, step, reason) in [
        (("end_s: 0.2", "end_s: 1"), 1e-2, "a hundredth of the run"),
        (("body: Rigid", "body: Rigid, velocity_m_s: (50, 0, 0)"), 1e-3, "move by a tenth of the height"),
        (("body: Rigid", "body: Rigid, spin_rad_s: (0, 0, 100)"), 5e-4, "rotate by 0.05 rad"),
        (("gravity_m_s2", "gravity_ramp_s: 0.01, gravity_m_s2"), 1e-3, "a tenth of gravity_ramp_s"),
    ] {
        let scene = SCENE
            .replacen(change.0, change.1, 1)
            .replace("Potential(potential: Smooth(), friction: (friction_deg: 30))", "Off");
        let folder = folder(&scene);
        let (code, text) = said(folder.path(), &["check", "s.ron"]);
        assert!(code == exit::DONE && text.contains(&format!("time.step_s = {step:e} (")), "{text}");
        assert!(text.contains(reason), "{text}");
    }
}

#[test]
fn a_penalty_that_cannot_be_chosen_is_asked_for() {
    let folder = folder(&SCENE.replace("Smooth()", "Volume(reference_m3: 1)"));
    let (code, text) = said(folder.path(), &["check", "s.ron"]);
    assert!(code == exit::BAD_INPUT && text.contains("of the potential `Volume` is not chosen"), "{text}");
    let (code, text) = said(folder.path(), &["check", "s.ron", "--set", "contact.depth_ratio=1"]);
    assert!(code == exit::BAD_INPUT && text.contains("must be from 1e-9 to 0.1"), "{text}");
}
