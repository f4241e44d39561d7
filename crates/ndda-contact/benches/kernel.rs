//! The kernel: one pair, many pairs, two tetrahedra.
#![allow(missing_docs)] // criterion's macro makes public functions

mod cases;

use std::hint::black_box;

use cases::{Hits, Rejects, random_pairs, shared_volume};
use criterion::{Criterion, criterion_group, criterion_main};
use ndda_contact::integration::TetFrame;
use ndda_contact::integration::pair_moments;
use ndda_contact::reference::tet_pair::{NodalForces, pair_forces};
use ndda_mesh::Vec3;
use ndda_mesh::geometry::triangle_area_vector;

fn one_pair(c: &mut Criterion) {
    let corners = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
    let triangle = [[0.1, 0.05, 0.02], [0.9, 0.1, -0.1], [0.0, 0.7, 0.15]].map(Vec3::from);
    let area_vector = triangle_area_vector(&triangle);
    c.bench_function("pair/frame of a tetrahedron", |b| b.iter(|| TetFrame::new(black_box(&corners))));
    let frame = TetFrame::new(&corners);
    c.bench_function("clip/one overlapping pair, corner by corner", |b| {
        b.iter(|| pair_moments(black_box(&triangle), &area_vector, black_box(&frame)))
    });
    let rejects = Rejects::new();
    c.bench_function("pair/1024 rejected candidates", |b| b.iter(|| rejects.look()));
}

fn many_pairs(c: &mut Criterion) {
    for (name, mut hits) in [("deep", Hits::deep()), ("shallow", Hits::shallow())] {
        c.bench_function(&format!("kernel/{} {name} pairs", hits.count()), |b| b.iter(|| hits.integrate()));
    }
}

/// `benches/peers/r3d.sh` measures the shared volume of the same pairs.
fn two_tetrahedra(c: &mut Criterion) {
    let pairs = random_pairs();
    let (mut kernel, mut forces) = (NodalForces::default(), vec![[[Vec3::zeros(); 4]; 2]; pairs.len()]);
    c.bench_function("tet_pair/nodal forces of 1024 pairs", |b| {
        b.iter(|| kernel.of(black_box(&pairs), 1.0, &mut forces))
    });
    c.bench_function("tet_pair/all about 1024 pairs, right to rounding", |b| {
        b.iter(|| pairs.iter().filter(|[a, b]| pair_forces(black_box(a), b, 1.0).is_ok()).count())
    });
    c.bench_function("overlap/shared volume of 1024 pairs", |b| {
        b.iter(|| black_box(&pairs).iter().map(|[a, b]| shared_volume(a, b)).sum::<f64>())
    });
}

criterion_group!(benches, one_pair, many_pairs, two_tetrahedra);
criterion_main!(benches);
