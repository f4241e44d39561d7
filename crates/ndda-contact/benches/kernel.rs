//! Contact: one pair, a whole evaluation, and the slow twin beside it.
#![allow(missing_docs)] // criterion's macro makes public functions

use criterion::{Criterion, criterion_group, criterion_main};
use ndda_contact::testing::{test_box, test_set};
use ndda_contact::{
    ContactHistory, ContactInput, ContactModel, ContactOutput, Coulomb, PotentialContact, element_pairs,
    pair::{TetFrame, pair_moments},
};
use ndda_mesh::geometry::triangle_area_vector;
use ndda_mesh::{BlockSet, Vec3};
use std::hint::black_box;

fn one_pair(c: &mut Criterion) {
    let corners = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
    let triangle = [Vec3::new(0.1, 0.05, 0.02), Vec3::new(0.9, 0.1, -0.1), Vec3::new(0.0, 0.7, 0.15)];
    let area_vector = triangle_area_vector(&triangle);
    c.bench_function("kernel/frame of a tetrahedron", |b| b.iter(|| TetFrame::new(black_box(&corners))));
    let frame = TetFrame::new(&corners);
    c.bench_function("kernel/one overlapping pair", |b| {
        b.iter(|| pair_moments(black_box(&triangle), &area_vector, black_box(&frame)))
    });
    let group = ndda_contact::kernel::PairGroup {
        lambda: frame.lambda(&triangle).map(|at| at.map(|l| [l; 8])),
        slope: [[1.0; 8]; 4],
    };
    let arch = pulp::Arch::new();
    let mut moments = ndda_contact::kernel::GroupMoments::default();
    c.bench_function("kernel/eight overlapping pairs", |b| {
        b.iter(|| ndda_contact::kernel::element_moments(arch, black_box(&group), black_box(&mut moments)))
    });
    let outside = triangle.map(|x| x + Vec3::repeat(1.0));
    c.bench_function("kernel/one pair apart", |b| {
        b.iter(|| pair_moments(black_box(&outside), &area_vector, black_box(&frame)))
    });
}

/// A block of n³ cells pressed into its equal by a hundredth of a cell, askew.
fn pressed(n: u32) -> BlockSet {
    let lower = test_box([0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [n, n, n]);
    let upper = test_box([0.13, 0.07, 1.0 - 0.01 / f64::from(n)], [1.0, 1.0, 1.0], [n, n, n]);
    test_set(vec![lower, upper])
}

/// Two tetrahedra: their nodal forces, and the volume that they share.
fn two_tetrahedra(c: &mut Criterion) {
    let a = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.1, 1.1, 0.0], [0.2, 0.1, 0.9]].map(Vec3::from);
    let b = [[0.3, 0.2, 0.3], [1.2, 0.3, 0.4], [0.3, 1.3, 0.2], [0.4, 0.5, 1.4]].map(Vec3::from);
    c.bench_function("two tetrahedra/nodal forces", |x| {
        x.iter(|| ndda_contact::tet_pair::nodal_forces(black_box(&a), black_box(&b), 1.0))
    });
    c.bench_function("two tetrahedra/shared volume", |x| {
        x.iter(|| {
            let frame = TetFrame::new(black_box(&b));
            ndda_contact::overlap::overlap_of(black_box(&a), &frame, &a[0]).volume_and_moment()
        })
    });
}

fn evaluation(c: &mut Criterion) {
    for n in [4, 16] {
        let blocks = pressed(n);
        let nodes = blocks.rest_position.len();
        let velocity = vec![Vec3::x(); nodes];
        let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, 1e-5);
        for friction in [false, true] {
            let mut model = PotentialContact::new(1e9);
            if friction {
                model = model.with_friction(Box::new(Coulomb::new(30.0, 1e9)));
            }
            let mut history = ContactHistory::default();
            let (mut force, mut shear) = (vec![Vec3::zeros(); nodes], vec![Vec3::zeros(); nodes]);
            let mut stiffness = vec![0.0; nodes];
            let name = format!("evaluation/{n}x{n} facets{}", if friction { ", friction" } else { "" });
            let answer = ndda_contact::testing::evaluate(&mut model, &input, &mut history).report;
            println!("{name}: {} candidate pairs, {} overlap", answer.candidate_pairs, answer.contact_pairs);
            c.bench_function(&name, |b| {
                b.iter(|| {
                    let mut output = ContactOutput {
                        force: &mut force,
                        friction_force: &mut shear,
                        stiffness: &mut stiffness,
                    };
                    model.add_forces(&input, &mut history, &mut output).expect("sound blocks")
                })
            });
        }
    }
    let blocks = pressed(4);
    c.bench_function("evaluation/4x4 facets, slow twin", |b| {
        b.iter(|| element_pairs::forces(&blocks, &blocks.rest_position, 1e9))
    });
}

criterion_group!(benches, one_pair, two_tetrahedra, evaluation);
criterion_main!(benches);
