//! Instructions, counted by callgrind: clocks are noisy, these are not. `benches/track.py` keeps and compares them.
#![allow(missing_docs)] // the macros make public functions

mod cases;

use std::hint::black_box;

use cases::{Evaluation, Hits, Rejects, random_pairs};
use gungraun::{Callgrind, LibraryBenchmarkConfig, library_benchmark, library_benchmark_group, main};
use ndda_contact::reference::tet_pair::NodalForces;
use ndda_mesh::Vec3;

/// Everything on the thread that is counted.
fn alone<T>(case: T) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    pool.build_global().expect("no pool before");
    case
}

fn evaluation((potential, friction): (&str, &str)) -> Evaluation {
    alone(());
    Evaluation::new(4, potential, friction)
}

#[library_benchmark]
#[bench::rejects(Rejects::new())]
fn pair(case: Rejects) -> usize {
    black_box(&case).look()
}

#[library_benchmark]
#[bench::deep(Hits::deep())]
#[bench::shallow(Hits::shallow())]
fn kernel(mut case: Hits) -> f64 {
    black_box(&mut case).integrate()
}

#[library_benchmark]
#[bench::forces(random_pairs())]
fn tet_pair(pairs: Vec<[[Vec3; 4]; 2]>) -> Vec<[[Vec3; 4]; 2]> {
    let mut forces = vec![[[Vec3::zeros(); 4]; 2]; pairs.len()];
    NodalForces::default().of(black_box(&pairs), 1.0, &mut forces);
    forces
}

#[library_benchmark]
#[bench::element(args = (("element", "none")), setup = evaluation)]
#[bench::smooth(args = (("smooth", "none")), setup = evaluation)]
#[bench::whole(args = (("whole", "none")), setup = evaluation)]
#[bench::volume(args = (("volume", "none")), setup = evaluation)]
#[bench::coulomb(args = (("element", "spring")), setup = evaluation)]
fn step(mut case: Evaluation) -> usize {
    black_box(&mut case).step().contact_pairs
}

#[library_benchmark]
#[bench::element(args = (("element", "none")), setup = evaluation)]
fn no_friction_code(mut case: Evaluation) -> usize {
    black_box(&mut case).frictionless_step().contact_pairs
}

#[library_benchmark]
#[bench::element(args = (("element", "none")), setup = evaluation)]
fn energy(mut case: Evaluation) -> f64 {
    black_box(&mut case).energy()
}

library_benchmark_group!(
    name = contact,
    benchmarks = [pair, kernel, tet_pair, step, no_friction_code, energy]
);

main!(
    config = LibraryBenchmarkConfig::default().tool(Callgrind::with_args(["--cache-sim=no"])),
    library_benchmark_groups = contact
);
