//! A run that is killed at any time and resumed, on any threads, ends in the bytes of one that never was.
//!
//! `NDDA_KILLS` sets the number of runs that are killed (default 15), by turns at once and by an interrupt.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use ndda_contact::testing::Random;

fn ndda(arguments: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ndda"));
    command.args(arguments).arg("--quiet").stdout(Stdio::null());
    command.spawn().expect("the program starts")
}

fn scene(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.join("scenes").join(format!("{name}.ron")).display().to_string()
}

fn run(scene: &str, overrides: &[&str], out: &Path, threads: &str) -> Child {
    let out = out.display().to_string();
    let mut arguments = vec!["run", scene, "--out", &out, "--force", "--threads", threads];
    for text in ["output.checkpoint_wall_s=0.003"].iter().chain(overrides) {
        arguments.extend(["--set", text]);
    }
    ndda(&arguments)
}

/// Interrupts a process as a terminal does.
#[cfg(unix)]
fn interrupt(child: &Child) {
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().expect("kill").success());
}

/// Scenes with what is set in them: laws and bodies of each kind, contact at predicted positions and at the end.
const SCENES: [(&str, &[&str]); 5] = [
    ("sliding_30_phi25_velocity", &["time.end_s=0.2"]),
    ("sliding_45_phi35_spring", &["time.end_s=0.12"]),
    ("collision_equal_free", &["time.end_s=0.2"]),
    (
        "collision_equal_free",
        &["time.end_s=0.2", "time.contact_at=End()", "blocks[0].body=Rigid", "blocks[1].body=Rigid"],
    ),
    (
        "sliding_45_phi35_spring",
        &[
            "time.end_s=0.02",
            "reference.after_s=0",
            "time.contact_at=End()",
            "blocks[1].body=Rigid",
            "time.step=Auto()",
        ],
    ),
];

/// A scene in stages, some of which come to rest: a run may be killed in each of them, and while it comes to rest.
const STAGED: (&str, &[&str]) = (
    "works/dam_impounding",
    &[
        "stages[0].over_s=0.02",
        "stages[1].over_s=0.02",
        "stages[1].reset_displacements=true",
        "stages[2].over_s=0.02",
        "stages[2].then=Run(0.05)",
        "stages[1].remove=[\"ground\"]",
        "stages[1].supports=[(block: \"dam_*\", on: Set(\"side_0\"), hold: Fixed)]",
    ],
);

/// A scene that settles first: a run may be killed while it does, with either kind of damping.
const SETTLING: [(&str, &[&str]); 2] = [
    ("extreme/overlap", &["time.end_s=0.01", "settle=(tolerance: 1e-9)"]),
    ("extreme/overlap", &["time.end_s=0.01", "settle=(tolerance: 1e-9, damping: Local())"]),
];

