//! Small blocks: the inverse, once, and a product with it in every step.

use nalgebra::DMatrix;
use pulp::Arch;

use crate::linear_solver::{Factor, FactorError, LinearSolver, Scratch, SolveError, SymmetricMatrix};

/// Columns of a product taken together, so that the sums are loaded a quarter as often.
const TOGETHER: usize = 4;

/// Inverts by Cholesky. A product has no order in it that a substitution would have: for a few unknowns it is several
/// times as quick, for many the inverse is too large.
#[derive(Clone, Copy, Debug, Default)]
pub struct DenseInverse;

/// A⁻¹, column by column.
struct Inverse {
    columns: Vec<f64>,
    n: usize,
    arch: Arch,
}

impl LinearSolver for DenseInverse {
    fn factor(&self, matrix: &SymmetricMatrix) -> Result<Box<dyn Factor>, FactorError> {
        let n = matrix.n;
        let mut dense = DMatrix::zeros(n, n);
        for j in 0..n {
            for k in matrix.column_start[j]..matrix.column_start[j + 1] {
                (dense[(matrix.row[k], j)], dense[(j, matrix.row[k])]) = (matrix.value[k], matrix.value[k]);
            }
        }
        // D⁻½ A D⁻½ has a diagonal of ones: K̃ of a slender block is badly scaled, its inverse need not be.
        let scale: Vec<f64> = (0..n).map(|i| 1.0 / dense[(i, i)].sqrt()).collect();
        if !scale.iter().all(|s| s.is_finite()) {
            return Err(FactorError::NotPositiveDefinite { unknowns: n });
        }
        let scaled = DMatrix::from_fn(n, n, |i, j| dense[(i, j)] * scale[i] * scale[j]);
        let factor = scaled.cholesky().ok_or(FactorError::NotPositiveDefinite { unknowns: n })?;
        let inverse = factor.inverse();
        let entry = |i: usize, j: usize| 0.5 * (inverse[(i, j)] + inverse[(j, i)]) * scale[i] * scale[j];
        let columns = (0..n * n).map(|k| entry(k % n, k / n)).collect();
        Ok(Box::new(Inverse { columns, n, arch: Arch::new() }))
    }
}

impl Factor for Inverse {
    fn unknowns(&self) -> usize {
        self.n
    }

    fn new_scratch(&self) -> Scratch {
        Scratch { numbers: vec![0.0; self.n], ..Scratch::default() }
    }

    fn solve_in_place(&self, rhs: &mut [f64], scratch: &mut Scratch) -> Result<(), SolveError> {
        let product = &mut scratch.numbers;
        self.arch.dispatch(|| times(&self.columns, rhs, product));
        rhs.copy_from_slice(product);
        Ok(())
    }
}

/// out ← Σ_j column_j x_j, each sum in the order of columns whatever the processor.
#[inline(always)]
fn times(columns: &[f64], x: &[f64], out: &mut [f64]) {
    let n = out.len();
    out.fill(0.0);
    let (mut columns, mut x) = (columns.chunks_exact(TOGETHER * n), x.chunks_exact(TOGETHER));
    for (block, x) in (&mut columns).zip(&mut x) {
        let (a, rest) = block.split_at(n);
        let (b, rest) = rest.split_at(n);
        let (c, d) = rest.split_at(n);
        for i in 0..n {
            out[i] = out[i] + a[i] * x[0] + b[i] * x[1] + c[i] * x[2] + d[i] * x[3];
        }
    }
    for (column, x) in columns.remainder().chunks_exact(n).zip(x.remainder()) {
        for i in 0..n {
            out[i] += column[i] * x;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::check_linear_solver;

    #[test]
    fn it_keeps_the_contract_of_a_linear_solver() {
        check_linear_solver(&DenseInverse);
    }
}
