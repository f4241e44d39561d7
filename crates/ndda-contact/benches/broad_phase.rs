//! The broad phase of a pile of cubes, nearly at rest: keeping the list, making it, and the contact stage beside it.
//! `NDDA_LARGE=1` adds piles of 10 648 and 97 336 blocks.
#![allow(missing_docs)] // criterion's macro makes public functions

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use ndda_contact::candidates::Candidates;
use ndda_contact::testing::{test_box, test_set};
use ndda_contact::{ContactHistory, ContactInput, ContactModel, ContactOutput, PotentialContact};
use ndda_mesh::{BlockSet, Vec3};

/// n³ unit cubes of six tetrahedra in columns, each 1e-4 deep in the one below and 0.02 from its neighbours.
fn pile(n: usize) -> BlockSet {
    let cell = |k: usize| [k % n, k / n % n, k / (n * n)].map(|i| i as f64);
    let cube = |k: usize| {
        let [i, j, l] = cell(k);
        test_box([1.02 * i, 1.02 * j, 0.9999 * l], [1.0; 3], [1, 1, 1])
    };
    test_set((0..n * n * n).map(cube).collect())
}

fn piles(c: &mut Criterion) {
    let mut group = c.benchmark_group("pile");
    group.sample_size(10);
    // A hundred thousand blocks take gigabytes and minutes: on demand.
    let sizes: &[usize] = if std::env::var_os("NDDA_LARGE").is_some() { &[10, 22, 46] } else { &[10] };
    for &n in sizes {
        let blocks = pile(n);
        let nodes = blocks.rest_position.len();
        let velocity = vec![Vec3::zeros(); nodes];
        let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, 1e-4);
        let count = n * n * n;
        let mut kept = Candidates::default();
        kept.update(&input);
        group.bench_function(BenchmarkId::new("keep the list", count), |b| b.iter(|| kept.update(&input)));
        group.bench_function(BenchmarkId::new("make the list", count), |b| {
            b.iter(|| {
                kept.forget();
                kept.update(&input)
            })
        });
        let mut model = PotentialContact::new(1e9);
        let (mut force, mut stiffness) = (vec![Vec3::zeros(); nodes], vec![0.0; nodes]);
        group.bench_function(BenchmarkId::new("contact stage", count), |b| {
            b.iter(|| {
                let mut output =
                    ContactOutput { force: &mut force, friction_force: &mut [], stiffness: &mut stiffness };
                model.add_forces(&input, &mut ContactHistory::default(), &mut output).expect("sound blocks")
            })
        });
    }
    group.finish();
}

criterion_group!(benches, piles);
criterion_main!(benches);
