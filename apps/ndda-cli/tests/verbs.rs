//! The verbs around a run: new, explain, schema, examples, completions, man.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use ndda::templates::TEMPLATES;
use serde_json::Value;

fn ndda(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ndda")).args(words).current_dir(folder).output().unwrap()
}

/// Standard output of a call that must end well.
fn said(folder: &Path, words: &[&str]) -> String {
    let done = ndda(folder, words);
    assert!(done.status.success(), "{words:?}: {}", String::from_utf8_lossy(&done.stderr));
    String::from_utf8(done.stdout).unwrap()
}

/// Exit code and standard error of a call that must not.
fn refused(folder: &Path, words: &[&str]) -> (i32, String) {
    let done = ndda(folder, words);
    (done.status.code().unwrap(), String::from_utf8(done.stderr).unwrap())
}

#[test]
fn every_template_passes_its_check_without_a_warning_and_runs() {
    let folder = tempfile::tempdir().unwrap();
    for template in &TEMPLATES {
        let file = format!("{}.ron", template.name);
        said(folder.path(), &["new", template.name]);
        let checked = said(folder.path(), &["check", &file]);
        if template.verb == "rockfall" {
            // A rockfall's check has no count of warnings: each is a line of its own.
            assert!(checked.contains("no errors") && !checked.contains("warning"), "{checked}");
            said(folder.path(), &["rockfall", &file, "--count", "1"]);
            continue;
        }
        assert!(checked.contains("no errors, no warnings"), "{checked}");
        // Ten steps of each: that they start is what a template is for.
        let step_s = ndda_io::read::load(&folder.path().join(&file), &[]).unwrap().scene.time.step_s;
        // A scene without a step is given one by the program: of these, at least 5e-5 s, so that 1e-3 s are at most twenty.
        let end_s = if step_s > 0.0 { 10.0 * step_s } else { 1e-3 };
        let end = format!("time.end_s={end_s}");
        let no_reference = "output.frames=1";
        let mut words = vec!["run", &file, "--quiet", "--set", &end, "--set", no_reference];
        if template.scene.contains("after_s:") {
            words.extend(["--set", "reference.after_s=0"]);
        }
        said(folder.path(), &words);
    }
}

/// Whether a call with `text` on its standard input ends well, and all that it prints.
fn piped(folder: &Path, text: &str, words: &[&str]) -> (bool, String) {
    let mut call = Command::new(env!("CARGO_BIN_EXE_ndda"));
    call.args(words).current_dir(folder).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = call.spawn().unwrap();
    child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
    let done = child.wait_with_output().unwrap();
    let said = String::from_utf8(done.stdout).unwrap() + &String::from_utf8(done.stderr).unwrap();
    (done.status.success(), said)
}

#[test]
fn a_scene_may_come_from_standard_input() {
    let folder = tempfile::tempdir().unwrap();
    let scene = said(folder.path(), &["new", "slide", "--out", "-"]);
    let (is_well, text) = piped(folder.path(), &scene, &["check", "-"]);
    assert!(is_well && text.contains("no errors"), "{text}");
    let short = ["--set", "time.end_s=1e-3", "--set", "reference.after_s=0"];
    let words = [&["run", "-", "--quiet"][..], &short].concat();
    let (is_well, text) = piped(folder.path(), &scene, &words);
    assert!(is_well, "{text}");
    assert!(folder.path().join("out/scene/summary.json").is_file());
    let words = [&["certify", "-", "--quiet"][..], &short].concat();
    let (is_well, text) = piped(folder.path(), &scene, &words);
    assert!(is_well, "{text}");
    let (is_well, text) = piped(folder.path(), "(title: 1)", &["check", "-"]);
    assert!(!is_well && text.contains("standard input"), "{text}");
}

#[test]
fn a_template_is_never_written_over_a_file() {
    let folder = tempfile::tempdir().unwrap();
    said(folder.path(), &["new", "collide", "--out", "mine.ron"]);
    let (code, reason) = refused(folder.path(), &["new", "slide", "-o", "mine.ron"]);
    assert!(code == 5 && reason.contains("mine.ron is there already"), "{code}: {reason}");
    said(folder.path(), &["new", "slide", "-o", "mine.ron", "--force"]);
    assert_eq!(std::fs::read_to_string(folder.path().join("mine.ron")).unwrap(), TEMPLATES[0].scene);
    let (code, reason) = refused(folder.path(), &["new", "slid"]);
    assert!(code == 2 && reason.contains("did you mean `slide`"), "{code}: {reason}");
    // A record of the user's beside the scene is never lost.
    std::fs::write(folder.path().join("record.at2"), "mine").unwrap();
    let (code, reason) = refused(folder.path(), &["new", "earthquake", "--force"]);
    assert!(
        code == 5 && reason.contains("record.at2 is there already, with other content"),
        "{code}: {reason}"
    );
    assert_eq!(std::fs::read_to_string(folder.path().join("record.at2")).unwrap(), "mine");
    assert_eq!(said(folder.path(), &["new", "-o", "-"]), TEMPLATES[0].scene);
    assert_eq!(said(folder.path(), &["new", "--list"]).lines().count(), TEMPLATES.len());
}

