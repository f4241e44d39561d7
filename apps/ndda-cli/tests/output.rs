//! The output that a scene requests is written, and nothing else; written quantities balance.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

fn ndda() -> Command {
    Command::new(env!("CARGO_BIN_EXE_ndda"))
}

/// Runs a hundred steps of the ramp without friction.
fn run_ramp(place: &Path, overrides: &[&str]) -> PathBuf {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/sliding_45.ron");
    let out = place.join("out");
    let always = ["time.end_s=0.01", "output.frames=1", "reference.after_s=0.001"];
    let mut command = ndda();
    command.arg("run").arg(scene).arg("--out").arg(&out).args(["--force", "--quiet"]);
    for text in always.iter().chain(overrides) {
        command.args(["--set", text]);
    }
    assert!(command.status().unwrap().success());
    out
}

fn files(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect()
}

/// Names of the arrays of a frame.
fn arrays(out: &Path) -> BTreeSet<String> {
    let file = fs::read(out.join("fields/frame_000001.vtu")).unwrap();
    let text = String::from_utf8_lossy(&file);
    let names = text.split(" Name=\"").skip(1).map(|rest| rest.split('"').next().unwrap().to_string());
    let always = ["Points", "connectivity", "offsets", "types"];
    names.filter(|name| !always.contains(&name.as_str())).collect()
}

/// Columns of a table by name.
fn column(text: &str, name: &str) -> Vec<f64> {
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let place = lines.next().unwrap().iter().position(|column| *column == name).unwrap();
    lines.map(|line| line[place].parse().unwrap()).collect()
}

fn set(names: &[&str]) -> BTreeSet<String> {
    names.iter().map(|name| name.to_string()).collect()
}

const ALWAYS: [&str; 6] =
    ["checkpoint.ndda", "checkpoint.previous.ndda", "run.log", "summary.json", "history.csv", "blocks.csv"];

#[test]
fn files_and_arrays_are_those_that_are_asked_for() {
    let place = tempfile::tempdir().unwrap();
    let out = run_ramp(place.path(), &[]);
    assert_eq!(files(&out), &set(&ALWAYS) | &set(&["fields", "fields.pvd"]));
    let usual = ["displacement_m", "velocity_m_s", "von_mises_pa", "stress_pa", "block_id"];
    assert_eq!(arrays(&out), set(&usual));

    let out = run_ramp(place.path(), &["output.fields=[]", "output.contacts=true"]);
    assert_eq!(files(&out), &set(&ALWAYS) | &set(&["fields", "fields.pvd", "contacts.csv"]));
    assert_eq!(arrays(&out), set(&[]));

    let others = "output.fields=[Acceleration,ContactForce,ContactTraction,FrictionState,Material]";
    for format in ["Compressed", "Appended", "Base64"] {
        let out =
            run_ramp(place.path(), &[others, &format!("output.format={format}"), "output.precision=F32"]);
        let names =
            ["acceleration_m_s2", "contact_force_n", "contact_traction_pa", "friction_state", "material"];
        assert_eq!(arrays(&out), set(&names), "{format}");
    }
    fs::remove_dir_all(&out).unwrap();
    let out = run_ramp(place.path(), &["output.frames=0"]);
    assert_eq!(files(&out), set(&ALWAYS));
}

#[cfg(feature = "parquet")]
#[test]
fn tables_are_left_in_the_forms_that_are_asked_for() {
    let place = tempfile::tempdir().unwrap();
    let out = run_ramp(place.path(), &["output.history=Both", "output.contacts=true"]);
    let tables = ["history.csv", "history.parquet", "contacts.csv", "contacts.parquet"];
    assert!(files(&out).is_superset(&set(&tables)));
    let out = run_ramp(place.path(), &["output.history=Parquet", "output.contacts=true"]);
    let found: BTreeSet<String> = files(&out).intersection(&set(&tables)).cloned().collect();
    assert_eq!(found, set(&["history.parquet", "contacts.parquet"]));
    // Readers of results find them in columnar tables, too.
    let picture = place.path().join("p.svg");
    for arguments in [&["report"][..], &["plot", "--columns", "kinetic", "-o", picture.to_str().unwrap()]] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_ndda"));
        let read = command.arg(arguments[0]).arg(&out).args(&arguments[1..]).output().unwrap();
        assert!(read.status.success(), "{}", String::from_utf8_lossy(&read.stderr));
    }
}

