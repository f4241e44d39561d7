//! Error bars of `ndda certify` on the scenes of the seven studies, against runs of a thirty-second of the step and
//! against closed forms: the true error lies within the bar in 95 % of the quantities, and the bar is at most ten times the
//! true error in the median. `NDDA_LARGE=1` takes all seven, without it four.

#[path = "../../../tests/verification/evidence.rs"]
#[allow(dead_code, reason = "other tests use more of it")]
mod evidence;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use evidence::{Answer, row};
use ndda::certify::certificate::Certificate;
use ndda::certify::extrapolate::Behaviour;
use ndda::certify::quantities::{common_rows, rounding, values};
use ndda_io::table::Table;
use serde_json::Value;

/// A cube thrown in gravity; its closed form is exact at any step.
const FALL: &str = "(
    title: \"fall\", time: (step_s: 1e-2, end_s: 0.1), gravity_m_s2: (0, 0, -10), contact: Off,
    materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.25, density_kg_m3: 2500)],
    blocks: [(name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), velocity_m_s: (1, 0, 0))],
    monitors: [(name: \"m\", block: \"b\")], reference: FreeFall(monitor: \"m\", after_s: 0),
)";

fn ndda(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ndda")).args(words).current_dir(folder).output().unwrap()
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

fn with_fall() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("fall.ron"), FALL).unwrap();
    folder
}

/// Certifies a scene with values set, in a folder of its own.
fn certified(folder: &Path, scene: &str, set: &[&str], options: &[&str]) -> Certificate {
    let scene = scenes().join(scene);
    let mut words = vec!["certify", scene.to_str().unwrap(), "--quiet", "--out", "c"];
    set.iter().for_each(|one| words.extend(["--set", one]));
    words.extend(options);
    let done = ndda(folder, &words);
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    Certificate::read(&folder.join("c")).unwrap()
}

/// A scene of a study at one of the study's steps.
struct Scene {
    name: &'static str,
    file: &'static str,
    step_s: f64,
    end_s: f64,
    set: &'static [&'static str],
    is_large: bool,
}

const COLUMN: &str = "monitors=[(name: \"low\", block: \"column_0001\"), (name: \"middle\", block: \"column_0015\"), \
                      (name: \"high\", block: \"column_0030\")]";

const SCENES: [Scene; 7] = [
    Scene {
        name: "collision",
        file: "collision_equal_free.ron",
        step_s: 2e-3,
        end_s: 0.2,
        set: &[],
        is_large: false,
    },
    Scene { name: "bounce", file: "bounce.ron", step_s: 2e-4, end_s: 0.5, set: &[], is_large: true },
    Scene {
        name: "bar",
        file: "studies/base/bar_impact.ron",
        step_s: 2e-6,
        end_s: 1.1e-3,
        set: &["contact.penalty_pa=2e9"],
        is_large: true,
    },
    Scene {
        name: "cantilever",
        file: "studies/base/cantilever.ron",
        step_s: 1e-3,
        end_s: 0.06,
        set: &["blocks.beam.shape.cells=(10, 2, 2)", "time.integrator=Midpoint()", "reference.after_s=0.04"],
        is_large: false,
    },
    Scene { name: "ramp", file: "sliding_45.ron", step_s: 2e-4, end_s: 0.5, set: &[], is_large: true },
    Scene {
        name: "stack",
        file: "studies/base/stack.ron",
        step_s: 3e-5,
        end_s: 0.015,
        set: &["contact.penalty_pa=2e10"],
        is_large: false,
    },
    Scene {
        name: "column",
        file: "column_phi0.ron",
        step_s: 4e-4,
        end_s: 0.1,
        set: &[COLUMN],
        is_large: false,
    },
];

/// Steps of the run that is the truth, over those of the scene.
const TRUTH: f64 = 32.0;

/// How a certificate compares with the truth.
#[derive(Default)]
struct Score {
    within: usize,
    all: usize,
    /// Bar over true error, where that is more than rounding.
    ratios: Vec<f64>,
}

impl Score {
    fn count(&mut self, error: f64, bar: f64, floor: f64) {
        self.all += 1;
        self.within += usize::from(error <= bar);
        if error > floor {
            self.ratios.push(bar / error);
        }
    }

