//! Sparse LLᵀ by faer: AMD ordering, simplicial or supernodal as faer finds best.

use std::mem::MaybeUninit;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};

use crate::linear_solver::{Factor, FactorError, LinearSolver, Scratch, SolveError, SymmetricMatrix};

/// The [`LinearSolver`] for blocks too large to invert.
#[derive(Clone, Copy, Debug, Default)]
pub struct SparseCholesky;

/// L of one block, with the pattern that explains it.
struct SparseFactor {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
}

impl LinearSolver for SparseCholesky {
    fn factor(&self, matrix: &SymmetricMatrix) -> Result<Box<dyn Factor>, FactorError> {
        let unknowns = matrix.n;
        let out_of_memory = |_| FactorError::OutOfMemory { unknowns };
        let pattern =
            SymbolicSparseColMatRef::new_checked(unknowns, unknowns, &matrix.column_start, None, &matrix.row);
        let ordering = SymmetricOrdering::Amd;
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Lower, ordering, Default::default())
            .map_err(out_of_memory)?;
        let mut values = vec![0.0; symbolic.len_val()];
        let need = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
        let mut memory = MemBuffer::try_new(need).map_err(|_| FactorError::OutOfMemory { unknowns })?;
        let outcome = symbolic.factorize_numeric_llt(
            &mut values,
            SparseColMatRef::new(pattern, &matrix.value),
            Side::Lower,
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Spec::default(),
        );
        if outcome.is_err() {
            return Err(FactorError::NotPositiveDefinite { unknowns });
        }
        Ok(Box::new(SparseFactor { symbolic, values }))
    }
}

impl Factor for SparseFactor {
    fn unknowns(&self) -> usize {
        self.symbolic.nrows()
    }

    fn new_scratch(&self) -> Scratch {
        let need = self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        let bytes = vec![MaybeUninit::uninit(); need.unaligned_bytes_required()];
        Scratch { bytes, ..Scratch::default() }
    }

    fn solve_in_place(&self, rhs: &mut [f64], scratch: &mut Scratch) -> Result<(), SolveError> {
        let n = rhs.len();
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(rhs, n, 1),
            Par::Seq,
            MemStack::new(&mut scratch.bytes),
        );
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::check_linear_solver;

    #[test]
    fn it_keeps_the_contract_of_a_linear_solver() {
        check_linear_solver(&SparseCholesky);
    }
}
