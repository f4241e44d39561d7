//! A hundred thousand blocks from three joint sets, and Voronoi cells.
#![allow(missing_docs)] // criterion's macro makes public functions

use criterion::{Criterion, criterion_group, criterion_main};
use ndda_mesh::Vec3;
use ndda_mesh::cut::{
    CutOptions, Discontinuity, Domain, JointSet, OrientationScatter, VoronoiOptions, cut_blocks,
    random_seeds, voronoi_blocks,
};

/// Three oblique sets, about `per_side`³ blocks in a cube of 100 m.
fn sets(per_side: f64, orientation: OrientationScatter) -> Vec<Discontinuity> {
    let spacing_m = 100.0 / per_side;
    [("a", 75.0, 30.0), ("b", 65.0, 140.0), ("c", 15.0, 250.0)]
        .map(|(name, dip, direction)| {
            Discontinuity::Set(JointSet { orientation, ..JointSet::new(name, dip, direction, spacing_m) })
        })
        .to_vec()
}

fn cut(c: &mut Criterion) {
    let domain = Domain::cuboid(Vec3::zeros(), Vec3::repeat(100.0)).expect("a cube");
    let mut group = c.benchmark_group("cut");
    group.sample_size(10);
    for (name, per_side, orientation) in [
        ("10 000 blocks, parallel sets", 19.5, OrientationScatter::None),
        ("100 000 blocks, parallel sets", 44.0, OrientationScatter::None),
        ("100 000 blocks, Fisher 200", 44.0, OrientationScatter::Fisher { kappa: 200.0 }),
    ] {
        let sets = sets(per_side, orientation);
        let options = CutOptions { seed: 1, sliver_width_m: 0.01, ..CutOptions::default() };
        let blocks = cut_blocks(&domain, &sets, &options).expect("blocks");
        let report = &blocks.report;
        println!(
            "{name}: {} blocks, {} pairs, {} slivers, {} refused, volume off by {:.1e}",
            blocks.blocks.len(),
            blocks.neighbours.len(),
            report.slivers.len(),
            report.refused.len(),
            report.volume_m3 / report.domain_m3 - 1.0
        );
        group.bench_function(name, |b| b.iter(|| cut_blocks(&domain, &sets, &options).expect("blocks")));
    }
    group.finish();
}

fn voronoi(c: &mut Criterion) {
    let domain = Domain::cuboid(Vec3::zeros(), Vec3::repeat(100.0)).expect("a cube");
    let seeds = random_seeds(&domain, 10_000, 2.0, 1);
    let mut group = c.benchmark_group("voronoi");
    group.sample_size(10);
    group.bench_function("10 000 cells", |b| {
        b.iter(|| voronoi_blocks(&domain, &seeds, &VoronoiOptions::default()).expect("cells"))
    });
    group.finish();
}

criterion_group!(benches, cut, voronoi);
criterion_main!(benches);