    fn median(&self) -> f64 {
        let mut ratios = self.ratios.clone();
        ratios.sort_by(f64::total_cmp);
        ratios[ratios.len() / 2]
    }
}

/// Compares all quantities of a scene, at the end and over time, with a run of far shorter steps.
fn score(scene: &Scene) -> Score {
    let folder = tempfile::tempdir().unwrap();
    let (step, end) = (format!("time.step_s={:e}", scene.step_s), format!("time.end_s={:e}", scene.end_s));
    let mut set = vec![step.as_str(), end.as_str()];
    set.extend(scene.set);
    let certificate = certified(folder.path(), scene.file, &set, &[]);
    let history = |run: &str| -> Table { Table::read(&folder.path().join(run).join("history.csv")).unwrap() };
    let fine = history("c/cases/step_4/run");
    let rows = format!("output.history_rows={}", history("c/cases/step_1/run").columns[0].len() - 1);
    let step = format!("time.step_s={:e}", scene.step_s / TRUTH);
    set.extend([step.as_str(), rows.as_str(), "output.frames=0"]);
    let file = scenes().join(scene.file);
    let mut words = vec!["run", file.to_str().unwrap(), "--quiet", "--out", "truth"];
    set.iter().for_each(|one| words.extend(["--set", one]));
    let done = ndda(folder.path(), &words);
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    let truth = history("truth");
    let rows = common_rows(&[&fine, &truth]);
    assert!(rows[0].len() > 10, "{}: {} rows in common", scene.name, rows[0].len());
    let mut score = Score::default();
    for quantity in &certificate.quantities {
        // Blocks that have no monitor in the scene have none in the run that is the truth.
        let Some(exact) = truth.column(&quantity.name) else { continue };
        let (own, exact_rows) =
            (values(&fine, &quantity.name, &rows[0]), values(&truth, &quantity.name, &rows[1]));
        let apart: Vec<f64> = own.iter().zip(&exact_rows).map(|(a, b)| (a - b).abs()).collect();
        let size = exact.iter().map(|v| v.abs()).fold(0.0, f64::max);
        let floor = rounding(size, (scene.end_s / scene.step_s * TRUTH) as u64);
        score.count(*apart.last().unwrap(), quantity.error, floor);
        score.count(apart.iter().copied().fold(0.0, f64::max), quantity.largest_error, floor);
    }
    score
}

#[test]
fn true_errors_lie_within_the_bars_and_bars_are_tight_on_the_scenes_of_the_studies() {
    let is_large = std::env::var_os("NDDA_LARGE").is_some();
    let mut total = Score::default();
    for scene in SCENES.iter().filter(|scene| is_large || !scene.is_large) {
        let found = score(scene);
        println!("{}: {} of {} within, median {:.2}", scene.name, found.within, found.all, found.median());
        total.within += found.within;
        total.all += found.all;
        total.ratios.extend(found.ratios);
    }
    let part = total.within as f64 / total.all as f64;
    row(
        "error bars",
        "quantities whose true error lies within the bar, part of all",
        part,
        Answer::AtLeast(0.95),
    );
    row("error bars", "bar over true error, median", total.median(), Answer::AtMost(10.0));
}

/// Asserts that the bar of a quantity holds a value that is known.
fn holds(certificate: &Certificate, name: &str, exact: f64, what: &str) {
    let quantity = certificate.quantity(name).unwrap();
    let (error, bar) = ((quantity.value - exact).abs(), quantity.error);
    // The statement: the bar holds the error, however much smaller that is.
    row("error bars", what, error / bar, Answer::AtMost(1.0));
}