#[test]
fn examples_are_listed_checked_explained_and_run_by_their_names() {
    let folder = tempfile::tempdir().unwrap();
    let list = said(folder.path(), &["run", "--example"]);
    assert!(list.contains("sliding_45 ") && list.contains("Free fall of a block"), "{list}");
    let (code, reason) = refused(folder.path(), &["run", "--example", "slidng_45"]);
    assert!(code == 2 && reason.contains("did you mean `sliding_45`"), "{code}: {reason}");
    assert!(said(folder.path(), &["check", "--example", "free_fall"]).contains("200 steps"));
    said(folder.path(), &["run", "--example", "free_fall", "--set", "time.end_s=0.2", "--quiet"]);
    let summary = std::fs::read_to_string(folder.path().join("out/free_fall/summary.json")).unwrap();
    assert_eq!(serde_json::from_str::<Value>(&summary).unwrap()["status"], "done");
}

/// The plan of an example as JSON.
fn plan(words: &[&str]) -> Value {
    let words = [&["explain", "--json", "--example"], words].concat();
    let printed = said(Path::new("."), &words);
    assert!(printed.starts_with("{\n  \"schema\": \"ndda.explain/1\""), "{printed}");
    serde_json::from_str(&printed).unwrap()
}

/// Whether a part of a plan is in.
fn has(plan: &Value, name: &str) -> bool {
    let parts = plan["parts"].as_array().unwrap();
    let part = parts.iter().find(|part| part["name"] == name).unwrap_or_else(|| panic!("no {name}: {plan}"));
    part["included"].as_bool().unwrap()
}

#[test]
fn one_block_alone_is_explained_to_have_no_contact() {
    let plan = plan(&["free_fall", "--set", "output.frames=0"]);
    assert!(!has(&plan, "contact") && !has(&plan, "fields") && !has(&plan, "recovery of stress"));
    assert!(!plan["files"].to_string().contains("fields"));
    assert_eq!(plan["factors"].as_array().unwrap().len(), 1);
}

#[test]
fn friction_is_in_the_plan_when_an_angle_is_and_out_when_it_is_zero() {
    let rough = plan(&["sliding_45_phi35"]);
    assert!(has(&rough, "friction") && has(&rough, "friction history") && !has(&rough, "bonds"));
    let smooth = plan(&["sliding_45_phi35", "--set", "contact.friction.friction_deg=0"]);
    assert!(has(&smooth, "contact") && !has(&smooth, "friction") && !has(&smooth, "work of friction"));
}

#[test]
fn congruent_cubes_share_factors_and_fixed_blocks_have_none() {
    let plan = plan(&["pile_125"]);
    let factors = plan["factors"].as_array().unwrap();
    assert!(factors.len() < 125);
    assert_eq!(factors.iter().map(|factor| factor["blocks"].as_u64().unwrap()).sum::<u64>(), 125);
    let kinds = plan["blocks"].as_array().unwrap();
    let fixed = kinds.iter().find(|kind| kind["kind"] == "fixed").unwrap();
    assert_eq!((&fixed["blocks"], &fixed["unknowns"]), (&Value::from(6), &Value::from(0)));
}

#[test]
fn a_plan_in_words_has_what_is_in_and_what_is_left_out() {
    let words = said(Path::new("."), &["explain", "--example", "sliding_45"]);
    for word in [
        "blocks\n",
        "equations, factored once",
        "\ncomputed\n",
        "\nleft out, and why\n",
        "supernodal",
        "files\n",
        "thread",
    ] {
        assert!(words.contains(word), "{word} is not in\n{words}");
    }
}

#[cfg(feature = "schema")]
#[test]
fn the_schema_is_json_and_the_reference_begins_with_its_title() {
    let schema: Value = serde_json::from_str(&said(Path::new("."), &["schema"])).unwrap();
    assert_eq!(schema["title"], "Scene");
    assert!(said(Path::new("."), &["schema", "--markdown"]).starts_with("# The scene file\n"));
}

