//! Probability of failure of a slab on a plane against its closed form.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ndda::study::runner::InProcess;
use ndda::sweep::result::Results;
use ndda::sweep::{Ask, How, Sweep, normal};
use ndda_io::study::Sampling;

/// Mean and standard deviation of φ [°] and of c [Pa].
const FRICTION_DEG: (f64, f64) = (30.0, 3.0);
const COHESION_PA: (f64, f64) = (15e3, 3e3);

fn run(samples: u32, sampling: Sampling, jobs: u16, out: PathBuf) -> (Results, String) {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/safety/plane_parameters.ron");
    let vary =
        |name: &str, (mean, deviation): (f64, f64)| format!("parameters.{name}=Normal({mean}, {deviation})");
    let ask = Ask {
        vary: vec![vary("friction_deg", FRICTION_DEG), vary("cohesion_pa", COHESION_PA)],
        fails_when: Some("safety < 1".into()),
        samples: Some(samples),
        sampling: Some(sampling),
        out: Some(out),
        ..Ask::default()
    };
    let sweep = Sweep::open(&scene, &ask).unwrap().expect("a sweep");
    let runner = InProcess::default();
    let how = How { runner: &runner, stop: Arc::default(), say: &|_| {}, jobs, threads: 1 };
    sweep.run(&how).unwrap()
}

/// P(tan φ / tan α + c / (ρ g h sin α cos α) < 1), by the midpoint rule over φ; for each φ it is that of a normal c.
fn closed_form() -> f64 {
    let (sin, cos) = 35f64.to_radians().sin_cos();
    let stress_pa = 2600.0 * 9.81 * 5.0 * sin * cos;
    let part = |i: i32| {
        let z = -8.0 + 16.0 * (f64::from(i) + 0.5) / 4000.0;
        let friction = (FRICTION_DEG.0 + FRICTION_DEG.1 * z).to_radians().tan();
        let least_pa = stress_pa * (1.0 - friction * cos / sin);
        let density = (-0.5 * z * z).exp() / TAU.sqrt();
        density * normal::below((least_pa - COHESION_PA.0) / COHESION_PA.1) * 16.0 / 4000.0
    };
    (0..4000).map(part).sum()
}

#[test]
fn the_probability_of_failure_of_a_plane_slide_is_in_its_interval() {
    let folder = tempfile::tempdir().unwrap();
    let exact = closed_form();
    let (results, json) = run(20, Sampling::LatinHypercube, 2, folder.path().join("two"));
    let failure = results.groups[0].failure.expect("a probability");
    let [low, high] = failure.interval95;
    assert!(low < exact && exact < high, "{exact}: {failure:?}");
    // Each sample fails where its own closed form is below 1, but for those within the error of a trial, 1 %.
    let (sin, cos) = 35f64.to_radians().sin_cos();
    let stress_pa = 2600.0 * 9.81 * 5.0 * sin * cos;
    for row in &results.cases {
        let [friction_deg, cohesion_pa] = [0, 1].map(|i: usize| row.labels[i].parse::<f64>().unwrap());
        let factor = friction_deg.to_radians().tan() * cos / sin + cohesion_pa / stress_pa;
        if (factor - 1.0).abs() > 0.01 {
            assert_eq!(row.fails, Some(factor < 1.0), "{}: F = {factor}", row.name);
        }
    }
    // A quarter of the samples again, as after an interruption, one at a time.
    let (one, other) = (folder.path().join("one"), folder.path().join("two"));
    std::fs::create_dir_all(&one).unwrap();
    let lines = std::fs::read_to_string(other.join("cases.jsonl")).unwrap();
    let half: String = lines.split_inclusive('\n').take(15).collect();
    std::fs::write(one.join("cases.jsonl"), half).unwrap();
    assert_eq!(run(20, Sampling::LatinHypercube, 1, one).1, json);
}
