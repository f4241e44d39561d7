//! The step of free blocks by size and by number, and what it costs to begin.
#![allow(missing_docs)] // criterion's macro makes public functions

mod cases;

use cases::{cubes, elastic_cubes};
use criterion::{Criterion, criterion_group, criterion_main};
use ndda_solver::{BodyKind, GeneralizedAlpha, Midpoint, Newmark, TimeIntegrator};

fn step(c: &mut Criterion) {
    for (count, n) in [(1, 2), (1, 8), (1, 16), (64, 2)] {
        let mut simulation = elastic_cubes(count, n);
        let name = format!("step/{count} cube(s) of {n}x{n}x{n} cells");
        c.bench_function(&name, |b| b.iter(|| simulation.step().expect("a step")));
    }
}

/// Costs of integrators and kinds of bodies, side by side.
fn laws(c: &mut Criterion) {
    let integrators: [(&str, Box<dyn TimeIntegrator>); 3] = [
        ("Midpoint", Box::new(Midpoint { theta: 0.5 })),
        ("Newmark", Box::new(Newmark { alpha: 0.25, delta: 0.5 })),
        ("GeneralizedAlpha", Box::new(GeneralizedAlpha { radius: 0.8 })),
    ];
    for (name, integrator) in integrators {
        let mut simulation = cubes(8, 4, BodyKind::Elastic, integrator);
        c.bench_function(&format!("integrator/{name}, 8 cubes of 4x4x4 cells"), |b| {
            b.iter(|| simulation.step().expect("a step"))
        });
    }
    for kind in [BodyKind::Affine, BodyKind::Rigid] {
        let mut simulation = cubes(8, 4, kind, Box::new(Midpoint { theta: 0.5 }));
        c.bench_function(&format!("body/{kind:?}, 8 cubes of 4x4x4 cells"), |b| {
            b.iter(|| simulation.step().expect("a step"))
        });
    }
}

fn begin(c: &mut Criterion) {
    let mut group = c.benchmark_group("begin");
    group.sample_size(10);
    group
        .bench_function("64 congruent cubes of 4x4x4 cells: one factor", |b| b.iter(|| elastic_cubes(64, 4)));
    group.bench_function("1 cube of 16x16x16 cells", |b| b.iter(|| elastic_cubes(1, 16)));
    group.finish();
}

criterion_group!(benches, step, laws, begin);
criterion_main!(benches);
