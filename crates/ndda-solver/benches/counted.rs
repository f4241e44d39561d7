//! Instructions of solves, and of steps without contact, counted by callgrind; `benches/track.py` keeps and compares them.
#![allow(missing_docs)] // the macros make public functions

mod cases;

use std::hint::black_box;

use cases::{cubes, load, matrix};
use gungraun::{Callgrind, LibraryBenchmarkConfig, library_benchmark, library_benchmark_group, main};
use ndda_solver::{
    BodyKind, Factor, GeneralizedAlpha, LinearSolver, Midpoint, Newmark, Simulation, Supernodal,
    SymmetricMatrix, TimeIntegrator,
};
use ndda_solver::{MULTI, Scratch};

/// A factor, and room for a solve.
struct Solve<T> {
    factor: Box<dyn Factor>,
    scratch: Scratch,
    x: Vec<T>,
}

impl<T> Solve<T> {
    /// For a cube of n³ cells, with what each unknown's load makes of it.
    fn new(n: u32, of_load: impl Fn(f64) -> T) -> Self {
        let factor = Supernodal.factor(&matrix(n)).expect("positive definite");
        let x = load(factor.unknowns()).into_iter().map(of_load).collect();
        Self { scratch: factor.new_multi_scratch(), factor, x }
    }
}

fn of_one(n: u32) -> Solve<f64> {
    Solve::new(n, |load| load)
}

fn of_eight(n: u32) -> Solve<[f64; MULTI]> {
    Solve::new(n, |load| [load; MULTI])
}

#[library_benchmark]
#[bench::unknowns_375(args = (4), setup = of_one)]
#[bench::unknowns_3000(args = (9), setup = of_one)]
fn solve(mut case: Solve<f64>) -> f64 {
    let Solve { factor, scratch, x } = black_box(&mut case);
    factor.solve_in_place(x, scratch).expect("a solution");
    x[0]
}

#[library_benchmark]
#[bench::unknowns_375(args = (4), setup = of_eight)]
#[bench::unknowns_3000(args = (9), setup = of_eight)]
fn solve_multi(mut case: Solve<[f64; MULTI]>) -> f64 {
    let Solve { factor, scratch, x } = black_box(&mut case);
    factor.solve_multi_in_place(x, scratch).expect("a solution");
    x[0][0]
}

#[library_benchmark]
#[bench::unknowns_375(matrix(4))]
fn factor(matrix: SymmetricMatrix) -> Box<dyn Factor> {
    Supernodal.factor(black_box(&matrix)).expect("positive definite")
}

/// Eight cubes of 384 tetrahedra, everything on the thread that is counted.
fn eight(kind: BodyKind, integrator: Box<dyn TimeIntegrator>) -> Simulation {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    pool.build_global().expect("no pool before");
    let mut simulation = cubes(8, 4, kind, integrator);
    simulation.step().expect("a step");
    simulation
}

fn midpoint() -> Box<dyn TimeIntegrator> {
    Box::new(Midpoint { theta: 0.5 })
}

#[library_benchmark]
#[bench::midpoint(eight(BodyKind::Elastic, midpoint()))]
#[bench::newmark(eight(BodyKind::Elastic, Box::new(Newmark { alpha: 0.25, delta: 0.5 })))]
#[bench::generalized_alpha(eight(BodyKind::Elastic, Box::new(GeneralizedAlpha { radius: 0.8 })))]
#[bench::affine(eight(BodyKind::Affine, midpoint()))]
#[bench::rigid(eight(BodyKind::Rigid, midpoint()))]
fn step(mut simulation: Simulation) -> Simulation {
    black_box(&mut simulation).step().expect("a step");
    simulation
}

library_benchmark_group!(name = blocks, benchmarks = [solve, solve_multi, factor, step]);

main!(
    config = LibraryBenchmarkConfig::default().tool(Callgrind::with_args(["--cache-sim=no"])),
    library_benchmark_groups = blocks
);
