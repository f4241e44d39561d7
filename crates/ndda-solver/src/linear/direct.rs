//! The default: dense where that is quicker, sparse beyond.

use crate::linear::dense_inverse::DenseInverse;
use crate::linear::linear_solver::{Factor, FactorError, LinearSolver, SymmetricMatrix};
use crate::linear::supernodal::Supernodal;

/// Unknowns up to which an inverse is quicker than a factor (`benches/peers/cholmod.sh`: 0.05 µs against
/// 0.14 µs at 24 unknowns, 3.0 µs against 2.0 µs at 192).
const MOST_DENSE: usize = 100;

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
