//! One block: its elements, its operator, its frame, its loads, its stresses.
#![allow(missing_docs)] // criterion's macro makes public functions

mod cases;

use std::hint::black_box;

use cases::{Deformed, assemble, cube, element};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use ndda_mesh::Vec3;

/// Cells along the edge: 48, 3072 and 24 576 tetrahedra.
const CELLS: [u32; 3] = [2, 8, 16];

fn one_element(c: &mut Criterion) {
    let corners = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
    c.bench_function("element/stiffness and mass", |b| b.iter(|| element(black_box(&corners))));
}

fn operator(c: &mut Criterion) {
    let mut group = c.benchmark_group("assembly");
    group.sample_size(10);
    for mesh in CELLS.map(cube) {
        group.bench_function(BenchmarkId::from_parameter(mesh.tets.len()), |b| b.iter(|| assemble(&mesh)));
    }
    group.finish();
}

fn block(c: &mut Criterion) {
    for mut block in CELLS.map(Deformed::new) {
        let mut group = c.benchmark_group("block");
        let tets = block.operator.tets.len();
        group.bench_function(BenchmarkId::new("stresses", tets), |b| b.iter(|| block.stresses()));
        group.bench_function(BenchmarkId::new("frame", tets), |b| b.iter(|| block.rotation()));
        group.bench_function(BenchmarkId::new("K w", tets), |b| b.iter(|| block.stiffness_times()));
        group.bench_function(BenchmarkId::new("energy and momentum", tets), |b| b.iter(|| block.motion()));
        group.bench_function(BenchmarkId::new("volume ratio", tets), |b| b.iter(|| block.volume_ratio()));
        group.bench_function(BenchmarkId::new("loads", tets), |b| b.iter(|| block.loads()));
        group.bench_function(BenchmarkId::new("supports", tets), |b| b.iter(|| block.supports()));
        group.finish();
    }
}

criterion_group!(benches, one_element, operator, block);
criterion_main!(benches);