#[test]
fn stages_sum_to_the_whole_of_a_run_that_settles_first() {
    let place = tempfile::tempdir().unwrap();
    let scene = place.path().join("rest.ron");
    let text = "(title: \"rest\", time: (step_s: 1e-3, end_s: 0.01), gravity_m_s2: (0, 0, -9.8),
        materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
        blocks: [(name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (3, 3, 1), cells: (3, 3, 1)), at_m: (-1, -1, -1)),
                 (name: \"block\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)))],
        contact: Potential(penalty_pa: 2e8, potential: Smooth(reference_m: 1)), settle: (tolerance: 1e-6, most_steps: 100000))";
    fs::write(&scene, text).unwrap();
    let mut command = ndda();
    command.arg("run").arg(scene).arg("--out").arg(place.path().join("out")).arg("--quiet");
    assert!(command.status().unwrap().success());
    let summary: Value =
        serde_json::from_str(&fs::read_to_string(place.path().join("out/summary.json")).unwrap()).unwrap();
    let stages: f64 = summary["stages_s"].as_object().unwrap().values().map(|s| s.as_f64().unwrap()).sum();
    let whole = summary["wall_s"].as_f64().unwrap();
    assert!((stages / whole - 1.0).abs() < 0.02, "{stages} s of {whole} s");
}

#[test]
fn impulses_of_contacts_and_reactions_are_the_changes_of_momentum() {
    let place = tempfile::tempdir().unwrap();
    let steps = 100;
    let rows = format!("output.history_rows={steps}");
    let out = run_ramp(place.path(), &["output.contacts=true", "output.reactions=true", &rows]);
    let summary: Value =
        serde_json::from_str(&fs::read_to_string(out.join("summary.json")).unwrap()).unwrap();
    let [contacts, history] =
        ["contacts.csv", "history.csv"].map(|name| fs::read_to_string(out.join(name)).unwrap());
    let (step_s, gravity) = (1e-4, [0.0, 0.0, -9.8]);
    let impulse = |text: &str, name: &str| step_s * column(text, name).iter().sum::<f64>();
    for (i, axis) in ["x", "y", "z"].iter().enumerate() {
        let on_ramp = impulse(&contacts, &format!("force_{axis}_n"));
        let held = impulse(&history, &format!("ramp.reaction_{axis}_n"));
        let of = |block: &str| &summary["blocks"][block];
        let weight =
            |block: &str| of(block)["mass"].as_f64().unwrap() * gravity[i] * step_s * f64::from(steps);
        let gained = |block: &str| of(block)["momentum"][i].as_f64().unwrap() - weight(block);
        let scale = weight("prism").abs().max(1.0);
        assert!((gained("prism") + on_ramp).abs() < 1e-9 * scale, "{axis}: {on_ramp} on the ramp");
        let scale = of("ramp")["mass"].as_f64().unwrap() * 9.8 * step_s * f64::from(steps);
        assert!((gained("ramp") - on_ramp - held).abs() < 1e-9 * scale, "{axis}: {held} by supports");
    }
}

