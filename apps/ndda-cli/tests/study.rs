//! `ndda study` and `ndda plot` from end to end, as processes of the program itself.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::SystemTime;

use ndda::study::case;
use ndda_io::study::LoadedStudy;
use serde_json::Value;

/// A tetrahedron thrown sideways in gravity: its closed form is exact at any step.
const SCENE: &str = "(
    title: \"fall\", time: (step_s: 1e-2, end_s: 0.1), gravity_m_s2: (0, 0, -10), contact: Off,
    materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.25, density_kg_m3: 2500)],
    blocks: [(name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), velocity_m_s: (1, 0, 0))],
    monitors: [(name: \"m\", block: \"b\")], output: (frames: 0), reference: FreeFall(monitor: \"m\", after_s: 0),
)";

/// Poisson's ratio of 0.7 is refused.
const STUDY: &str = "(
    title: \"falls\", scene: \"fall.ron\", repeats: 2,
    axes: [
        Vary(path: \"time.step_s\", values: [1e-2, 5e-3]),
        Choose(name: \"rock\", choices: [
            (label: \"good\", set: {\"materials.rock.poisson\": 0.25}),
            (label: \"bad, too\", set: {\"materials.rock.poisson\": 0.7}),
        ]),
    ],
)";

/// Against two runs in place of the closed form: in free fall all integrators agree to rounding.
const RUNS: &str = "(
    title: \"falls\", scene: \"fall.ron\", repeats: 1,
    axes: [Vary(path: \"time.step_s\", values: [1e-2, 5e-3])],
    reference: Runs(
        first: {\"time.integrator\": Midpoint(theta: 0.5)}, second: {\"time.integrator\": GeneralizedAlpha(radius: 0.8)},
        divisor: 2,
    ),
)";

/// By processor time.
#[cfg(target_os = "linux")]
const PROCESSOR: &str = "(
    title: \"falls\", scene: \"fall.ron\", repeats: 2, clock: Processor,
    axes: [Vary(path: \"time.step_s\", values: [1e-2])],
)";

/// A folder with a scene and a study.
fn folder(study: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("fall.ron"), SCENE).unwrap();
    fs::write(folder.path().join("study.ron"), study).unwrap();
    folder
}

fn ndda(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ndda")).args(arguments).current_dir(folder).output().unwrap()
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

fn json(path: PathBuf) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

fn changed(folder: &Path, case: &str) -> SystemTime {
    let path = folder.join("out/study_study/cases").join(case).join("case.json");
    fs::metadata(path).unwrap().modified().unwrap()
}

#[test]
fn a_study_runs_lists_failures_and_goes_on_where_it_was() {
    let folder = folder(STUDY);
    let done = ndda(folder.path(), &["study", "study.ron", "--jobs", "2"]);
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    let text = said(&done);
    assert!(text.contains("time to error at the end") && text.contains("FreeFall"), "{text}");
    assert!(text.contains("failed: step_s=1e-2__rock=bad_too") && text.contains("poisson"), "{text}");
    let out = folder.path().join("out/study_study");
    let results = json(out.join("study.json"));
    assert_eq!(results["schema"], "ndda.study/1");
    let cases = results["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 4);
    let figures = &cases[0]["figures"];
    assert!(figures["error_max"].as_f64().unwrap() < 1e-12, "{figures}");
    assert_eq!(figures["walls_s"].as_array().unwrap().len(), 2);
    assert_eq!((&figures["time_s"], &results["clock"]), (&figures["wall_s"], &"wall".into()));
    assert_eq!((&figures["steps"], &figures["counts"]["clips_total"]), (&Value::from(10), &Value::from(0)));
    assert!(figures["machine"]["commit"].is_string() && figures["machine"]["processor"].is_string());
    assert!(cases[1]["figures"].is_null() && cases[1]["reason"].as_str().unwrap().contains("poisson"));
    let csv = fs::read_to_string(out.join("study.csv")).unwrap();
    assert!(
        csv.starts_with("case,step_s,rock,status,reason,label,label_reasons,error_end")
            && csv.contains("\"bad, too\",failed,"),
        "{csv}"
    );
    if cfg!(feature = "png") {
        for name in ["error_time", "error_dofs", "stages"] {
            assert!(
                out.join(name).with_extension("svg").exists()
                    && out.join(name).with_extension("png").exists()
            );
        }
    }

    // A second start runs only the case whose record is lost.
    let (kept, lost) = ("step_s=1e-2__rock=good", "step_s=5e-3__rock=good");
    let before = changed(folder.path(), kept);
    fs::remove_file(out.join("cases").join(lost).join("case.json")).unwrap();
    let again = ndda(folder.path(), &["study", "collect", "study.ron"]);
    assert_eq!(again.status.code(), Some(1), "a case is missing");
    assert!(said(&again).contains(&format!("not run: {lost}")));
    assert_eq!(ndda(folder.path(), &["study", "study.ron"]).status.code(), Some(0));
    assert_eq!(changed(folder.path(), kept), before);
    changed(folder.path(), lost);

    // Another scene is another case.
    fs::write(folder.path().join("fall.ron"), SCENE.replace("-10", "-9")).unwrap();
    assert_eq!(ndda(folder.path(), &["study", "study.ron", "--quiet"]).status.code(), Some(0));
    assert!(changed(folder.path(), kept) > before);
}

/// Whose second run, with half the step, ends elsewhere.
const GRAIN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/extreme/small_between_large.ron");

#[test]
fn labels_of_cases_are_those_of_ndda_run_and_second_runs_cost_nothing() {
    let study = |second_runs: &str| {
        let study = format!(
            "(title: \"grain\", scene: {GRAIN:?}, repeats: 2, {second_runs}
            axes: [Vary(path: \"time.step_s\", values: [5e-6])],
            reference: Runs(first: {{}}, second: {{\"time.integrator\": GeneralizedAlpha(radius: 0.8)}}, divisor: 1))"
        );
        let folder = folder(&study);
        let done = ndda(folder.path(), &["study", "study.ron", "--json", "--quiet"]);
        let results: Value = serde_json::from_slice(&done.stdout).expect("results");
        let run = json(folder.path().join("out/study_study/cases/step_s=5e-6/run/summary.json"));
        assert_eq!(run["stages_s"].get("sensitivity"), None, "the last of two runs is not repeated");
        results["cases"][0]["figures"]["label"]["word"].as_str().map(String::from)
    };
    assert_eq!(study("second_runs: Never,").as_deref(), Some("accurate"));
    assert_eq!(study("").as_deref(), Some("inaccurate"));
    let folder = folder(STUDY);
    for (asked, word) in [(&[][..], "inaccurate"), (&["--second-runs", "never"], "accurate")] {
        let sweep = ["study", GRAIN, "--vary", "time.end_s=0.02", "--of", "label", "--quiet", "--out", "s"];
        let done = ndda(folder.path(), &[&sweep, asked].concat());
        let row = fs::read_to_string(folder.path().join("s/sweep.csv")).unwrap();
        assert!(row.contains(&format!(",{word}")) && done.status.success(), "{row}{}", said(&done));
    }
}

#[test]
fn results_are_compared_with_runs_that_agree() {
    let folder = folder(RUNS);
    let done = ndda(folder.path(), &["study", "study.ron", "--json", "--quiet"]);
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    let results: Value = serde_json::from_slice(&done.stdout).unwrap();
    let reference = &results["reference"];
    assert_eq!((&reference["kind"], &reference["step_s"]), (&Value::from("runs"), &Value::from(2.5e-3)));
    assert!(reference["disagreement_max"].as_f64().unwrap() < 1e-12, "{reference}");
    for case in results["cases"].as_array().unwrap() {
        assert!(case["figures"]["error_max"].as_f64().unwrap() < 1e-12, "{case}");
    }
}

#[test]
fn a_scheduler_gets_commands_that_run_one_case_each() {
    let folder = folder(RUNS);
    let list = ndda(folder.path(), &["study", "study.ron", "--emit", "list"]);
    let text = String::from_utf8(list.stdout).unwrap();
    let commands: Vec<&str> = text.lines().collect();
    assert_eq!(commands.len(), 4, "{text}");
    assert!(!folder.path().join("out").exists(), "nothing has run");
    for command in commands {
        let arguments: Vec<&str> = command.split(' ').skip(1).collect();
        let done = ndda(folder.path(), &arguments);
        assert_eq!(done.status.code(), Some(0), "{command}: {}", said(&done));
    }
    assert_eq!(ndda(folder.path(), &["study", "collect", "study.ron", "--quiet"]).status.code(), Some(0));
    assert_eq!(ndda(folder.path(), &["study", "case", "study.ron", "nobody"]).status.code(), Some(3));
}

#[test]
fn what_ran_on_several_threads_is_gathered() {
    let folder = folder(RUNS);
    let done = ndda(folder.path(), &["study", "study.ron", "--threads", "2"]);
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    let collect = |threads| ndda(folder.path(), &["study", "collect", "study.ron", "--threads", threads]);
    assert_eq!(collect("2").status.code(), Some(0), "{}", said(&collect("2")));
    // Their times are not those of one thread.
    assert_ne!(collect("1").status.code(), Some(0));
}

/// A program in the place of `srun`, which keeps the words it is started with and runs the scene by `ndda`.
#[cfg(unix)]
fn stand_in_for_srun(folder: &Path) -> std::ffi::OsString {
    use std::os::unix::fs::PermissionsExt;
    let programs = folder.join("programs");
    fs::create_dir(&programs).unwrap();
    let run = "while [ \"$1\" != run ]; do shift; done";
    let script =
        format!("#!/bin/sh\necho \"$@\" >> srun.log\n{run}\nexec {} \"$@\"\n", env!("CARGO_BIN_EXE_ndda"));
    fs::write(programs.join("srun"), script).unwrap();
    fs::set_permissions(programs.join("srun"), fs::Permissions::from_mode(0o755)).unwrap();
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::join_paths(std::iter::once(programs).chain(std::env::split_paths(&path))).unwrap()
}

#[cfg(unix)]
#[test]
fn an_array_of_slurm_runs_each_case_by_ranks_and_is_gathered() {
    let folder = folder(RUNS);
    let ranks = ["--threads", "2", "--ranks", "3"];
    let with_ranks = |words: &[&str]| ndda(folder.path(), &[words, &ranks[..]].concat());
    let emitted = with_ranks(&["study", "study.ron", "--emit", "slurm"]);
    let script = String::from_utf8(emitted.stdout).unwrap();
    assert!(
        script.contains("#SBATCH --array=0-3%1\n") && script.contains("#SBATCH --ntasks=3\n"),
        "{script}"
    );
    // As Slurm would run it, once for each task.
    let script = script.replace("exec ndda", &format!("exec {}", env!("CARGO_BIN_EXE_ndda")));
    fs::write(folder.path().join("job.sh"), script).unwrap();
    let path = stand_in_for_srun(folder.path());
    for task in 0..4 {
        let mut shell = Command::new("sh");
        shell.arg("job.sh").current_dir(folder.path()).env("PATH", &path).env("SLURM_JOB_ID", "1");
        let done = shell.env("SLURM_ARRAY_TASK_ID", task.to_string()).output().unwrap();
        assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    }
    let log = fs::read_to_string(folder.path().join("srun.log")).unwrap();
    assert_eq!(log.lines().count(), 4, "{log}");
    let is_right = |line: &str| {
        line.starts_with("--ntasks=3 --cpus-per-task=2 --cpu-bind=cores ")
            && line.contains("ndda-mpi run ")
            && line.contains(" --force --quiet --sensitivity ")
            && line.contains(" --threads 2 --set ")
    };
    assert_eq!(log.matches("--sensitivity never").count(), 2, "references have no labels: {log}");
    assert!(log.lines().all(is_right), "{log}");
    let gathered = with_ranks(&["study", "collect", "study.ron"]);
    assert_eq!(gathered.status.code(), Some(0), "{}", said(&gathered));
    // Their times are not those of one process.
    let alone = ndda(folder.path(), &["study", "collect", "study.ron", "--threads", "2"]);
    assert_ne!(alone.status.code(), Some(0));
    for wrong in ["0", "-1", "2.5", "5000", "two"] {
        let refused = ndda(folder.path(), &["study", "study.ron", "--emit", "slurm", "--ranks", wrong]);
        assert_eq!(refused.status.code(), Some(2), "{wrong}: {}", said(&refused));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn processor_times_of_ranks_are_refused_and_a_starter_that_is_not_there_is_named() {
    let run = |study: &str| {
        let folder = folder(study);
        let mut command = Command::new(env!("CARGO_BIN_EXE_ndda"));
        command.args(["study", "study.ron", "--ranks", "2"]).current_dir(folder.path()).env("PATH", "");
        let done = command.env_remove("SLURM_JOB_ID").output().unwrap();
        assert_ne!(done.status.code(), Some(0));
        said(&done)
    };
    assert!(run(PROCESSOR).contains("leave out `clock: Processor`, or --ranks"), "{}", run(PROCESSOR));
    assert!(run(RUNS).contains("cannot start a run: mpirun: "), "{}", run(RUNS));
}

#[test]
fn values_of_the_base_scene_are_set_before_those_of_the_study() {
    let folder = folder(RUNS);
    let set = ["study", "study.ron", "--set", "time.end_s=0.2", "--set", "time.step_s=1"];
    let done = ndda(folder.path(), &set);
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    let results = json(folder.path().join("out/study_study/study.json"));
    let steps: Vec<_> =
        results["cases"].as_array().unwrap().iter().map(|case| case["figures"]["steps"].as_u64()).collect();
    assert_eq!(steps, [Some(20), Some(40)]);
}

#[test]
fn a_wrong_study_is_refused_at_its_place() {
    let folder = folder(&STUDY.replace("time.step_s", "blocks.nobody.at_m"));
    let done = ndda(folder.path(), &["study", "study.ron"]);
    assert_eq!(done.status.code(), Some(3));
    assert!(said(&done).contains("study.ron:4:51: error[override]: axes[0].values[0]"), "{}", said(&done));
    assert_eq!(ndda(folder.path(), &["study", "no.ron"]).status.code(), Some(3));
    assert_eq!(ndda(folder.path(), &["study"]).status.code(), Some(2));
}

#[cfg(target_os = "linux")]
#[test]
fn runs_cost_what_their_threads_compute_when_the_clock_is_the_processors() {
    let folder = folder(PROCESSOR);
    let done = ndda(folder.path(), &["study", "study.ron"]);
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    assert!(said(&done).contains("processor time to error at the end"), "{}", said(&done));
    let results = json(folder.path().join("out/study_study/study.json"));
    let figures = &results["cases"][0]["figures"];
    let times: Vec<f64> =
        figures["processors_s"].as_array().unwrap().iter().map(|s| s.as_f64().unwrap()).collect();
    assert!(times.len() == 2 && times.iter().all(|s| *s > 0.0), "{figures}");
    assert_eq!(figures["time_s"].as_f64(), Some(times[0].min(times[1])));
}

#[test]
fn the_scenes_of_the_example_studies_are_right() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let files = |folder: &str| fs::read_dir(scenes.join(folder)).unwrap().map(|entry| entry.unwrap().path());
    // Beside the paper's studies are their scenes and scripts, beside the others a folder of scenes.
    let is_figure = |path: &PathBuf| path.file_name().unwrap().to_string_lossy().starts_with("fig");
    for path in files("studies").filter(|path| path.is_file()).chain(files("paper").filter(is_figure)) {
        let loaded = LoadedStudy::load(&path).unwrap_or_else(|errors| panic!("{errors}"));
        let cases = case::cases(&loaded).unwrap();
        let references = case::reference_cases(&loaded, &cases).unwrap();
        for case in cases.iter().chain(&references) {
            loaded.scene_with(&case.overrides).unwrap_or_else(|errors| panic!("{}: {errors}", case.name));
        }
    }
}

#[cfg(feature = "plots")]
#[test]
fn columns_of_runs_are_drawn_over_each_other() {
    let folder = folder(STUDY);
    for (out, step) in [("a", "1e-2"), ("b", "5e-3")] {
        let set = format!("time.step_s={step}");
        let done = ndda(folder.path(), &["run", "fall.ron", "--set", &set, "--out", out, "--quiet"]);
        assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    }
    let list = ndda(folder.path(), &["plot", "a"]);
    assert!(said(&list).contains("history.csv: time_s, kinetic_j"), "{}", said(&list));
    let drawn =
        ndda(folder.path(), &["plot", "a", "b/history.csv", "--columns", "kinetic,load_j", "-o", "e.svg"]);
    assert_eq!(drawn.status.code(), Some(0), "{}", said(&drawn));
    let svg = fs::read_to_string(folder.path().join("e.svg")).unwrap();
    for word in ["a: kinetic_j", "b: load_j", "time [s]", "[J]"] {
        assert!(svg.contains(word), "{word} is not in the picture");
    }
    let lost = ndda(folder.path(), &["plot", "a", "--columns", "momentum", "-o", "e.svg"]);
    assert_eq!(lost.status.code(), Some(3));
    assert!(said(&lost).contains("more than one column begins with `momentum`"), "{}", said(&lost));
    assert_eq!(ndda(folder.path(), &["plot", "a", "--columns", "h", "-o", "e.gif"]).status.code(), Some(3));
    assert_eq!(ndda(folder.path(), &["plot", "nobody", "--columns", "h"]).status.code(), Some(3));
}
