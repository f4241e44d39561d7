//! One block's equations, solved: dense, sparse and iterated, by size, for one and for eight right-hand sides.
//!
//! With a directory in `NDDA_PEER`, instead writes the matrices there and prints for each: unknowns, bytes of the factor,
//! milliseconds to make it, microseconds of a solve, of one of eight at once, and of both with the inverse.

mod cases;

use std::io::Write;
use std::path::Path;
use std::time::Instant;

use cases::{load, matrix};
use criterion::{Criterion, criterion_group};
use ndda_solver::{ConjugateGradients, DenseInverse, Factor, LinearSolver, Supernodal, SymmetricMatrix};

/// Cells along the edge of the cubes: 24, 192, 375, 3000 and 24 000 unknowns.
const CELLS: [u32; 5] = [1, 3, 4, 9, 19];

fn solve(c: &mut Criterion) {
    for matrix in CELLS.map(matrix) {
        let mut solvers: Vec<(&str, Box<dyn LinearSolver>)> = vec![
            ("sparse", Box::new(Supernodal)),
            ("conjugate gradients", Box::new(ConjugateGradients { tolerance: 1e-12 })),
        ];
        if matrix.n < 1000 {
            solvers.insert(0, ("dense", Box::new(DenseInverse)));
        }
        for (name, solver) in solvers {
            let factor = solver.factor(&matrix).expect("positive definite");
            let mut scratch = factor.new_multi_scratch();
            let load = load(matrix.n);
            let mut x = load.clone();
            c.bench_function(&format!("{} unknowns/{name}", matrix.n), |b| {
                b.iter(|| {
                    x.copy_from_slice(&load);
                    factor.solve_in_place(&mut x, &mut scratch).expect("a solution");
                })
            });
            if name == "conjugate gradients" {
                continue;
            }
            let load: Vec<[f64; 8]> = load.iter().map(|&b| [b; 8]).collect();
            let mut x = load.clone();
            c.bench_function(&format!("{} unknowns/{name}, eight at once", matrix.n), |b| {
                b.iter(|| {
                    x.copy_from_slice(&load);
                    factor.solve_multi_in_place(&mut x, &mut scratch).expect("a solution");
                })
            });
        }
    }
}

/// Least time that `run` takes [µs], over about 0.3 s.
fn least_us(mut run: impl FnMut()) -> f64 {
    let (begin, mut least) = (Instant::now(), f64::INFINITY);
    while begin.elapsed().as_secs_f64() < 0.3 {
        let start = Instant::now();
        run();
        least = least.min(start.elapsed().as_secs_f64());
    }
    1e6 * least
}

/// Times of one solve and of eight at once, per block [µs].
fn times(factor: &dyn Factor) -> [f64; 2] {
    let mut scratch = factor.new_multi_scratch();
    let load = load(factor.unknowns());
    let mut x = load.clone();
    let one = least_us(|| {
        x.copy_from_slice(&load);
        factor.solve_in_place(&mut x, &mut scratch).expect("a solution");
    });
    let load: Vec<[f64; 8]> = load.iter().map(|&b| [b; 8]).collect();
    let mut x = load.clone();
    let eight = least_us(|| {
        x.copy_from_slice(&load);
        factor.solve_multi_in_place(&mut x, &mut scratch).expect("a solution");
    });
    [one, eight / 8.0]
}

/// Size, number of entries, column starts, rows [each i64] and values.
fn write(matrix: &SymmetricMatrix, path: &Path) -> std::io::Result<()> {
    let mut file = std::io::BufWriter::new(std::fs::File::create(path)?);
    let sizes = [matrix.n, matrix.row.len()];
    for number in sizes.iter().chain(&matrix.column_start).chain(&matrix.row) {
        file.write_all(&(*number as i64).to_le_bytes())?;
    }
    for value in &matrix.value {
        file.write_all(&value.to_le_bytes())?;
    }
    file.flush()
}

fn peer(directory: &Path) {
    let listed = |list: String| list.split(',').map(|n| n.parse().expect("cells along an edge")).collect();
    let cells: Vec<u32> = std::env::var("NDDA_PEER_CELLS").map_or(CELLS.to_vec(), listed);
    for matrix in cells.into_iter().map(matrix) {
        let path = directory.join(format!("{}.matrix", matrix.n));
        write(&matrix, &path).expect("the directory can be written to");
        let start = Instant::now();
        let factor = Supernodal::factor_panels(&matrix).expect("positive definite");
        let factor_ms = 1e3 * start.elapsed().as_secs_f64();
        let [one, eight] = times(&factor);
        // An inverse of more would only take long to make.
        let dense = if matrix.n > 400 { [f64::NAN; 2] } else { inverse_times(&matrix) };
        println!(
            "{} {} {factor_ms:.1} {one:.3} {eight:.3} {:.3} {:.3}",
            matrix.n,
            factor.bytes(),
            dense[0],
            dense[1]
        );
    }
}

fn inverse_times(matrix: &SymmetricMatrix) -> [f64; 2] {
    times(DenseInverse.factor(matrix).expect("positive definite").as_ref())
}

criterion_group!(benches, solve);

fn main() {
    match std::env::var_os("NDDA_PEER") {
        Some(directory) => peer(Path::new(&directory)),
        None => {
            benches();
            Criterion::default().configure_from_args().final_summary();
        }
    }
}
