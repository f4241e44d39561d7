//! The broad phase of a pile, nearly at rest: three ways to find the blocks that meet; keeping the list of pairs,
//! renewing it and making it; and the contact stage beside it.
//!
//! `NDDA_LARGE=1` adds piles of 10 648 and 97 336 blocks, which take gigabytes and minutes.
#![allow(missing_docs)] // criterion's macro makes public functions

mod twins;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use ndda_contact::affine::ConvexBlocks;
use ndda_contact::broad_phase::Candidates;
use ndda_contact::testing::{Random, test_set};
use ndda_contact::{ContactHistory, ContactInput, ContactModel, ContactOutput, PotentialContact};
use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::geometry::Aabb;
use ndda_mesh::{BlockId, BlockSet, Mat3, Vec3};
use twins::{BoxPairs, Grid, Sweep, Tree};

/// n³ unit cubes in columns, each 1e-4 deep in the one below and 0.02 from its neighbours.
fn pile(n: usize, pattern: BoxPattern) -> BlockSet {
    let cube = box_block([1.0; 3], [1, 1, 1], pattern).expect("positive sizes");
    let place = |k: usize| {
        let [i, j, l] = [k % n, k / n % n, k / (n * n)].map(|i| i as f64);
        cube.clone().placed(&Mat3::identity(), &Vec3::new(1.02 * i, 1.02 * j, 0.9999 * l))
    };
    test_set((0..n * n * n).map(place).collect())
}

/// Blocks along an edge of the pile.
fn sizes() -> &'static [usize] {
    if std::env::var_os("NDDA_LARGE").is_some() { &[10, 22, 46] } else { &[10] }
}

fn update(c: &mut Criterion) {
    for pattern in [BoxPattern::Six, BoxPattern::TwentyFour] {
        let mut group = c.benchmark_group(format!("{pattern:?}"));
        group.sample_size(10);
        let sizes = if pattern == BoxPattern::Six { sizes() } else { &sizes()[..1] };
        for &n in sizes {
            let blocks = pile(n, pattern);
            let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
            let mut position = blocks.rest_position.clone();
            let count = n * n * n;
            let (mut kept, none) = (Candidates::default(), ConvexBlocks::default());
            kept.update(&ContactInput::new(&blocks, &position, &velocity, 1e-4), &none);
            kept.forget();
            kept.update(&ContactInput::new(&blocks, &position, &velocity, 1e-4), &none);
            let bytes = kept.heap_bytes() as f64 / count as f64;
            println!("{count} blocks, {:.1} pairs and {bytes:.0} B each", kept.pairs() as f64 / count as f64);
            group.bench_function(BenchmarkId::new("keep the list", count), |b| {
                b.iter(|| kept.update(&ContactInput::new(&blocks, &position, &velocity, 1e-4), &none))
            });
            let middle = blocks.nodes_of(BlockId((count / 2 + n / 2 * (n + 1)) as u32));
            let top = blocks.nodes_of(BlockId(count as u32 - 1));
            for (name, nodes, way) in [("one block shakes", middle, 0.031), ("one block flies", top, 10.0)] {
                let home = position.clone();
                position[nodes.clone()].iter_mut().for_each(|x| x.z += 3.0 * way);
                kept.update(&ContactInput::new(&blocks, &position, &velocity, 1e-4), &none);
                let mut sign = 1.0;
                group.bench_function(BenchmarkId::new(name, count), |b| {
                    b.iter(|| {
                        sign = -sign;
                        position[nodes.clone()].iter_mut().for_each(|x| x.z += sign * way);
                        kept.update(&ContactInput::new(&blocks, &position, &velocity, 1e-4), &none)
                    })
                });
                position = home;
            }
            group.bench_function(BenchmarkId::new("make the list", count), |b| {
                b.iter(|| {
                    kept.forget();
                    kept.update(&ContactInput::new(&blocks, &position, &velocity, 1e-4), &none)
                })
            });
        }
        group.finish();
    }
}

fn contact_stage(c: &mut Criterion) {
    let mut group = c.benchmark_group("contact stage");
    group.sample_size(10);
    for &n in sizes() {
        let blocks = pile(n, BoxPattern::Six);
        let nodes = blocks.rest_position.len();
        let velocity = vec![Vec3::zeros(); nodes];
        let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, 1e-4);
        let mut model = PotentialContact::new(1e9);
        let (mut force, mut stiffness) = (vec![Vec3::zeros(); nodes], vec![0.0; nodes]);
        group.bench_function(BenchmarkId::from_parameter(n * n * n), |b| {
            b.iter(|| {
                let mut output =
                    ContactOutput { force: &mut force, friction_force: &mut [], stiffness: &mut stiffness };
                model.add_forces(&input, &mut ContactHistory::default(), &mut output).expect("sound blocks")
            })
        });
    }
    group.finish();
}

/// n³ boxes of blocks in a pile: about 26 neighbours each; with `mixed`, sizes from 1 to 1000 at random places instead,
/// as many of each decade.
fn boxes(n: usize, mixed: bool) -> Vec<Aabb> {
    let mut random = Random(1);
    let mut random = move || random.unit();
    let one = |k: usize| {
        let cell = Vec3::new((k % n) as f64, (k / n % n) as f64, (k / (n * n)) as f64);
        let size = if mixed { 10f64.powf(0.5 - 3.0 * random()) } else { 1.0 };
        let jitter = if mixed { n as f64 } else { 0.02 };
        let corner = if mixed { Vec3::zeros() } else { cell };
        let corner = corner + jitter * Vec3::new(random(), random(), random());
        Aabb { min: corner, max: corner.add_scalar(size) }.inflated(if mixed { 0.0 } else { 0.025 })
    };
    (0..n * n * n).map(one).collect()
}

fn block_level(c: &mut Criterion) {
    for mixed in [false, true] {
        let mut group = c.benchmark_group(if mixed { "mixed boxes" } else { "boxes" });
        group.sample_size(10);
        for &n in sizes() {
            let boxes = boxes(n, mixed);
            let (mut pairs, mut expected) = (Vec::new(), Vec::new());
            Tree::default().find(&boxes, &mut expected);
            expected.sort_unstable();
            println!(
                "{} boxes, {:.1} neighbours",
                boxes.len(),
                2.0 * expected.len() as f64 / boxes.len() as f64
            );
            let methods: [(&str, Box<dyn BoxPairs>); 3] = [
                ("sort and sweep", Box::new(Sweep::default())),
                ("uniform grid", Box::new(Grid::default())),
                ("tree", Box::new(Tree::default())),
            ];
            for (name, mut method) in methods {
                method.find(&boxes, &mut pairs);
                pairs.sort_unstable();
                assert!(pairs == expected, "{name} finds other pairs");
                group.bench_function(BenchmarkId::new(name, boxes.len()), |b| {
                    b.iter(|| method.find(&boxes, &mut pairs))
                });
            }
            let mut tree = Tree::default();
            tree.find(&boxes, &mut pairs);
            let (middle, mut there) = (boxes.len() / 2 + n / 2 * (n + 1), false);
            group.bench_function(BenchmarkId::new("tree, one box moved", boxes.len()), |b| {
                b.iter(|| {
                    there = !there;
                    let bounds = &boxes[middle];
                    tree.renew_one(middle, &if there { bounds.inflated(0.1) } else { *bounds })
                })
            });
        }
        group.finish();
    }
}

criterion_group!(benches, block_level, update, contact_stage);
criterion_main!(benches);