/// Everything that must come out the same: history, index and frames, and the fingerprint of the final state.
fn results(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut files = vec![folder.join("history.csv"), folder.join("fields.pvd")];
    files.extend(
        fs::read_dir(folder.join("fields")).expect("frames").map(|entry| entry.expect("a frame").path()),
    );
    files.sort();
    let named = |path: &PathBuf| {
        (path.strip_prefix(folder).expect("inside").to_path_buf(), fs::read(path).expect("a file"))
    };
    let mut results: Vec<_> = files.iter().map(named).collect();
    let summary = fs::read_to_string(folder.join("summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    results.push(("state".into(), summary["state_crc32"].to_string().into_bytes()));
    results.push(("stages".into(), summary["stages"].to_string().into_bytes()));
    results
}

#[test]
fn a_killed_run_goes_on_to_the_same_bytes() {
    killed_and_resumed(&SCENES, 15);
}

#[test]
fn a_run_that_is_killed_in_a_stage_goes_on_in_it_to_the_same_bytes() {
    killed_and_resumed(&[STAGED], 20);
}

#[test]
fn a_run_that_is_killed_while_it_settles_goes_on_to_the_same_bytes() {
    killed_and_resumed(&SETTLING, 8);
}

/// Kills runs of some scenes, `NDDA_KILLS` or so many, and compares what they end in after they are resumed.
fn killed_and_resumed(scenes: &[(&str, &[&str])], kills: usize) {
    let kills: usize = std::env::var("NDDA_KILLS").ok().and_then(|n| n.parse().ok()).unwrap_or(kills);
    let place = tempfile::tempdir().expect("a folder");
    let mut random = Random(7);
    let mut resumed = 0;
    for (number, &(name, overrides)) in scenes.iter().enumerate() {
        let (scene, whole) = (scene(name), place.path().join("whole"));
        let started = Instant::now();
        assert!(run(&scene, overrides, &whole, "1").wait().expect("an end").success(), "{name}");
        let (lasts, expected) = (started.elapsed().as_secs_f64(), results(&whole));
        for kill in 0..kills.div_ceil(scenes.len()) {
            // A folder of its own: a run that is killed before it has begun leaves the results of an earlier one as they were.
            let broken = place.path().join(format!("{number}_{kill}"));
            let mut child = run(&scene, overrides, &broken, ["1", "2"][kill % 2]);
            let out = broken.display().to_string();
            // Killed once, and often once more while it is being resumed.
            for _ in 0..1 + kill % 3 {
                std::thread::sleep(Duration::from_secs_f64(lasts * random.unit()));
                #[cfg(unix)]
                if kill % 2 == 1 {
                    interrupt(&child);
                }
                if kill % 2 == 0 || cfg!(not(unix)) {
                    child.kill().expect("a child");
                }
                child.wait().expect("an end");
                child = ndda(&["resume", &out, "--threads", ["2", "1"][kill % 2]]);
            }
            if child.wait().expect("an end").success() {
                resumed += 1;
            } else {
                // Killed before its first checkpoint.
                assert!(
                    !broken.join("checkpoint.ndda").exists()
                        && !broken.join("checkpoint.previous.ndda").exists()
                );
                assert!(run(&scene, overrides, &broken, "1").wait().expect("an end").success());
            }
            let found = results(&broken);
            assert_eq!(found.len(), expected.len(), "{name}: files after kill {kill}");
            for ((path, bytes), (expected_path, expected)) in found.iter().zip(&expected) {
                assert!(
                    path == expected_path && bytes == expected,
                    "{name}: {} after kill {kill}",
                    path.display()
                );
            }
        }
    }
    println!("{resumed} of {} runs were resumed", scenes.len() * kills.div_ceil(scenes.len()));
    assert!(resumed > kills / 2, "hardly a run had a checkpoint");
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_a_summary_and_goes_on() {
    let place = tempfile::tempdir().expect("a folder");
    let (scene, out) = (scene("sliding_45_phi35_spring"), place.path().join("out"));
    let (whole, overrides) = (place.path().join("whole"), ["time.end_s=0.2"]);
    assert!(run(&scene, &overrides, &whole, "1").wait().expect("an end").success());
    let mut child = run(&scene, &overrides, &out, "1");
    while !out.join("checkpoint.ndda").exists() {
        std::thread::sleep(Duration::from_millis(1));
    }
    interrupt(&child);
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    let summary = fs::read_to_string(out.join("summary.json")).expect("a summary");
    assert!(summary.contains("\"interrupted\""), "{summary}");
    assert!(ndda(&["resume", &out.display().to_string()]).wait().expect("an end").success());
    assert!(results(&out) == results(&whole), "an interrupted run ends otherwise");
}

#[cfg(unix)]
#[test]
fn a_run_that_is_interrupted_while_it_settles_leaves_all_its_files_and_goes_on() {
    let place = tempfile::tempdir().expect("a folder");
    let (scene, out) = (scene("extreme/overlap"), place.path().join("out"));
    // It hardly loses any motion.
    let endless = ["time.end_s=0.01", "settle=(tolerance: 1e-300, damping: Local(factor: 1e-3))"];
    let mut child = run(&scene, &endless, &out, "1");
    while !out.join("checkpoint.ndda").exists() {
        std::thread::sleep(Duration::from_millis(1));
    }
    interrupt(&child);
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    let summary: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(out.join("summary.json")).expect("a summary"))
            .expect("JSON");
    let settled = summary["unsettled_steps"].as_u64().expect("steps");
    assert!(settled > 0 && summary["status"] == "interrupted" && summary["steps"] == 0, "{summary}");
    assert!(
        summary["label"]["reasons"][0]
            .as_str()
            .expect("a reason")
            .contains("before the scene had come to rest")
    );
    // How it was at the start, and how it is now.
    assert_eq!(fs::read_dir(out.join("fields")).expect("frames").count(), 2);
    assert_eq!(fs::read_to_string(out.join("history.csv")).expect("a history").lines().count(), 3);
    let mut child = ndda(&["resume", &out.display().to_string()]);
    std::thread::sleep(Duration::from_millis(300));
    interrupt(&child);
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    let summary = fs::read_to_string(out.join("summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    assert!(summary["unsettled_steps"].as_u64() > Some(settled), "it has begun anew: {summary}");
}

#[test]
fn a_scene_that_does_not_come_to_rest_leaves_a_summary_and_where_its_blocks_went() {
    let place = tempfile::tempdir().expect("a folder");
    let out = place.path().join("out");
    // Its closed form is that of the run, which does not begin.
    let never = [
        "time.end_s=0.01",
        "settle=(tolerance: 1e-12, most_steps: 50)",
        "reference=Displacement(monitor: \"centre\", displacement_m: (0, 0, -1), after_s: 0)",
    ];
    assert_eq!(run(&scene("extreme/overlap"), &never, &out, "1").wait().expect("an end").code(), Some(4));
    let summary = fs::read_to_string(out.join("summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    assert!(summary["status"] == "stopped" && summary["unsettled_steps"] == 50, "{summary}");
    assert!(summary["stopped_by"].as_str().expect("a cause").contains("[not-settled]"), "{summary}");
    assert_eq!(fs::read_dir(out.join("fields")).expect("frames").count(), 2);
}

#[test]
fn a_scene_whose_first_step_to_rest_fails_ends_with_its_cause() {
    let place = tempfile::tempdir().expect("a folder");
    let (file, out) = (place.path().join("soft.ron"), place.path().join("out"));
    // Contact so soft that the cube falls through: at the first look nothing has changed but that.
    let text = r#"(title: "soft", time: (step_s: 2e-6, end_s: 1e-2), gravity_m_s2: (0, 0, -9.81),
        materials: [(name: "rock", young_pa: 5e9, poisson: 0.2, density_kg_m3: 2500)],
        blocks: [
            (name: "cube", material: "rock", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
            (name: "floor", material: "rock", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, -1)),
        ],
        contact: Potential(penalty_pa: 1e3), settle: (damping: Local()))"#;
    fs::write(&file, text).expect("a scene");
    assert_eq!(run(&file.display().to_string(), &[], &out, "1").wait().expect("an end").code(), Some(4));
    let summary = fs::read_to_string(out.join("summary.json")).expect("a summary");
    assert!(summary.contains("stopped_by"), "{summary}");
}
