//! Results have the same bits on any number of threads, and in every run.

use std::path::Path;

use ndda::summary::Status;
use ndda::{Model, Run};
use ndda_io::OutputFolder;

/// Scenes with contact, friction and spin, cut short.
const SCENES: [(&str, &[&str]); 5] = [
    ("collision_equal", &["time.end_s=0.025", "reference.after_s=0"]),
    ("collision_unequal_free", &[]),
    ("sliding_30_phi25", &["time.end_s=0.02", "reference.after_s=0"]),
    ("spinning_block", &["time.end_s=1"]),
    ("sticking_30_phi35", &["time.end_s=0.5"]),
];

fn history(scene: &str, overrides: &[&str], threads: usize) -> Vec<u8> {
    let out = tempfile::tempdir().unwrap();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{scene}.ron"));
    let overrides: Vec<String> =
        overrides.iter().chain(&["output.frames=0"]).map(ToString::to_string).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let model = Model::open(&file, &overrides).unwrap();
        let folder = OutputFolder::create(&out.path().join("results"), false).unwrap();
        let outcome = Run::new(model).record(folder, file).unwrap().finish(&mut []).unwrap();
        assert_eq!(outcome.summary.status, Status::Done, "{scene}");
    });
    std::fs::read(out.path().join("results/history.csv")).unwrap()
}

#[test]
fn history_is_the_same_to_the_byte_on_one_two_and_eight_threads_and_in_two_runs() {
    for (scene, overrides) in SCENES {
        let one = history(scene, overrides, 1);
        for threads in [1, 2, 8] {
            assert!(one == history(scene, overrides, threads), "{scene} differs on {threads} thread(s)");
        }
    }
}
