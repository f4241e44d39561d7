//! A hundred thousand blocks from three joint sets, Voronoi cells, and tetrahedra in blocks.
#![allow(missing_docs)] // criterion's macro makes public functions

mod cases;

use cases::{SCATTERED, by_joints, by_seeds, domain, filled, sets};
use criterion::{Criterion, criterion_group, criterion_main};
use ndda_mesh::cut::{
    CutOptions, OrientationScatter, VoronoiOptions, cut_blocks, random_seeds, voronoi_blocks,
};
use ndda_mesh::quality::quality;
use ndda_mesh::tetrahedralise::Fill;

fn cut(c: &mut Criterion) {
    let domain = domain();
    let mut group = c.benchmark_group("cut");
    group.sample_size(10);
    for (name, per_side, orientation) in [
        ("10 000 blocks, parallel sets", 19.5, OrientationScatter::None),
        ("100 000 blocks, parallel sets", 44.0, OrientationScatter::None),
        ("100 000 blocks, Fisher 200", 44.0, SCATTERED),
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
    let domain = domain();
    let mut group = c.benchmark_group("voronoi");
    group.sample_size(10);
    for (name, cells, apart_m) in [("10 000 cells", 10_000, 2.0), ("100 000 cells", 100_000, 1.0)] {
        let seeds = random_seeds(&domain, cells, apart_m, 1);
        let cut = || voronoi_blocks(&domain, &seeds, &VoronoiOptions::default()).expect("cells");
        let report = cut().report;
        println!("{name}: volume off by {:.1e}", report.volume_m3 / report.domain_m3 - 1.0);
        group.bench_function(name, |b| b.iter(cut));
    }
    group.finish();
}

/// Prints how many tetrahedra a fill gives a block and how good they are.
fn fill(c: &mut Criterion) {
    let mut group = c.benchmark_group("fill");
    group.sample_size(10);
    for (system, blocks) in [("joints", by_joints(7.0)), ("Voronoi", by_seeds(400))] {
        for (name, fill) in [
            ("fewest", Fill::Fewest),
            ("centre", Fill::Centre),
            ("8 m", Fill::Size { size_m: 8.0, finer: Vec::new() }),
        ] {
            let meshes = filled(&blocks, &fill);
            let report = quality(meshes.iter().map(|mesh| ("", mesh)));
            println!(
                "{system}, {name}: {} of {} blocks filled; {report}",
                meshes.len(),
                blocks.groups().len()
            );
            group.bench_function(format!("{} blocks of {system}, {name}", meshes.len()), |b| {
                b.iter(|| filled(&blocks, &fill))
            });
        }
    }
    group.finish();
}

criterion_group!(benches, cut, voronoi, fill);
criterion_main!(benches);
