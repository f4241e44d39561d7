//! Scenes of ndda with parts of other people: to the end, and resumed after a kill to the same bits.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name)
}

/// Field of a run's summary.
fn summary(folder: &Path, field: &str) -> String {
    let text = std::fs::read_to_string(folder.join("summary.json")).expect("a summary");
    let after = text.split(&format!("\"{field}\":")).nth(1).unwrap_or_else(|| panic!("no {field} in {text}"));
    after.trim_start().split([',', '\n', '}']).next().unwrap_or("").trim_matches('"').to_owned()
}

fn fork(words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fork"));
    command.args(words).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn run(part: &str, scene: &Path, folder: &Path, set: &[&str]) {
    let words = [&[part, "run", scene.to_str().unwrap(), folder.to_str().unwrap()], set].concat();
    let output = fork(&words).output().expect("the program runs");
    assert!(output.status.success(), "{part}: {}", String::from_utf8_lossy(&output.stderr));
}

/// A place for the files of a test.
fn place(name: &str) -> PathBuf {
    let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&place);
    std::fs::create_dir_all(&place).expect("a folder");
    place
}

/// Begins a run and kills it once it has replaced its first checkpoint.
fn kill_on_its_way(words: &[&str], folder: &Path) {
    let mut child = fork(words).spawn().expect("the program runs");
    while !folder.join("checkpoint.previous.ndda").exists() && child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(1));
    }
    let _ = child.kill();
    child.wait().unwrap();
}

const RAMP: &str = "sliding_45_phi35_spring.ron";
const COLLISION: &str = "collision_equal_free.ron";

/// The longest scene that each part can run: points that repel each other have no ramp.
fn longest_scene_of(part: &str) -> &'static str {
    if part == "point-springs" { COLLISION } else { RAMP }
}

#[test]
fn every_part_runs_the_collision_to_the_end() {
    for part in fork::PARTS {
        let folder = place(&format!("{part}-collision"));
        run(part, &scene(COLLISION), &folder, &[]);
        assert_eq!(summary(&folder, "status"), "done", "{part}");
    }
}

#[test]
fn a_broad_phase_of_other_people_gives_the_same_bits() {
    let (grid, rock) = (place("with-grid"), place("with-rock"));
    run("grid", &scene(RAMP), &grid, &[]);
    run("hardening-rock", &scene(RAMP), &rock, &[]);
    let ours = ndda::Run::new(ndda::Model::open(&scene(RAMP), &[]).unwrap()).finish(&mut []).unwrap();
    assert_eq!(ours.summary.state_crc32, summary(&grid, "state_crc32"));
    assert_ne!(ours.summary.state_crc32, summary(&rock, "state_crc32"), "another rock moves alike");
}

#[test]
fn every_part_runs_the_ramp_to_the_end_and_after_a_kill_to_the_same_bits() {
    for part in fork::PARTS {
        // The energy of contact that is integrated by points takes longer than forty steps.
        let set = ["output.checkpoint_wall_s=0.01", "output.history_rows=50"];
        let path = scene(longest_scene_of(part));
        let (whole, killed) = (place(&format!("{part}-whole")), place(&format!("{part}-killed")));
        run(part, &path, &whole, &set);
        assert_eq!(summary(&whole, "status"), "done", "{part}");
        let words = [&[part, "run", path.to_str().unwrap(), killed.to_str().unwrap()], &set[..]].concat();
        kill_on_its_way(&words, &killed);
        if !killed.join("summary.json").exists() {
            let resumed =
                fork(&[part, "resume", killed.to_str().unwrap()]).output().expect("the program runs");
            assert!(resumed.status.success(), "{part}: {}", String::from_utf8_lossy(&resumed.stderr));
        }
        let crc = |folder: &Path| summary(folder, "state_crc32");
        assert_eq!(crc(&killed), crc(&whole), "{part} after a kill");
    }
}

#[test]
fn a_checkpoint_of_other_friction_laws_is_refused() {
    let folder = place("laws");
    let (path, set) = (scene(RAMP), ["output.checkpoint_wall_s=0.01"]);
    let words =
        [&["slip-weakening", "run", path.to_str().unwrap(), folder.to_str().unwrap()], &set[..]].concat();
    kill_on_its_way(&words, &folder);
    let resumed = fork(&["rate-and-state", "resume", folder.to_str().unwrap()]).output().unwrap();
    let said =
        String::from_utf8_lossy(&resumed.stderr).into_owned() + &String::from_utf8_lossy(&resumed.stdout);
    assert!(said.contains("resume with") || said.contains("Stopped"), "{said}");
}
