//! Contact: one pair, a whole evaluation, and the slow twin beside it.
#![allow(missing_docs)] // criterion's macro makes public functions

#[path = "../tests/frictionless/mod.rs"]
mod frictionless;

use criterion::{Criterion, criterion_group, criterion_main};
use ndda_contact::batch::Batches;
use ndda_contact::testing::{test_box, test_set};
use ndda_contact::tet_pair::NodalForces;
use ndda_contact::{
    ContactHistory, ContactInput, ContactModel, ContactOutput, Coulomb, PotentialContact, element_pairs,
    pair::{TetFrame, pair_moments},
};
use ndda_mesh::geometry::{Aabb, TET_FACES, tet_volume, triangle_area_vector};
use ndda_mesh::{BlockSet, TetId, Vec3};
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
    hits(c, "deep", 0.0);
    hits(c, "shallow", 0.97);
    rejects(c, &triangle);
}

/// Faces of random tetrahedra in others, moved towards a face until a corner is just inside; all that is done for a
/// pair after it has been found to overlap.
fn hits(c: &mut Criterion, name: &str, out: f64) {
    let mut pairs = Vec::new();
    for [a, b] in random_pairs() {
        let frame = TetFrame::new(&b);
        let corners = TET_FACES[0].map(|i| a[i]);
        let Some(lambda) = frame.lambda_inside(&corners) else { continue };
        let (face, deepest) = (0..4)
            .map(|b| (b, lambda[b].iter().copied().fold(0.0, f64::max)))
            .min_by(|x, y| x.1.total_cmp(&y.1))
            .expect("four faces");
        let gradient = frame.gradient(face);
        let moved = corners.map(|x| x - out * deepest * gradient / gradient.norm_squared());
        if let Some(lambda) = frame.lambda_inside(&moved) {
            let area_vector = triangle_area_vector(&moved);
            pairs.push((lambda, frame.slopes(&area_vector.normalize()), area_vector.norm()));
        }
    }
    let arch = pulp::Arch::new();
    let mut batches = Batches::default();
    c.bench_function(&format!("kernel/{} {name} pairs", pairs.len()), |x| {
        x.iter(|| {
            for (pair, (lambda, slopes, area)) in black_box(&pairs).iter().enumerate() {
                batches.push_element(arch, pair as u32, *area, lambda, slopes);
            }
            let mut total = 0.0;
            batches.finish(arch, |part| total += part.pressure[0]);
            total
        })
    });
}

/// A triangle and 1024 tetrahedra that touch its box and not itself, in the tight loop of the product.
fn rejects(c: &mut Criterion, triangle: &[Vec3; 3]) {
    let blocks = test_set(vec![test_box([-1.0; 3], [3.0; 3], [6; 3])]);
    let [p, q, r] = triangle;
    let bounds = Aabb::around(triangle);
    let frames: Vec<TetFrame> = (0..blocks.tets.len())
        .map(|tet| blocks.tet_corners(TetId(tet as u32), &blocks.rest_position))
        .filter(|corners| Aabb::around(corners).inflated(0.1).touches(&bounds))
        .map(|corners| TetFrame::new(&corners))
        .filter(|frame| frame.lambda_inside(&[*p, *q, *r]).is_none())
        .collect();
    let frames: Vec<TetFrame> = frames.iter().cycle().take(1024).copied().collect();
    c.bench_function("kernel/1024 rejected candidates", |b| {
        b.iter(|| {
            let triangle = black_box(triangle);
            frames.iter().filter(|frame| frame.lambda_inside(triangle).is_some()).count()
        })
    });
}

/// A block of n³ cells pressed into its equal by a hundredth of a cell, askew.
fn pressed(n: u32) -> BlockSet {
    let lower = test_box([0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [n, n, n]);
    let upper = test_box([0.13, 0.07, 1.0 - 0.01 / f64::from(n)], [1.0, 1.0, 1.0], [n, n, n]);
    test_set(vec![lower, upper])
}

/// 1024 pairs of random tetrahedra in the unit cube that overlap; `benches/peers/r3d.c` takes the same.
fn random_pairs() -> Vec<[[Vec3; 4]; 2]> {
    let mut seed = 1u64;
    let mut random = move || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut tet = move || loop {
        let mut corners = [[0.0; 3]; 4].map(|x| Vec3::from(x.map(|_| random())));
        let volume = tet_volume(&corners);
        if volume < 0.0 {
            corners.swap(0, 1);
        }
        if volume.abs() > 0.02 {
            return corners;
        }
    };
    let pairs = std::iter::from_fn(move || Some([tet(), tet()]));
    pairs.filter(|[a, b]| shared_volume(a, b) > 1e-4).take(1024).collect()
}

fn shared_volume(a: &[Vec3; 4], b: &[Vec3; 4]) -> f64 {
    ndda_contact::overlap::overlap_of(a, &TetFrame::new(b), &a[0]).volume_and_moment().0
}

/// Two tetrahedra: their nodal forces, and the volume that they share.
fn two_tetrahedra(c: &mut Criterion) {
    let pairs = random_pairs();
    let (mut kernel, mut forces) = (NodalForces::default(), vec![[[Vec3::zeros(); 4]; 2]; pairs.len()]);
    c.bench_function("two tetrahedra/nodal forces of 1024 pairs", |x| {
        x.iter(|| {
            kernel.of(black_box(&pairs), 1.0, &mut forces);
            forces[0][0][0]
        })
    });
    c.bench_function("two tetrahedra/shared volume of 1024 pairs", |x| {
        x.iter(|| black_box(&pairs).iter().map(|[a, b]| shared_volume(a, b)).sum::<f64>())
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
    let blocks = pressed(16);
    let nodes = blocks.rest_position.len();
    let velocity = vec![Vec3::x(); nodes];
    let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, 1e-5);
    let (mut force, mut stiffness) = (vec![Vec3::zeros(); nodes], vec![0.0; nodes]);
    let mut twin = frictionless::Frictionless::default();
    c.bench_function("evaluation/16x16 facets, no friction code", |b| {
        b.iter(|| {
            let mut output =
                ContactOutput { force: &mut force, friction_force: &mut [], stiffness: &mut stiffness };
            twin.add_forces(&input, 1e9, &mut output)
        })
    });
    let blocks = pressed(4);
    c.bench_function("evaluation/4x4 facets, slow twin", |b| {
        b.iter(|| element_pairs::forces(&blocks, &blocks.rest_position, 1e9))
    });
}

criterion_group!(benches, one_pair, two_tetrahedra, evaluation);
criterion_main!(benches);
