//! The step of whole scenes, in contact: what a run costs per step.
#![allow(missing_docs)] // criterion's macro makes public functions

use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use ndda_cli::check::prepare;

fn step(c: &mut Criterion) {
    // Steps until the blocks are in contact for good.
    for (scene, warm_up) in
        [("sliding_45", 1000), ("sliding_45_phi35", 1000), ("collision_equal", 2500), ("spinning_block", 10)]
    {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{scene}.ron"));
        let mut simulation = prepare(&file, &[]).expect("a sound scene").simulation;
        for _ in 0..warm_up {
            simulation.step().expect("a step");
        }
        // A bounded number of steps, so that the block is still on its ramp.
        let mut group = c.benchmark_group("step of a scene");
        group.sample_size(10);
        group.warm_up_time(std::time::Duration::from_millis(100));
        group.measurement_time(std::time::Duration::from_millis(300));
        group.bench_function(scene, |b| b.iter(|| simulation.step().expect("a step")));
        group.finish();
    }
}

criterion_group!(benches, step);
criterion_main!(benches);