/// A scene far from the origin is computed about a place of its own, and its tables are about the origin all the same.
#[test]
fn the_angular_momentum_of_the_history_is_that_of_the_summary() {
    let place = tempfile::tempdir().unwrap();
    let (scene, out) = (place.path().join("turn.ron"), place.path().join("out"));
    let text = "(title: \"turn\", time: (step_s: 1e-4, end_s: 1e-3),
        materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
        blocks: [(name: \"cuboid\", material: \"rock\", body: Rigid, shape: Box(size_m: (4, 3, 1), cells: (1, 1, 1)),
            at_m: (1000, -2000, 500), velocity_m_s: (0.1, 0.2, 0.3), spin_rad_s: (1, 2, 3))])";
    fs::write(&scene, text).unwrap();
    assert!(ndda().arg("run").arg(&scene).arg("--out").arg(&out).arg("--quiet").status().unwrap().success());
    let summary: Value =
        serde_json::from_str(&fs::read_to_string(out.join("summary.json")).unwrap()).unwrap();
    let history = fs::read_to_string(out.join("history.csv")).unwrap();
    // Of the momentum m v at the mass centre (1002, −1998.5, 500.5), and of the spin in the frame of the cuboid.
    let mass_kg = 12.0 * 2600.0;
    let exact = [
        mass_kg * (-1998.5 * 0.3 - 500.5 * 0.2 + 1.0 * (9.0 + 1.0) / 12.0),
        mass_kg * (500.5 * 0.1 - 1002.0 * 0.3 + 2.0 * (16.0 + 1.0) / 12.0),
        mass_kg * (1002.0 * 0.2 + 1998.5 * 0.1 + 3.0 * (16.0 + 9.0) / 12.0),
    ];
    for (i, axis) in ["x", "y", "z"].iter().enumerate() {
        let rows = column(&history, &format!("angular_{axis}_kg_m2_s"));
        let end = summary["blocks"]["cuboid"]["angular_momentum"][i].as_f64().unwrap();
        for found in rows.iter().chain([&end]) {
            assert!((found / exact[i] - 1.0).abs() < 1e-9, "{axis}: {found} instead of {}", exact[i]);
        }
    }
}

#[test]
fn the_log_says_what_ran_on_what() {
    let place = tempfile::tempdir().unwrap();
    let out = run_ramp(place.path(), &[]);
    let log = fs::read_to_string(out.join("run.log")).unwrap();
    for part in
        ["ndda 0.", "rustc", "features", "thread", "CRC-32", "end_s: 0.01", "energy gained", "contact"]
    {
        assert!(log.contains(part), "{part} is missing in\n{log}");
    }
}

#[test]
fn files_of_somebody_else_are_not_replaced_by_results_of_the_same_name() {
    let place = tempfile::tempdir().unwrap();
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let scene = |name: &str| scenes.join(name).display().to_string();
    let (slope, rockfall) = (scene("safety/plane_dry.ron"), scene("works/rockfall.ron"));
    let sliding = scene("sliding_45.ron");
    for (file, words) in [
        ("boulders.csv", vec!["rockfall", &rockfall, "--count", "1"]),
        ("rockfall.json", vec!["rockfall", &rockfall, "--count", "1", "--force"]),
        ("safety.json", vec!["safety", &slope]),
        ("safety.json", vec!["safety", &slope, "--force"]),
        ("certificate.json", vec!["certify", &sliding]),
        ("tune.json", vec!["tune", &sliding, "--error", "0.01"]),
        ("sweep.csv", vec!["study", &sliding, "--vary", "time.end_s=0.01,0.02", "--of", "label"]),
    ] {
        let out = place.path().join(file.replace('.', "_"));
        fs::create_dir_all(&out).unwrap();
        fs::write(out.join(file), "{\"mine\": 1}").unwrap();
        let ended = ndda().args(&words).arg("--out").arg(&out).output().unwrap();
        let said = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert_eq!(ended.status.code(), Some(5), "{words:?}: {said}");
        assert!(said.contains(&format!("something that ndda did not write ({file})")), "{words:?}: {said}");
        assert_eq!(fs::read_to_string(out.join(file)).unwrap(), "{\"mine\": 1}");
        assert_eq!(files(&out), set(&[file]), "{words:?}");
    }
}
