//! Parameters of scenes, and `ndda study` without a reference, as processes of the program itself.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

/// A cube that is thrown sideways in gravity: it goes v t and falls ½ g t².
const SCENE: &str = "(
    title: \"fall\", parameters: (speed_m_s: 1, half_g_m_s2: 5), include: \"rock.ron\",
    time: (step_s: 1e-2, end_s: 0.1), gravity_m_s2: (0, 0, Calc(-2 * half_g_m_s2)), contact: Off,
    blocks: [(name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), velocity_m_s: (Calc(speed_m_s), 0, 0))],
    monitors: [(name: \"m\", block: \"b\")], output: (frames: 0),
)";
const ROCK: &str = "[(name: \"rock\", young_pa: 1e9, poisson: 0.25, density_kg_m3: 2500)]";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("fall.ron"), SCENE).unwrap();
    fs::write(folder.path().join("rock.ron"), ROCK).unwrap();
    folder
}

fn ndda(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ndda")).args(arguments).current_dir(folder).output().unwrap()
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

#[track_caller]
fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = ndda(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    said(&output)
}

fn json(file: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap()
}

#[test]
fn a_parameter_is_set_on_the_command_line() {
    let folder = folder();
    done(folder.path(), &["run", "fall.ron", "--out", "a", "--quiet", "--set", "parameters.speed_m_s=3"]);
    let summary = json(&folder.path().join("a/summary.json"));
    let gone = summary["monitors"]["m"]["displacement"][0].as_f64().unwrap();
    assert!((gone - 0.3).abs() < 1e-12, "{gone}");
    let refused = ndda(folder.path(), &["check", "fall.ron", "--set", "parameters.sped_m_s=3"]);
    assert_eq!(refused.status.code(), Some(3));
    assert!(said(&refused).contains("did you mean `speed_m_s`"), "{}", said(&refused));
    let explained = done(folder.path(), &["explain", "fall.ron"]);
    assert!(explained.contains("speed_m_s = 1"), "{explained}");
}

#[test]
fn a_grid_gives_a_table_of_quantities_and_a_picture() {
    let folder = folder();
    let grid =
        ["study", "fall.ron", "--vary", "parameters.speed_m_s=1,2", "--vary", "parameters.half_g_m_s2=5,0"];
    let text = done(
        folder.path(),
        &[&grid[..], &["--of", "m.displacement_m,kinetic,label", "--jobs", "2"]].concat(),
    );
    assert!(
        text.contains("half_g_m_s2") && text.contains("kinetic_j") && text.contains("accurate"),
        "{text}"
    );
    let out = folder.path().join("out/fall_study");
    let results = json(&out.join("sweep.json"));
    assert_eq!(
        (&results["schema"], &results["quantities"][1]),
        (&"ndda.sweep/1".into(), &"kinetic_j".into())
    );
    let cases = results["cases"].as_array().unwrap();
    for (case, (speed, half_g)) in cases.iter().zip([(1.0, 5.0), (1.0, 0.0), (2.0, 5.0), (2.0, 0.0)]) {
        let gone = case["values"][0].as_f64().unwrap();
        assert!((gone - f64::hypot(0.1 * speed, 0.01 * half_g)).abs() < 1e-12, "{case}");
        let energy = case["values"][1].as_f64().unwrap();
        let exact = 0.5 * 2500.0 * (speed * speed + (2.0 * half_g * 0.1).powi(2));
        assert!((energy / exact - 1.0).abs() < 1e-9, "{case}");
    }
    let csv = fs::read_to_string(out.join("sweep.csv")).unwrap();
    assert!(
        csv.starts_with("case,status,reason,label,fails,speed_m_s,half_g_m_s2,m.displacement_m"),
        "{csv}"
    );
    assert_eq!(out.join("sweep_kinetic_j.svg").exists(), cfg!(feature = "plots"));
    assert_eq!(out.join("sweep.parquet").exists(), cfg!(feature = "parquet"));
}

#[test]
fn warnings_of_the_scenes_are_said_once_with_the_cases_that_have_them() {
    let folder = folder();
    let incompressible = ROCK.replace("0.25", "0.495");
    fs::write(folder.path().join("rock.ron"), incompressible).unwrap();
    let all = done(folder.path(), &["study", "fall.ron", "--vary", "parameters.speed_m_s=1,2"]);
    assert_eq!(all.matches("warning").count(), 1, "{all}");
    assert!(
        all.contains("warning: include: rock.ron:1:41: [0].poisson: nearly incompressible; four-node"),
        "{all}"
    );
    fs::write(folder.path().join("rock.ron"), ROCK).unwrap();
    let one = done(folder.path(), &["study", "fall.ron", "--vary", "parameters.half_g_m_s2=4,5,5000"]);
    assert!(one.contains("warning in 1 of 3 cases: gravity_m_s2: 10000 m/s²"), "{one}");
}

#[test]
fn samples_are_the_same_for_any_number_of_jobs_and_after_an_interruption() {
    let folder = folder();
    let args = |out: &'static str, jobs: &'static str| {
        let vary = ["study", "fall.ron", "--vary", "parameters.speed_m_s=Uniform(1, 2)", "--seed", "3"];
        let how =
            ["--samples", "20", "--fails-when", "m.displacement_x_m > 0.14", "--out", out, "--jobs", jobs];
        [&vary[..], &how].concat()
    };
    let text = done(folder.path(), &args("a", "2"));
    // It goes 0.14 m at 1.4 m/s, above which lie 12 of the 20 strata of a Latin hypercube.
    assert!(text.contains("(m.displacement_x_m > 0.14): 0.600 (0.387 to 0.781), 12 of 20"), "{text}");
    assert!(text.contains("Wilson"), "{text}");
    done(folder.path(), &args("b", "1"));
    let result = |out: &str| fs::read_to_string(folder.path().join(out).join("sweep.json")).unwrap();
    assert_eq!(result("a"), result("b"));
    let file = folder.path().join("b/cases.jsonl");
    let lines = fs::read_to_string(&file).unwrap();
    fs::write(&file, &lines[..lines.len() / 2]).unwrap();
    let again = done(folder.path(), &args("b", "2"));
    let computed = again.lines().filter(|line| line.ends_with(": done")).count();
    assert!((9..20).contains(&computed), "{computed}: {again}");
    assert_eq!(result("a"), result("b"));
    fs::write(folder.path().join("rock.ron"), ROCK.replace("2500", "2600")).unwrap();
    let changed = done(folder.path(), &args("b", "2"));
    assert_eq!(changed.lines().filter(|line| line.ends_with(": done")).count(), 20, "{changed}");
}

#[test]
fn a_study_file_names_distributions_correlation_and_sensitivity() {
    let folder = folder();
    let random = "Random(path: \"parameters.speed_m_s\", distribution: Normal(2, 0.1)),
        Random(path: \"parameters.half_g_m_s2\", distribution: Normal(5, 1)),";
    let study = |more: &str| {
        let text = format!(
            "(title: \"s\", scene: \"fall.ron\", axes: [{random}], samples: 64, sampling: Sobol, {more})"
        );
        fs::write(folder.path().join("s.ron"), text).unwrap();
    };
    study("of: [\"m.displacement_x_m\"], sensitivity: true");
    let text = done(folder.path(), &["study", "s.ron", "--quiet", "--jobs", "2"]);
    assert!(text.contains("fractions of the variance"), "{text}");
    let results = json(&folder.path().join("out/s_study/sweep.json"));
    let index = |i: usize, key: &str| results["groups"][0]["sensitivity"][i][key].as_f64().unwrap();
    // The way is v t, whatever gravity is.
    assert!((index(0, "total") - 1.0).abs() < 0.1 && index(1, "total") < 1e-12, "{results}");
    assert_eq!(results["cases"].as_array().unwrap().len(), 64 * 4);
    for arguments in [&["study", "s.ron", "--emit", "list"][..], &["study", "collect", "s.ron"]] {
        let refused = ndda(folder.path(), arguments);
        assert_eq!(refused.status.code(), Some(3));
        assert!(said(&refused).contains("runs it as a whole"), "{}", said(&refused));
    }
    study("of: [\"m\"], correlations: [(between: (\"speed_m_s\", \"half_g\"), coefficient: 0.5)]");
    let refused = ndda(folder.path(), &["study", "s.ron"]);
    assert_eq!(refused.status.code(), Some(3));
    assert!(said(&refused).contains("did you mean `half_g_m_s2`"), "{}", said(&refused));
}

#[test]
fn what_cannot_be_swept_is_refused_with_what_to_write() {
    let folder = folder();
    let vary = ["--vary", "parameters.speed_m_s=1,2"];
    for (arguments, word) in [
        (vec!["--vary", "parameters.sped_m_s=1"], "did you mean `speed_m_s`"),
        (vec!["--vary", "parameters.speed_m_s=Normal(1)"], "Normal(mean, deviation)"),
        (vec!["--vary", "parameters.speed_m_s=Normal(1, -1)"], "above 0"),
        (
            [&vary[..], &["--of", "kinetik_j"]].concat(),
            "no run has a quantity `kinetik_j`: did you mean `kinetic_j`",
        ),
        ([&vary[..], &["--of", "saf"]].concat(), "did you mean `safety`, `safety_lower`, `safety_upper`?"),
        ([&vary[..], &["--of", "safetyy"]].concat(), "runs have label, safety, "),
        (
            [&vary[..], &["--fails-when", "displacement_x > 1"]].concat(),
            "did you mean `block b.displacement_x_m`",
        ),
        ([&vary[..], &["--samples", "5"]].concat(), "--samples has no effect"),
        ([&vary[..], &["--seed", "5"]].concat(), "--seed has no effect"),
        (vec!["--vary", "parameters.speed_m_s=Norml(1, 2)"], "did you mean `Normal`?"),
        (vec!["--vary", "parameters.speed_m_s=1, 2)"], "`)` follows"),
        ([&vary[..], &["--fails-when", "kinetic_j"]].concat(), "safety < 1"),
        ([&vary[..], &["--fails-when", "m.displacement > 1"]].concat(), "may be on any of m.displacement_"),
        ([&vary[..], &["--correlate", "a"]].concat(), "not a correlation"),
        ([&vary[..], &["--sensitivity"]].concat(), "give at least one a distribution"),
    ] {
        let refused = ndda(folder.path(), &[&["study", "fall.ron", "--quiet"], &arguments[..]].concat());
        assert_eq!(refused.status.code(), Some(3), "{arguments:?}: {}", said(&refused));
        assert!(said(&refused).contains(word), "{arguments:?}: {}", said(&refused));
    }
    // The refusal comes before any computation and before any folder is made.
    assert!(!folder.path().join("out").exists());
    done(folder.path(), &["run", "fall.ron", "--out", "run", "--quiet"]);
    let refused = ndda(folder.path(), &[&["study", "fall.ron", "--out", "run"], &vary[..]].concat());
    assert!(said(&refused).contains("run holds the results of a run (summary.json)"), "{}", said(&refused));
}

#[test]
fn a_value_that_is_set_is_blamed_for_what_is_wrong_with_it() {
    let folder = folder();
    for (set, word) in [
        ("time.step_s=1e-3, end_s: 5", "`, end_s: 5` follows"),
        ("time.step_s=(1, 2", "`(` is not closed"),
        ("time.step_s=abc", "expected a number (set by --set time.step_s=abc)"),
        ("time.step_s=-1", "must be positive (set by --set time.step_s=-1)"),
        ("output.frames=Calc(5 / 2)", "the value 2.5 is not a whole number (set by --set output.frames"),
        ("output.frames=1.5", "the value 1.5 is not a whole number"),
        ("output.frames=Calc(-3)", "-3 is not a count"),
    ] {
        let refused = ndda(folder.path(), &["check", "fall.ron", "--set", set]);
        assert_eq!(refused.status.code(), Some(3), "{set}");
        assert!(said(&refused).contains(word), "{set}: {}", said(&refused));
    }
}

#[test]
#[cfg(target_os = "linux")]
fn files_without_an_end_are_refused() {
    let folder = folder();
    let scene = SCENE.replace("\"rock.ron\"", "\"/dev/zero\"");
    fs::write(folder.path().join("endless.ron"), scene).unwrap();
    for arguments in [&["check", "endless.ron"][..], &["stereonet", "/dev/zero"], &["joint", "/dev/zero"]] {
        let refused = ndda(folder.path(), arguments);
        assert_eq!(refused.status.code(), Some(3), "{arguments:?}: {}", said(&refused));
    }
}

#[test]
fn a_probability_of_samples_without_a_value_is_unknown() {
    let folder = folder();
    let vary = ["study", "fall.ron", "--vary", "time.step_s=Uniform(-2, -1)", "--samples", "3"];
    let output = ndda(folder.path(), &[&vary[..], &["--fails-when", "kinetic_j > 1", "--quiet"]].concat());
    assert!(said(&output).contains("unknown, no sample has a value"), "{}", said(&output));
    let result = json(&folder.path().join("out/fall_study/sweep.json"));
    assert!(result["groups"][0]["failure"].is_null(), "{result}");
}

#[test]
fn a_field_that_no_scene_has_is_refused_before_the_first_case() {
    let folder = folder();
    for (vary, words) in [
        ("time.stp_s=1e-3,5e-4", "time.stp_s: there is no field `stp_s`"),
        ("time.step_s=Normal(1e-3)", "`Normal(1e-3)`: write Normal(mean, deviation), with numbers"),
    ] {
        let refused = ndda(folder.path(), &["study", "fall.ron", "--vary", vary, "--out", "s"]);
        assert_eq!(refused.status.code(), Some(3), "{}", said(&refused));
        assert_eq!(said(&refused).matches(words).count(), 1, "{}", said(&refused));
        assert!(!folder.path().join("s").exists());
    }
}
