//! Instructions of the work on one block of 384 tetrahedra, counted by callgrind; `benches/track.py` keeps and compares them.
#![allow(missing_docs)] // the macros make public functions

mod cases;

use std::hint::black_box;

use cases::{Deformed, assemble, cube, element};
use gungraun::{Callgrind, LibraryBenchmarkConfig, library_benchmark, library_benchmark_group, main};
use ndda_fem::{BlockOperator, BlockSupports};
use ndda_mesh::{BlockMesh, Mat3, Vec3};

#[library_benchmark]
#[bench::one([Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()])]
fn tet4(corners: [Vec3; 4]) -> (Mat3, f64) {
    element(black_box(&corners))
}

#[library_benchmark]
#[bench::assembly(cube(4))]
fn operator(mesh: BlockMesh) -> BlockOperator {
    assemble(black_box(&mesh))
}

#[library_benchmark]
#[bench::recovery(Deformed::new(4))]
fn stress(mut block: Deformed) -> f64 {
    black_box(&mut block).stresses()
}

#[library_benchmark]
#[bench::rotation(Deformed::new(4))]
fn frame(block: Deformed) -> Mat3 {
    black_box(&block).rotation()
}

#[library_benchmark]
#[bench::product(Deformed::new(4))]
fn stiffness(mut block: Deformed) -> Vec3 {
    black_box(&mut block).stiffness_times()
}

#[library_benchmark]
#[bench::books(Deformed::new(4))]
fn motion(block: Deformed) -> f64 {
    black_box(&block).motion()
}

#[library_benchmark]
#[bench::all(Deformed::new(4))]
fn loads(mut block: Deformed) -> Vec3 {
    black_box(&mut block).loads()
}

#[library_benchmark]
#[bench::foot(Deformed::new(4))]
fn supports(block: Deformed) -> BlockSupports {
    black_box(&block).supports()
}

library_benchmark_group!(
    name = block,
    benchmarks = [tet4, operator, stress, frame, stiffness, motion, loads, supports]
);

main!(
    config = LibraryBenchmarkConfig::default().tool(Callgrind::with_args(["--cache-sim=no"])),
    library_benchmark_groups = block
);
