//! Certificates of scenes whose loads turn back within a step.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use ndda::certify::certificate::Certificate;
use ndda::certify::extrapolate::Behaviour;

fn ndda(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ndda")).args(words).current_dir(folder).output().unwrap()
}

#[test]
fn two_blows_within_the_same_quarter_of_a_step_are_not_certified_as_exact() {
    let folder = tempfile::tempdir().unwrap();
    let blow = |force_n: &str, at_s: f64| {
        format!(
            "(block: \"a\", force_n: ({force_n}, 0, 0), factor: [(time_s: {:e}, factor: 0), (time_s: {at_s:e}, factor: 1), (time_s: {:e}, factor: 0)]), ",
            at_s - 5e-4,
            at_s + 5e-4
        )
    };
    let scene = format!(
        "(title: \"blows\", time: (step_s: 0.01, end_s: 0.4),
          materials: [(name: \"rock\", young_pa: 2e10, poisson: 0.25, density_kg_m3: 2000)],
          blocks: [(name: \"a\", material: \"rock\", body: Rigid, shape: Box(size_m: (0.1, 0.1, 0.1), cells: (1, 1, 1)))],
          forces: [{}{}], monitors: [(name: \"m\", block: \"a\")])",
        blow("4000", 0.1006),
        blow("-4000", 0.2019)
    );
    fs::write(folder.path().join("blows.ron"), scene).unwrap();
    let done = ndda(folder.path(), &["certify", "blows.ron"]);
    let text = String::from_utf8_lossy(&done.stdout);
    for words in
        ["table not resolved", "forces[0].factor turns back within 1.00e-3 s", "--set time.step_s=1e-3"]
    {
        assert!(text.contains(words), "{words} is not in {text}");
    }
    let of = |set: &[&str]| {
        let words = [&["certify", "blows.ron", "--quiet", "--out", "c"][..], set].concat();
        assert_eq!(ndda(folder.path(), &words).status.code(), Some(0));
        Certificate::read(&folder.path().join("c")).unwrap().quantity("m.displacement_x_m").unwrap().clone()
    };
    // 1 m/s from blow to blow.
    let exact_m = 0.2019 - 0.1006;
    let moved = of(&[]);
    assert_eq!(moved.behaviour, Behaviour::Unseen);
    assert!((moved.value - exact_m).abs() > 1e-3, "{moved:?}");
    assert!((moved.value - exact_m).abs() <= moved.error && moved.error < 3e-3, "{moved:?}");
    let followed = of(&["--set", "time.step_s=1e-3"]);
    assert_ne!(followed.behaviour, Behaviour::Unseen);
    assert!((followed.value - exact_m).abs() <= followed.error && followed.error < 3e-4, "{followed:?}");
}
