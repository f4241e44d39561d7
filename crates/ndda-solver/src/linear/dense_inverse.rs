//! Small blocks: the inverse, once, and a product with it in every step.

use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

use crate::linear::linear_solver::{
    Eight, Factor, FactorError, LinearSolver, MULTI, Scratch, SolveError, SymmetricMatrix,
};

/// Eights of rows taken together, so that sums need not wait for each other.
const TOGETHER: usize = 4;

/// Inverts by Cholesky. A product has no order in it that a substitution would have: for a few unknowns it is several
/// times as quick, for many the inverse is too large.
#[derive(Clone, Copy, Debug, Default)]
pub struct DenseInverse;

/// A⁻¹ by eights of rows, each column by column; zeros fill up the last.
struct Inverse {
    tiles: Vec<Eight>,
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
        let tile = |k: usize| {
            let (first, j) = (MULTI * (k / n), k % n);
            Eight(std::array::from_fn(|r| if first + r < n { entry(first + r, j) } else { 0.0 }))
        };
        let tiles = (0..n.div_ceil(MULTI) * n).map(tile).collect();
        Ok(Box::new(Inverse { tiles, n, arch: Arch::new() }))
    }
}

impl Factor for Inverse {
    fn name(&self) -> &'static str {
        "dense inverse"
    }

    fn unknowns(&self) -> usize {
        self.n
    }

    fn new_scratch(&self) -> Scratch {
        Scratch { lines: vec![Eight::default(); self.n.div_ceil(MULTI)], ..Scratch::default() }
    }

    fn new_multi_scratch(&self) -> Scratch {
        Scratch { lines: vec![Eight::default(); self.lines_of_eight()], ..Scratch::default() }
    }

    fn solve_in_place(&self, rhs: &mut [f64], scratch: &mut Scratch) -> Result<(), SolveError> {
        let out = &mut scratch.lines[..self.n.div_ceil(MULTI)];
        self.arch.dispatch(SingleProduct { inverse: self, x: rhs, out });
        for (rhs, out) in rhs.chunks_mut(MULTI).zip(out) {
            rhs.copy_from_slice(&out.0[..rhs.len()]);
        }
        Ok(())
    }

    fn solve_multi_in_place(
        &self,
        rhs: &mut [[f64; MULTI]],
        scratch: &mut Scratch,
    ) -> Result<(), SolveError> {
        scratch.make_room(self.lines_of_eight());
        let out = scratch.lines.as_chunks_mut().0;
        self.arch.dispatch(MultiProduct { inverse: self, x: rhs, out });
        rhs.iter_mut().zip(out.as_flattened()).for_each(|(rhs, out)| *rhs = out.0);
        Ok(())
    }
}

impl Inverse {
    /// Lines of scratch for eight right-hand sides.
    fn lines_of_eight(&self) -> usize {
        self.n.next_multiple_of(MULTI)
    }

    /// out ← A⁻¹ x for N eights of rows, each sum in the order of columns whatever the processor.
    #[inline(always)]
    fn times<S: Simd, const N: usize>(&self, simd: S, tiles: &[Eight], x: &[f64], out: &mut [Eight]) {
        let mut rows: [&[Eight]; N] = [&[]; N];
        for k in 0..N {
            rows[k] = &tiles[self.n * k..self.n * (k + 1)];
        }
        // As many of the eight as the vectors of a line are used.
        let mut sums = [[simd.splat_f64s(0.0); MULTI]; N];
        for (j, x) in x.iter().enumerate() {
            let x = simd.splat_f64s(*x);
            for k in 0..N {
                let tile = S::as_simd_f64s(&rows[k][j].0).0;
                for (sum, &entries) in sums[k].iter_mut().zip(tile) {
                    *sum = simd.add_f64s(*sum, simd.mul_f64s(entries, x));
                }
            }
        }
        for (out, sums) in out.iter_mut().zip(&sums) {
            for (out, sum) in S::as_mut_simd_f64s(&mut out.0).0.iter_mut().zip(sums) {
                *out = *sum;
            }
        }
    }

    /// Product of one group of eight rows with eight right-hand sides.
    #[inline(always)]
    fn times_multi<S: Simd>(&self, simd: S, tiles: &[Eight], x: &[[f64; MULTI]], out: &mut [Eight; MULTI]) {
        for v in 0..MULTI / S::F64_LANES {
            let mut sums = [simd.splat_f64s(0.0); MULTI];
            for (tile, x) in tiles.iter().zip(x) {
                let x = S::as_simd_f64s(x).0[v];
                for (sum, &entry) in sums.iter_mut().zip(&tile.0) {
                    *sum = simd.add_f64s(*sum, simd.mul_f64s(simd.splat_f64s(entry), x));
                }
            }
            for (out, sum) in out.iter_mut().zip(&sums) {
                S::as_mut_simd_f64s(&mut out.0).0[v] = *sum;
            }
        }
    }
}

/// A product, compiled for each kind of processor.
struct SingleProduct<'a> {
    inverse: &'a Inverse,
    x: &'a [f64],
    out: &'a mut [Eight],
}

impl WithSimd for SingleProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { inverse, x, out } = self;
        let tiles = inverse.tiles.chunks(TOGETHER * inverse.n.max(1));
        for (tiles, out) in tiles.zip(out.chunks_mut(TOGETHER)) {
            match out.len() {
                1 => inverse.times::<S, 1>(simd, tiles, x, out),
                2 => inverse.times::<S, 2>(simd, tiles, x, out),
                3 => inverse.times::<S, 3>(simd, tiles, x, out),
                _ => inverse.times::<S, TOGETHER>(simd, tiles, x, out),
            }
        }
    }
}

/// A product with eight right-hand sides, compiled for each kind of processor.
struct MultiProduct<'a> {
    inverse: &'a Inverse,
    x: &'a [[f64; MULTI]],
    out: &'a mut [[Eight; MULTI]],
}

impl WithSimd for MultiProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for (tiles, out) in self.inverse.tiles.chunks(self.inverse.n.max(1)).zip(self.out) {
            self.inverse.times_multi(simd, tiles, self.x, out);
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
