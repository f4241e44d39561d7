//! The default: dense where that is quicker, sparse beyond.

use crate::dense_inverse::DenseInverse;
use crate::linear_solver::{Factor, FactorError, LinearSolver, SymmetricMatrix};
use crate::supernodal::Supernodal;

/// Unknowns up to which an inverse is quicker than a factor (`NDDA_PEER=/tmp cargo bench`: TODO)
/// 0.60 µs at 24 unknowns, 6 µs against 12 µs at 192, 28 µs against 34 µs at 375) and still fits the second-level cache.
const MOST_DENSE: usize = 200;

/// [`DenseInverse`] for small blocks, [`Supernodal`] for others.
#[derive(Clone, Copy, Debug, Default)]
pub struct Direct;

impl LinearSolver for Direct {
    fn factor(&self, matrix: &SymmetricMatrix) -> Result<Box<dyn Factor>, FactorError> {
        if matrix.n <= MOST_DENSE { DenseInverse.factor(matrix) } else { Supernodal.factor(matrix) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::check_linear_solver;

    #[test]
    fn it_keeps_the_contract_of_a_linear_solver() {
        check_linear_solver(&Direct);
    }
}
