//! From meshes to checked blocks: generators, validation, surfaces, quality, orientation and merging.
#![allow(missing_docs)] // criterion's macro makes public functions

mod cases;

use cases::{cube, row};
use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use ndda_mesh::BlockSet;
use ndda_mesh::generate::sphere;
use ndda_mesh::quality::quality;
use ndda_mesh::repair::{merge, orient};
use ndda_mesh::stats::stats;
use ndda_mesh::surface::boundary_faces;
use ndda_mesh::validate::problems;

fn generators(c: &mut Criterion) {
    c.bench_function("generate/cube of 24 576 tets", |b| b.iter(|| cube(16)));
    c.bench_function("generate/sphere of 4 levels", |b| b.iter(|| sphere(1.0, 4).expect("a sphere")));
}

fn one_mesh(c: &mut Criterion) {
    let mesh = cube(16);
    let mut group = c.benchmark_group("mesh of 24 576 tets");
    group.sample_size(20);
    group.bench_function("boundary faces", |b| b.iter(|| boundary_faces(&mesh.tets)));
    group.bench_function("problems", |b| b.iter(|| problems(&mesh)));
    group.bench_function("quality", |b| b.iter(|| quality([("cube", &mesh)])));
    group.bench_function("stats", |b| b.iter(|| stats(&mesh)));
    let copy = || mesh.clone();
    group.bench_function("orient", |b| b.iter_batched_ref(copy, orient, BatchSize::LargeInput));
    let merged = |mesh: &mut ndda_mesh::BlockMesh| merge(mesh, 1e-9).expect("no two nodes in one place");
    group.bench_function("merge", |b| b.iter_batched_ref(copy, merged, BatchSize::LargeInput));
    group.finish();
}

fn set(c: &mut Criterion) {
    let mut group = c.benchmark_group("block set");
    group.sample_size(10);
    for (count, n) in [(1000, 1), (1, 16)] {
        let name = BenchmarkId::new(format!("cubes of {n}x{n}x{n} cells"), count);
        let set = |blocks| BlockSet::new(blocks).expect("cubes");
        group.bench_function(name, |b| b.iter_batched(|| row(count, n), set, BatchSize::LargeInput));
    }
    group.finish();
}

criterion_group!(benches, generators, one_mesh, set);
criterion_main!(benches);