#[cfg(feature = "shell")]
#[test]
fn completions_and_manual_pages_know_the_verbs() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(said(Path::new("."), &["completions", shell]).contains("explain"), "{shell}");
    }
    assert!(said(Path::new("."), &["man"]).contains("explain"));
    assert!(said(Path::new("."), &["man", "run"]).contains("example"));
    assert_eq!(refused(Path::new("."), &["man", "rum"]).0, 2);
}

#[cfg(not(feature = "shell"))]
#[test]
fn a_verb_that_is_not_built_in_names_its_feature() {
    let (code, said) = refused(Path::new("."), &["completions", "bash"]);
    assert_eq!(code, 2);
    assert!(said.contains("without the feature `shell`") && said.contains("--features shell"), "{said}");
}

#[test]
fn joints_are_tested_from_scenes_and_from_laws_on_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let law = "(friction_deg: 30, shear_penalty_pa_m: 1e10, dilation: (psi_deg: 10, to_slip_m: 1))";
    let volume = ["joint", "--friction", law, "--constant-volume", "--joint-stiffness", "1e10"];
    let words = [&volume[..], &["--amplitude", "5e-3", "--out", "rough", "--json"]].concat();
    let done: Value = serde_json::from_str(&said(folder.path(), &words)).unwrap();
    assert_eq!(done["schema"], "ndda.joint/1");
    let found = done["comparisons"].as_array().unwrap();
    let normal = found.iter().find(|row| row["what"] == "normal stress at the end").unwrap();
    assert!((normal["exact"].as_f64().unwrap() / 8.90936e6 - 1.0).abs() < 1e-6, "{normal}");
    assert!(found.iter().all(|row| row["error"].as_f64().unwrap() < 1e-4), "{found:?}");
    let table = std::fs::read_to_string(folder.path().join("rough/joint.csv")).unwrap();
    assert_eq!(table.lines().count(), 1002);
    assert!(folder.path().join("rough/joint.json").exists());
    assert!(folder.path().join("rough/joint.svg").exists() || !cfg!(feature = "plots"));

    let example = ["joint", "--example", "sliding_45_phi35_spring", "--amplitude", "1e-3", "--cycles", "2"];
    assert!(said(folder.path(), &example).contains("energy lost"));
    let closure = ["joint", "--test", "closure", "--joint-stiffness", "20e9", "--max-closure", "0.3e-3"];
    assert!(said(folder.path(), &closure).contains("27.2222"), "tangent stiffness at 1 MPa");
}

#[test]
fn joints_that_cannot_be_tested_are_refused_with_what_to_change() {
    let folder = tempfile::tempdir().unwrap();
    for (words, code, reason) in [
        (&["joint"][..], 2, "name a scene"),
        (&["joint", "--friction", "(friction_deg: 30, psi: 1)"], 3, "psi"),
        (
            &[
                "joint",
                "--friction",
                "(friction_deg: 30, shear_penalty_pa_m: 1e9, dilation: (psi_deg: 40, to_slip_m: 1))",
            ],
            3,
            "would create energy",
        ),
        (&["joint", "--friction", "(friction_deg: 30)", "--constant-volume"], 3, "--joint-stiffness"),
        (&["joint", "--friction", "(friction_deg: 0)"], 3, "no strength"),
        (&["joint", "--friction", "30"], 2, "write the law in brackets, as '(friction_deg: 30)'"),
        (&["joint", "--friction", "(friction_deg: 30)", "--amplitude", "-1"], 3, "above 0"),
        (&["joint", "--friction", "(friction_deg: 30)", "--amplitude", "0"], 3, "above 0"),
        (&["joint", "--example", "sliding_45_phi35", "--of", "bedding"], 3, "which has contact.friction"),
        (&["joint", "--example", "sliding_45_phi35", "--between", "rock"], 2, "two materials"),
        (&["joint", "--test", "closure", "--joint-stiffness", "0"], 3, "above 0"),
        (
            &["joint", "--test", "closure", "--example", "sliding_45_phi35", "--normal-stress", "nan"],
            3,
            "above 0",
        ),
    ] {
        let (found, said) = refused(folder.path(), words);
        assert!(found == code && said.contains(reason), "{words:?}: {found}: {said}");
    }
}

/// A block that is pressed past the centroids of another in its first step.
const STOPS: &str = r#"(title: "pressed in", time: (step_s: 1e-3, end_s: 0.1),
    materials: [(name: "rock", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2650)],
    blocks: [
        (name: "base", material: "rock", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
        (name: "cube", material: "rock", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 1.1), velocity_m_s: (0, 0, -500)),
    ],
    contact: Potential(penalty_pa: 1e8), output: (frames: 0))"#;