#[test]
fn closed_forms_lie_within_the_bars_of_step_mesh_and_penalty() {
    let folder = tempfile::tempdir().unwrap();
    let collision = certified(folder.path(), "collision_equal_free.ron", &[], &[]);
    holds(&collision, "centre_B.velocity_x_m_s", 1.0, "collision: error of the speed over its bar");
    let folder = tempfile::tempdir().unwrap();
    let stack = certified(
        folder.path(),
        "studies/base/stack.ron",
        &["contact.penalty_pa=2e10", "time.step_s=3e-5"],
        &["--penalty"],
    );
    holds(
        &stack,
        "top.displacement_z_m",
        -16.23125e-6,
        "stack: error of the settlement over its bar, penalty included",
    );
    let folder = tempfile::tempdir().unwrap();
    let cells = ["blocks.beam.shape.cells=(10, 2, 2)", "blocks.beam.shape.pattern=TwentyFour"];
    let beam = certified(folder.path(), "studies/base/cantilever.ron", &cells, &["--mesh"]);
    holds(
        &beam,
        "tip.displacement_z_m",
        -96.75e-6,
        "cantilever: error of the deflection over its bar, mesh included",
    );
}

#[test]
fn a_fall_is_exact_to_rounding_and_its_certificate_is_written_shown_and_kept() {
    let folder = with_fall();
    let done = ndda(folder.path(), &["certify", "fall.ron", "--of", "momentum"]);
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    let text = said(&done);
    for words in
        ["exact to rounding", "momentum_x_kg_m_s", "the error of the time step, for the laws", "time spent"]
    {
        assert!(text.contains(words), "{words} is not in {text}");
    }
    let certificate = Certificate::read(&folder.path().join("out/fall_certified")).unwrap();
    let fallen = certificate.quantity("m.displacement_z_m").unwrap();
    assert!((fallen.value + 0.05).abs() <= fallen.error && fallen.error < 1e-12, "{fallen:?}");
    assert_eq!((fallen.behaviour, certificate.order_of_scheme), (Behaviour::Rounding, 2.0));
    assert!(certificate.chaos.is_none() && certificate.runs.len() == 3, "{certificate:?}");
    // Given again, the command runs nothing; with --json it prints the file.
    let again = ndda(folder.path(), &["certify", "fall.ron", "--of", "momentum", "--json"]);
    assert_eq!(said(&again).matches("has run").count(), 3, "{}", said(&again));
    let printed: Value = serde_json::from_slice(&again.stdout).unwrap();
    assert_eq!(printed["schema"], "ndda.certificate/1");
    if cfg!(feature = "report") {
        let page = ndda(folder.path(), &["report", "out/fall_certified", "-o", "page.html"]);
        assert_eq!(page.status.code(), Some(0), "{}", said(&page));
        let page = fs::read_to_string(folder.path().join("page.html")).unwrap();
        assert!(page.contains("Error bars") && page.contains("m.displacement_z_m"));
    }
}

#[test]
fn thousands_of_blocks_that_fall_have_their_error_bars() {
    let folder = tempfile::tempdir().unwrap();
    let set = |name: &str, dip_deg: f64, direction_deg: f64| {
        format!(
            "Set(name: \"{name}\", dip_deg: {dip_deg}, dip_direction_deg: {direction_deg}, spacing_m: 1), "
        )
    };
    let scene = format!(
        "(title: \"many fall\", time: (step_s: 1e-3, end_s: 5e-3), gravity_m_s2: (0, 0, -10), contact: Off,
          materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.25, density_kg_m3: 2500)],
          rock: [(name: \"a_rather_long_name_of_rock\", material: \"rock\", body: Rigid, fill: Fewest,
            domain: Box(min_m: (0, 0, 0), max_m: (14, 14, 14)), joints: [{}{}{}])])",
        set("flat", 0.0, 0.0),
        set("north", 90.0, 0.0),
        set("east", 90.0, 90.0)
    );
    fs::write(folder.path().join("many.ron"), scene).unwrap();
    let done = ndda(folder.path(), &["certify", "many.ron", "--quiet", "--out", "c"]);
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    let certificate = Certificate::read(&folder.path().join("c")).unwrap();
    let fallen: Vec<_> =
        certificate.quantities.iter().filter(|q| q.name.ends_with(".displacement_z_m")).collect();
    assert!(fallen.len() > 2000, "{} blocks", fallen.len());
    // ½ g t², which the scheme gives exactly.
    for block in fallen {
        assert!((block.value + 1.25e-4).abs() <= block.error.max(1e-15), "{block:?}");
    }
}

