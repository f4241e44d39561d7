//! One block's equations, factored and solved: dense, sparse and iterated, by size.
#![allow(missing_docs)] // criterion's macro makes public functions

use criterion::{Criterion, criterion_group, criterion_main};
use ndda_fem::{BlockOperator, BlockSupports, LinearElastic};
use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_solver::unknowns::Unknowns;
use ndda_solver::{
    ConjugateGradients, DenseInverse, LinearSolver, Midpoint, SparseCholesky, StepDamping, SymmetricMatrix,
    TimeIntegrator,
};

/// K̃ of a cube of n³ cells in a step of 0.1 ms.
fn matrix(n: u32) -> SymmetricMatrix {
    let mesh = box_block([1.0; 3], [n; 3], BoxPattern::Six).expect("a cube");
    let rock = LinearElastic::new(20e9, 0.25, 2650.0).expect("rock");
    let operator = BlockOperator::new(&mesh.nodes, mesh.tets, &rock);
    let supports = BlockSupports::new(&operator, &[]).expect("no supports");
    let weights = Midpoint { theta: 0.5 }.weights(1e-4);
    Unknowns::nodal(operator.nodes(), &supports).matrix(
        &operator,
        &supports,
        &weights,
        &StepDamping::default(),
    )
}

fn solve(c: &mut Criterion) {
    for n in [1, 2, 3, 4, 9] {
        let matrix = matrix(n);
        let mut solvers: Vec<(&str, Box<dyn LinearSolver>)> = vec![
            ("sparse", Box::new(SparseCholesky)),
            ("conjugate gradients", Box::new(ConjugateGradients { tolerance: 1e-12 })),
        ];
        if matrix.n < 1000 {
            solvers.insert(0, ("dense", Box::new(DenseInverse)));
        }
        for (name, solver) in solvers {
            let factor = solver.factor(&matrix).expect("positive definite");
            let mut scratch = factor.new_scratch();
            let load: Vec<f64> = (0..matrix.n).map(|i| (i as f64).sin()).collect();
            let mut x = load.clone();
            c.bench_function(&format!("{} unknowns/{name}", matrix.n), |b| {
                b.iter(|| {
                    x.copy_from_slice(&load);
                    factor.solve_in_place(&mut x, &mut scratch).expect("a solution");
                })
            });
        }
    }
}

criterion_group!(benches, solve);
criterion_main!(benches);
