//! With `--json`, standard output is lines of JSON as docs/reference/json.md says, and nothing else.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

fn scene(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.join("scenes").join(format!("{name}.ron")).display().to_string()
}

/// Exit code and events of a call; each line begins with its schema.
fn events(arguments: &[&str], schema: &str) -> (i32, Vec<Value>) {
    let output = Command::new(env!("CARGO_BIN_EXE_ndda")).args(arguments).arg("--json").output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let begins = format!("{{\"schema\":\"{schema}\",\"event\":\"");
    for line in text.lines() {
        assert!(line.starts_with(&begins), "{line}");
    }
    let events = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    (output.status.code().unwrap(), events)
}

fn names(events: &[Value]) -> Vec<&str> {
    events.iter().map(|event| event["event"].as_str().unwrap()).collect()
}

fn out(place: &tempfile::TempDir) -> (PathBuf, String) {
    let out = place.path().join("out");
    let text = out.display().to_string();
    (out, text)
}

#[test]
fn a_run_starts_gets_on_and_finishes_with_its_summary() {
    let place = tempfile::tempdir().unwrap();
    let (_, out) = out(&place);
    let (code, found) = events(&["run", &scene("free_fall"), "--out", &out], "ndda.run/2");
    assert_eq!((code, names(&found)[0], *names(&found).last().unwrap()), (0, "started", "finished"));
    let steps = found[0]["steps"].as_u64().unwrap();
    let passed: Vec<u64> =
        found.iter().filter(|e| e["event"] == "progress").map(|e| e["step"].as_u64().unwrap()).collect();
    assert!(passed.windows(2).all(|w| w[0] < w[1]) && passed.last() == Some(&steps), "{passed:?}");
    let last = found.last().unwrap();
    assert_eq!((&last["exit_code"], &last["summary"]["status"]), (&Value::from(0), &Value::from("done")));

    let (code, found) = events(&["resume", &out], "ndda.run/2");
    assert_eq!((code, names(&found)), (0, vec!["nothing_to_do"]));
    let (code, found) = events(&["resume", &out, "--sensitivity", "always"], "ndda.run/2");
    let why = found[0]["message"].as_str().unwrap();
    assert!(code == 0 && why.contains("repeats no run that has ended: run the scene anew"), "{why}");
    let (code, found) = events(&["run", &scene("free_fall"), "--out", &out], "ndda.run/2");
    assert_eq!((code, names(&found)), (5, vec!["failed"]));
    assert!(found[0]["message"].as_str().unwrap().contains("--force"));
}

#[test]
fn what_is_wrong_with_a_scene_comes_with_its_place() {
    let wrong = ["check", &scene("free_fall"), "--set", "materials.rock.poisson=0.7"];
    let (code, found) = events(&wrong, "ndda.check/1");
    assert_eq!((code, names(&found)), (3, vec!["failed"]));
    let place = &found[0]["diagnostics"][0];
    assert!(place["path"].as_str().unwrap().ends_with("poisson") && place["line"].as_u64().unwrap() > 1);
}

#[test]
fn a_check_reckons_what_a_run_will_take_and_write() {
    let (code, found) = events(&["check", &scene("sliding_45_phi35_velocity")], "ndda.check/1");
    assert_eq!((code, names(&found)), (0, vec!["finished"]));
    let guess = &found[0]["guess"];
    assert!(guess["run_s"].as_f64().unwrap() > 0.0, "{guess}");
    let files: Vec<&str> =
        guess["files"].as_array().unwrap().iter().map(|file| file["name"].as_str().unwrap()).collect();
    let expected =
        ["history.csv", "checkpoint.ndda", "summary.json", "run.log", "fields/*.vtu", "blocks.csv"];
    assert_eq!(files, expected);
}

#[test]
fn a_mesh_is_measured() {
    let place = tempfile::tempdir().unwrap();
    let (_, out) = out(&place);
    let (code, found) = events(&["mesh", &scene("free_fall"), "--out", &out], "ndda.mesh/1");
    assert_eq!((code, names(&found)), (0, vec!["measured", "finished"]));
    assert!(found[0]["report"]["tets"].as_u64().unwrap() > 0);
}

#[test]
fn a_template_a_picture_and_a_page_are_told_of_as_events() {
    let place = tempfile::tempdir().unwrap();
    let (folder, out) = out(&place);
    let (code, found) = events(&["new", "--list"], "ndda.new/1");
    assert_eq!(
        (code, names(&found), &found[0]["templates"][0]["name"]),
        (0, vec!["finished"], &"slide".into())
    );
    let (code, found) = events(&["new", "slyde"], "ndda.new/1");
    assert_eq!((code, names(&found)), (2, vec!["failed"]));
    let scene = place.path().join("s.ron").display().to_string();
    let (code, found) = events(&["new", "slide", "--out", &scene], "ndda.new/1");
    assert_eq!((code, &found[0]["scene"]), (0, &scene.as_str().into()));

    assert_eq!(events(&["run", &scene, "--set", "output.frames=5", "--out", &out], "ndda.run/2").0, 0);
    let (code, found) = events(&["plot", &out], "ndda.plot/1");
    assert_eq!((code, &found[0]["tables"][0]["columns"][0]), (0, &"time_s".into()));
    let picture = place.path().join("p.svg").display().to_string();
    let (code, found) = events(&["plot", &out, "--columns", "kinetic", "-o", &picture], "ndda.plot/1");
    assert_eq!((code, &found[0]["picture"]), (0, &picture.as_str().into()));
    let (code, found) = events(&["plot", &out, "--columns", "kinetik"], "ndda.plot/1");
    assert_eq!((code, names(&found)), (3, vec!["failed"]));

    let (code, found) = events(&["report", &out], "ndda.report/1");
    assert_eq!((code, names(&found)), (0, vec!["written", "finished"]));
    assert_eq!(found[0]["report"], folder.join("report.html").display().to_string());
    let (code, found) = events(&["report", &scene], "ndda.report/1");
    assert_eq!((code, names(&found)), (3, vec!["failed"]));
}
