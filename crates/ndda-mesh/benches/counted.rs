//! Instructions of cutting, filling and checking, counted by callgrind; `benches/track.py` keeps and compares them.
#![allow(missing_docs)] // the macros make public functions

mod cases;

use std::hint::black_box;

use cases::{by_joints, by_seeds, cube, domain, filled, row, sets};
use gungraun::{Callgrind, LibraryBenchmarkConfig, library_benchmark, library_benchmark_group, main};
use ndda_mesh::cut::{Blocks, CutOptions, Discontinuity, OrientationScatter, cut_blocks};
use ndda_mesh::quality::{QualityReport, quality};
use ndda_mesh::tetrahedralise::Fill;
use ndda_mesh::{BlockMesh, BlockSet};

#[library_benchmark]
#[bench::parallel(sets(7.0, OrientationScatter::None))]
#[bench::scattered(sets(7.0, cases::SCATTERED))]
fn cut(sets: Vec<Discontinuity>) -> Blocks {
    cut_blocks(&domain(), black_box(&sets), &CutOptions::default()).expect("blocks")
}

#[library_benchmark]
#[bench::cells(300)]
fn voronoi(cells: usize) -> Blocks {
    by_seeds(black_box(cells))
}

fn joints_and(fill: Fill) -> (Blocks, Fill) {
    (by_joints(7.0), fill)
}

/// A given size takes ten times as long as the other fills: fewer blocks.
fn few_joints_and(fill: Fill) -> (Blocks, Fill) {
    (by_joints(3.0), fill)
}

#[library_benchmark]
#[bench::fewest(args = (Fill::Fewest), setup = joints_and)]
#[bench::centre(args = (Fill::Centre), setup = joints_and)]
#[bench::size_of_few(args = (Fill::Size { size_m: 70.0, finer: Vec::new() }), setup = few_joints_and)]
fn fill((blocks, fill): (Blocks, Fill)) -> Vec<BlockMesh> {
    filled(black_box(&blocks), &fill)
}

#[library_benchmark]
#[bench::set(row(100, 2))]
fn blocks(meshes: Vec<(String, BlockMesh)>) -> BlockSet {
    BlockSet::new(black_box(meshes)).expect("cubes")
}

#[library_benchmark]
#[bench::quality(cube(8))]
fn mesh(mesh: BlockMesh) -> QualityReport {
    quality([("cube", black_box(&mesh))])
}

library_benchmark_group!(name = meshes, benchmarks = [cut, voronoi, fill, blocks, mesh]);

main!(
    config = LibraryBenchmarkConfig::default().tool(Callgrind::with_args(["--cache-sim=no"])),
    library_benchmark_groups = meshes
);
