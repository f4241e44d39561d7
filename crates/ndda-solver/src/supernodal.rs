//! Sparse L Lᵀ by supernodes, laid out for the solves: a block is factored once and solved in every step.

mod dissection;
mod graph;
mod numeric;
mod panels;
mod separator;
mod symbolic;

use pulp::{Arch, Simd, WithSimd};

use crate::linear_solver::{
    EIGHT, Eight, Factor, FactorError, LinearSolver, Scratch, SolveError, SymmetricMatrix,
};
use graph::Compressed;
use panels::Panels;
use symbolic::Symbolic;

/// The [`LinearSolver`] for blocks too large to invert: nested dissection, supernodes, panels that a solve reads once in
/// each sweep.
#[derive(Clone, Copy, Debug, Default)]
pub struct Supernodal;

/// The factor of one block.
#[derive(Clone, Debug)]
pub struct SupernodalFactor {
    /// Unknown of each row of the factor.
    unknown: Vec<u32>,
    panels: Panels,
    arch: Arch,
}

impl Supernodal {
    /// Factors `matrix`, as [`LinearSolver::factor`] does.
    ///
    /// # Errors
    /// [`FactorError`] when the matrix is not positive definite or too large.
    pub fn factor_panels(matrix: &SymmetricMatrix) -> Result<SupernodalFactor, FactorError> {
        let symbolic = Symbolic::new(&Compressed::new(matrix));
        let panels = numeric::factor(matrix, &symbolic)?;
        Ok(SupernodalFactor { unknown: symbolic.unknown, panels, arch: Arch::new() })
    }
}

impl LinearSolver for Supernodal {
    fn factor(&self, matrix: &SymmetricMatrix) -> Result<Box<dyn Factor>, FactorError> {
        Ok(Box::new(Self::factor_panels(matrix)?))
    }
}

impl SupernodalFactor {
    /// What each of the two sweeps of a solve reads of the factor [bytes].
    pub fn bytes(&self) -> usize {
        size_of_val(self.panels.tiles.as_slice()) + size_of_val(self.panels.row.as_slice())
    }

    /// Lines of scratch for eight right-hand sides: the unknowns, one for none, and a panel's rows.
    fn lines_of_eight(&self) -> usize {
        self.unknowns() + 1 + EIGHT * self.panels.most_height()
    }
}

/// A solve, compiled for each kind of processor.
struct One<'a> {
    panels: &'a Panels,
    x: &'a mut [f64],
    local: &'a mut [Eight],
}

impl WithSimd for One<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.panels.solve(simd, self.x, self.local);
    }
}

/// A solve for eight right-hand sides, compiled for each kind of processor.
struct AllEight<'a> {
    panels: &'a Panels,
    x: &'a mut [Eight],
    local: &'a mut [[Eight; EIGHT]],
}

impl WithSimd for AllEight<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.panels.solve_eight(simd, self.x, self.local);
    }
}

impl Factor for SupernodalFactor {
    fn unknowns(&self) -> usize {
        self.unknown.len()
    }

    fn new_scratch(&self) -> Scratch {
        let lines = vec![Eight::default(); self.panels.most_height()];
        Scratch { numbers: vec![0.0; self.unknowns() + 1], lines, ..Scratch::default() }
    }

    fn new_scratch_of_eight(&self) -> Scratch {
        Scratch { lines: vec![Eight::default(); self.lines_of_eight()], ..self.new_scratch() }
    }

    fn solve_in_place(&self, rhs: &mut [f64], scratch: &mut Scratch) -> Result<(), SolveError> {
        let x = &mut scratch.numbers;
        x.iter_mut().zip(&self.unknown).for_each(|(x, &u)| *x = rhs[u as usize]);
        self.arch.dispatch(One { panels: &self.panels, x, local: &mut scratch.lines });
        x.iter().zip(&self.unknown).for_each(|(x, &u)| rhs[u as usize] = *x);
        Ok(())
    }

    fn solve_eight_in_place(
        &self,
        rhs: &mut [[f64; EIGHT]],
        scratch: &mut Scratch,
    ) -> Result<(), SolveError> {
        if scratch.lines.len() < self.lines_of_eight() {
            scratch.lines.resize(self.lines_of_eight(), Eight::default());
        }
        let (x, local) = scratch.lines.split_at_mut(self.unknowns() + 1);
        x.iter_mut().zip(&self.unknown).for_each(|(x, &u)| x.0 = rhs[u as usize]);
        self.arch.dispatch(AllEight { panels: &self.panels, x, local: local.as_chunks_mut().0 });
        x.iter().zip(&self.unknown).for_each(|(x, &u)| rhs[u as usize] = x.0);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::check_linear_solver;

    #[test]
    fn it_keeps_the_contract_of_a_linear_solver() {
        check_linear_solver(&Supernodal);
    }
}
