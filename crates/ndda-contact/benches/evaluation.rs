//! A whole evaluation of contact: potentials, friction laws, energy and tangent, and the slow twin beside it.
#![allow(missing_docs)] // criterion's macro makes public functions

mod cases;

use cases::{Cubes, Evaluation};
use criterion::{Criterion, criterion_group, criterion_main};
use ndda_mesh::generate::BoxPattern;

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

/// The saving that interior faces cancel.
fn all_elements(c: &mut Criterion) {
    for (cells, pattern) in
        [([1, 1, 1], BoxPattern::Six), ([1, 1, 1], BoxPattern::TwentyFour), ([5, 4, 4], BoxPattern::Six)]
    {
        let mut case = Cubes::new(cells, pattern);
        let name = format!("cubes of {} tets", case.tets());
        c.bench_function(&format!("{name}/boundary triangles"), |b| b.iter(|| case.boundary()));
        c.bench_function(&format!("{name}/all pairs of elements"), |b| b.iter(|| case.all_elements()));
    }
}

fn laws(c: &mut Criterion) {
    for potential in ["smooth", "whole", "volume"] {
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

criterion_group!(benches, sizes, all_elements, laws, others);
criterion_main!(benches);
