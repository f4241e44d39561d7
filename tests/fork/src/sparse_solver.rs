//! faer's sparse Cholesky factorization as the solver of blocks.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, MatMut, Par, Side, Spec};
use ndda_solver::{Factor, FactorError, LinearSolver, Scratch, SolveError, SymmetricMatrix};

/// P A Pᵀ = L Lᵀ with faer's ordering.
#[derive(Clone, Copy, Debug)]
pub struct SparseLlt;

/// The factor of one matrix.
struct Llt {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
}

impl LinearSolver for SparseLlt {
    fn factor(&self, matrix: &SymmetricMatrix) -> Result<Box<dyn Factor>, FactorError> {
        let (unknowns, par) = (matrix.n, Par::Seq);
        let entries = (0..unknowns).flat_map(|column| {
            let range = matrix.column_start[column]..matrix.column_start[column + 1];
            range.map(move |k| Triplet::new(matrix.row[k], column, matrix.value[k]))
        });
        let entries: Vec<_> = entries.collect();
        let too_large = |_| FactorError::OutOfMemory { unknowns };
        let lower = SparseColMat::<usize, f64>::try_new_from_triplets(unknowns, unknowns, &entries)
            .map_err(|_| FactorError::OutOfMemory { unknowns })?;
        let (side, order) = (Side::Lower, SymmetricOrdering::Amd);
        let symbolic = factorize_symbolic_cholesky(lower.symbolic(), side, order, Default::default())
            .map_err(too_large)?;
        let mut values = vec![0.0; symbolic.len_val()];
        let need = symbolic.factorize_numeric_llt_scratch::<f64>(par, Spec::default());
        let mut memory = MemBuffer::new(need);
        let llt = symbolic.factorize_numeric_llt(
            &mut values,
            lower.as_ref(),
            side,
            LltRegularization::default(),
            par,
            MemStack::new(&mut memory),
            Spec::default(),
        );
        let is_definite = llt.is_ok();
        if !is_definite {
            return Err(FactorError::NotPositiveDefinite { unknowns });
        }
        Ok(Box::new(Llt { symbolic, values }))
    }
}

impl Factor for Llt {
    fn name(&self) -> &'static str {
        "sparse LLᵀ of faer"
    }

    fn unknowns(&self) -> usize {
        self.symbolic.nrows()
    }

    fn new_scratch(&self) -> Scratch {
        Scratch::of(MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq)))
    }

    fn solve_in_place(&self, rhs: &mut [f64], scratch: &mut Scratch) -> Result<(), SolveError> {
        let memory = scratch.own::<MemBuffer>().expect("scratch of this factor");
        let column = MatMut::from_column_major_slice_mut(rhs, self.unknowns(), 1);
        let factor = LltRef::new(&self.symbolic, &self.values);
        factor.solve_in_place_with_conj(Conj::No, column, Par::Seq, MemStack::new(memory));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_solver::testing::{check_linear_solver, check_solves_allocate_nothing};
    use std::alloc::{GlobalAlloc, Layout, System};
    use std::cell::Cell;

    struct Counting;

    thread_local! {
        static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
    }

    // SAFETY: everything is passed on to the system's allocator.
    unsafe impl GlobalAlloc for Counting {
        unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
            let _ = ALLOCATIONS.try_with(|count| count.set(count.get() + 1));
            unsafe { System.alloc(layout) }
        }

        unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
            unsafe { System.dealloc(place, layout) }
        }
    }

    #[global_allocator]
    static COUNTING: Counting = Counting;

    fn allocations() -> usize {
        ALLOCATIONS.with(Cell::get)
    }

    #[test]
    fn it_keeps_the_contract_of_a_linear_solver_and_allocates_nothing_in_a_solve() {
        check_linear_solver(&SparseLlt);
        check_solves_allocate_nothing(&SparseLlt, &allocations);
    }

    /// Memory is made anew in each solve.
    #[test]
    #[should_panic(expected = "allocations")]
    fn a_solver_that_allocates_in_a_solve_is_found_out() {
        struct Wasteful;
        struct WastefulFactor(Box<dyn Factor>);
        impl LinearSolver for Wasteful {
            fn factor(&self, matrix: &SymmetricMatrix) -> Result<Box<dyn Factor>, FactorError> {
                Ok(Box::new(WastefulFactor(SparseLlt.factor(matrix)?)))
            }
        }
        impl Factor for WastefulFactor {
            fn name(&self) -> &'static str {
                "wasteful"
            }

            fn unknowns(&self) -> usize {
                self.0.unknowns()
            }

            fn new_scratch(&self) -> Scratch {
                Scratch::default()
            }

            fn solve_in_place(&self, rhs: &mut [f64], _: &mut Scratch) -> Result<(), SolveError> {
                self.0.solve_in_place(rhs, &mut self.0.new_scratch())
            }
        }
        check_solves_allocate_nothing(&Wasteful, &allocations);
    }
}