#[test]
fn examples_are_certified_as_files_are() {
    let folder = tempfile::tempdir().unwrap();
    let set = ["certify", "--example", "collision_equal_free", "--quiet", "--out", "c"];
    let done = ndda(folder.path(), &set);
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    assert!(Certificate::read(&folder.path().join("c")).is_some());
}

#[test]
fn what_cannot_be_certified_is_refused_with_advice() {
    let folder = with_fall();
    for (words, code, advice) in [
        (vec!["certify", "nobody.ron"], 3, "cannot be read"),
        (vec!["certify", "fall.ron", "--penalty", "--quiet"], 3, "has no contact"),
        (
            vec!["certify", "fall.ron", "--of", "nobody", "--quiet"],
            3,
            "no column of the history begins with it",
        ),
        (vec!["certify", "fall.ron", "--mesh", "3"], 2, "0..=2"),
        (vec!["tune", "fall.ron"], 2, "--error"),
        (vec!["tune", "fall.ron", "--error", "2"], 2, "between 0 and 1"),
        (vec!["tune", "fall.ron", "--error", "1e-2", "--of", "nobody", "--quiet"], 3, "begins with it"),
    ] {
        let done = ndda(folder.path(), &words);
        assert_eq!(done.status.code(), Some(code), "{words:?}: {}", said(&done));
        assert!(said(&done).contains(advice), "{words:?}: {}", said(&done));
    }
    // A step at which contact explodes, also when it is halved twice.
    let scene = scenes().join("studies/base/stack.ron");
    let words =
        ["certify", scene.to_str().unwrap(), "--set", "time.step_s=5e-4", "--set", "contact.penalty_pa=2e12"];
    let done = ndda(folder.path(), &[&words[..], &["--quiet"]].concat());
    assert_eq!(done.status.code(), Some(4), "{}", said(&done));
    assert!(said(&done).contains("ndda check"), "{}", said(&done));
}

#[test]
fn tuning_finds_a_setting_that_reaches_the_error_and_says_what_it_tried() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scenes().join("collision_equal_free.ron");
    let words = ["tune", scene.to_str().unwrap(), "--error", "1e-3", "--quiet", "--out", "t"];
    let done = ndda(folder.path(), &words);
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    let text = said(&done);
    for words in ["the best settings, none of which", "all that was tried", "--set time.step_s="] {
        assert!(text.contains(words), "{words} is not in {text}");
    }
    let tuned: Value =
        serde_json::from_str(&fs::read_to_string(folder.path().join("t/tune.json")).unwrap()).unwrap();
    assert_eq!((&tuned["schema"], &tuned["is_reached"]), (&"ndda.tune/1".into(), &true.into()));
    assert!(tuned["tried"].as_array().unwrap().len() > 5);
    // The setting, given to `ndda run`, has the error that was found.
    let set: Vec<&str> =
        tuned["best"]["set"].as_array().unwrap().iter().map(|one| one.as_str().unwrap()).collect();
    let mut words = vec!["run", scene.to_str().unwrap(), "--quiet", "--out", "r", "--set", "output.frames=0"];
    set.iter().for_each(|one| words.extend(["--set", one]));
    assert_eq!(ndda(folder.path(), &words).status.code(), Some(0));
    let summary: Value =
        serde_json::from_str(&fs::read_to_string(folder.path().join("r/summary.json")).unwrap()).unwrap();
    let error = summary["reference"]["error_end"].as_f64().unwrap();
    assert!(error <= 1e-3, "{error:e}");
}

#[test]
fn tuning_says_when_nothing_reaches_the_error() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scenes().join("studies/base/cantilever.ron");
    // The error is that of the mesh, which may not be changed.
    let words = [
        "tune",
        scene.to_str().unwrap(),
        "--error",
        "1e-3",
        "--quiet",
        "--set",
        "blocks.beam.shape.cells=(10, 1, 1)",
    ];
    let done = ndda(folder.path(), &words);
    assert_eq!(done.status.code(), Some(1), "{}", said(&done));
    assert!(said(&done).contains("no setting reaches an error of 1e-3"), "{}", said(&done));
}
