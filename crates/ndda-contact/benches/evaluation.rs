//! A whole evaluation of contact: potentials, friction laws, energy and tangent, and the slow twin beside it.
#![allow(missing_docs)] // criterion's macro makes public functions

mod cases;

use cases::Evaluation;
use criterion::{Criterion, criterion_group, criterion_main};

fn sizes(c: &mut Criterion) {
    for n in [4, 16] {
        let mut case = Evaluation::new(n, "element", "none");
        let report = case.step();
        println!(
            "{n}×{n} facets: {} candidate pairs, {} overlap",
            report.candidate_pairs, report.contact_pairs
        );
        c.bench_function(&format!("element_potential/{n}x{n} facets"), |b| b.iter(|| case.step()));
    }
    let case = Evaluation::new(4, "element", "none");
    c.bench_function("element_pairs/4x4 facets, all pairs of elements", |b| b.iter(|| case.slow_twin()));
}

fn laws(c: &mut Criterion) {
    for potential in ["smooth", "volume"] {
        let mut case = Evaluation::new(16, potential, "none");
        c.bench_function(&format!("{potential}_potential/16x16 facets"), |b| b.iter(|| case.step()));
    }
    let mut case = Evaluation::new(16, "element", "none");
    c.bench_function("friction/16x16 facets, no friction code", |b| b.iter(|| case.frictionless_step()));
    for (file, friction) in [("coulomb", "spring"), ("velocity_friction", "velocity")] {
        let mut case = Evaluation::new(16, "element", friction);
        c.bench_function(&format!("{file}/16x16 facets"), |b| b.iter(|| case.step()));
    }
}

fn others(c: &mut Criterion) {
    let mut case = Evaluation::new(16, "element", "none");
    c.bench_function("energy/16x16 facets", |b| b.iter(|| case.energy()));
    let mut pairs = Vec::new();
    c.bench_function("tangent/16x16 facets", |b| b.iter(|| case.tangent(&mut pairs)));
}

criterion_group!(benches, sizes, laws, others);
criterion_main!(benches);