#[test]
fn a_check_of_a_scene_whose_first_steps_stop_ends_as_the_run_does() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("s.ron"), STOPS).unwrap();
    let (code, said) = refused(folder.path(), &["check", "s.ron"]);
    assert!(code == 4 && said.contains("error: the run would stop in its first steps: "), "{code} {said}");
    let (code, said) = refused(folder.path(), &["run", "s.ron"]);
    assert_eq!(code, 4, "{said}");
}

#[test]
fn a_rockfall_is_told_from_scenes_of_blocks_and_keeps_earlier_results() {
    let folder = tempfile::tempdir().unwrap();
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/works/rockfall.ron");
    let scene = scenes.to_str().unwrap();
    for verb in ["mesh", "picture", "safety"] {
        let (code, said) = refused(folder.path(), &[verb, scene]);
        assert!(
            code == 3 && said.contains("`ndda rockfall` lets its boulders fall"),
            "{verb}: {code} {said}"
        );
    }
    let words = ["rockfall", scene, "--count", "1", "--quiet", "--out", "a"];
    said(folder.path(), &words);
    let (code, told) = refused(folder.path(), &words);
    assert!(code == 5 && told.contains("or replace them by --force"), "{code} {told}");
    said(folder.path(), &[&words[..], &["--force"]].concat());
}

/// A folder with what a run of a small scene leaves.
fn folder_of_a_run(folder: &Path) {
    said(folder, &["run", "--example", "free_fall", "--quiet", "--out", "run"]);
}

#[test]
fn answers_of_other_verbs_keep_out_of_the_folder_of_a_run() {
    let folder = tempfile::tempdir().unwrap();
    folder_of_a_run(folder.path());
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    for (verb, scene) in [("safety", "safety/plane_dry.ron"), ("rockfall", "works/rockfall.ron")] {
        let (code, told) =
            refused(folder.path(), &[verb, scenes.join(scene).to_str().unwrap(), "--out", "run"]);
        assert!(code == 5 && told.contains("run holds the results of a run (summary.json)"), "{code} {told}");
    }
}

/// What shows a factor of safety, or a rockfall, is said where a run is looked for.
#[test]
fn folders_without_a_run_say_what_they_hold() {
    let folder = tempfile::tempdir().unwrap();
    for (file, resume) in [("safety.json", "`ndda safety SCENE` goes on"), ("rockfall.json", "map.png")] {
        let path = folder.path().join(file.trim_end_matches(".json"));
        std::fs::create_dir(&path).unwrap();
        std::fs::write(path.join(file), "{}").unwrap();
        for verb in ["report", "resume"] {
            let (code, told) = refused(folder.path(), &[verb, path.to_str().unwrap()]);
            assert!(
                code == 3 && told.contains(resume) && !told.contains("`ndda run"),
                "{verb}: {code} {told}"
            );
        }
    }
}

#[cfg(unix)]
#[test]
fn a_rockfall_that_is_interrupted_keeps_the_falls_that_have_ended() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/works/rockfall.ron");
    let mut ndda = Command::new(env!("CARGO_BIN_EXE_ndda"));
    let words = ["rockfall", scene.to_str().unwrap(), "--count", "2000", "--jobs", "1", "--out", "a"];
    let mut running = ndda
        .args(words)
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // It says how far it is once falls have ended.
    let mut line = String::new();
    let mut told = std::io::BufReader::new(running.stderr.take().unwrap());
    while !line.contains("of 2000 boulders") {
        line.clear();
        assert!(std::io::BufRead::read_line(&mut told, &mut line).unwrap() > 0, "it ended too early");
    }
    // Nobody else writes there meanwhile.
    let again = ["rockfall", scene.to_str().unwrap(), "--count", "1", "--force", "--out", "a"];
    let (code, refusal) = refused(folder.path(), &again);
    assert!(code == 5 && refusal.contains("another run is writing to a"), "{code} {refusal}");
    let id = running.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    let ended = running.wait_with_output().unwrap();
    let said = String::from_utf8(ended.stdout).unwrap();
    assert_eq!(ended.status.code(), Some(130), "{said}");
    assert!(said.contains("warning: interrupted: results are those of the "), "{said}");
    let file = std::fs::read_to_string(folder.path().join("a/rockfall.json")).unwrap();
    let found: Value = serde_json::from_str(&file).unwrap();
    assert!(found["asked"] == 2000 && (1..1000).contains(&found["count"].as_u64().unwrap()), "{file}");
    assert!(folder.path().join("a/reach.asc").is_file());
}
