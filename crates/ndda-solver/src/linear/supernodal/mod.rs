//! Sparse L Lᵀ by supernodes, laid out for the solves: a block is factored once and solved in every step.

mod dissection;
mod graph;
mod numeric;
mod panels;
mod separator;
mod symbolic;

use pulp::{Arch, Simd, WithSimd};

use crate::linear::linear_solver::{
    Eight, Factor, FactorError, LinearSolver, MULTI, Scratch, SolveError, SymmetricMatrix,
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
    /// Bytes of the factor that each of the two sweeps of a solve reads.
    pub fn bytes(&self) -> usize {
        size_of_val(self.panels.tiles.as_slice()) + size_of_val(self.panels.row.as_slice())
    }

    /// Lines of scratch for eight right-hand sides: the unknowns, one for none, and a panel's rows.
    fn lines_of_eight(&self) -> usize {
        self.unknowns() + 1 + MULTI * self.panels.most_height()
    }
}

/// A solve, compiled for each kind of processor.
struct SingleSolve<'a> {
    panels: &'a Panels,
    x: &'a mut [f64],
    local: &'a mut [Eight],
}

impl WithSimd for SingleSolve<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.panels.solve(simd, self.x, self.local);
    }
}

/// A solve for eight right-hand sides, compiled for each kind of processor.
struct MultiSolve<'a> {
    panels: &'a Panels,
    x: &'a mut [Eight],
    local: &'a mut [[Eight; MULTI]],
}

impl WithSimd for MultiSolve<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.panels.solve_multi(simd, self.x, self.local);
    }
}

impl Factor for SupernodalFactor {
    fn name(&self) -> &'static str {
        "supernodal Cholesky factor"
    }

    fn unknowns(&self) -> usize {
        self.unknown.len()
    }

    fn new_scratch(&self) -> Scratch {
        let lines = vec![Eight::default(); self.panels.most_height()];
        Scratch { numbers: vec![0.0; self.unknowns() + 1], lines, ..Scratch::default() }
    }

    fn new_multi_scratch(&self) -> Scratch {
        Scratch { lines: vec![Eight::default(); self.lines_of_eight()], ..self.new_scratch() }
    }

    fn solve_in_place(&self, rhs: &mut [f64], scratch: &mut Scratch) -> Result<(), SolveError> {
        let x = &mut scratch.numbers[..=self.unknowns()];
        x[self.unknowns()] = 0.0;
        x.iter_mut().zip(&self.unknown).for_each(|(x, &u)| *x = rhs[u as usize]);
        self.arch.dispatch(SingleSolve { panels: &self.panels, x, local: &mut scratch.lines });
        x.iter().zip(&self.unknown).for_each(|(x, &u)| rhs[u as usize] = *x);
        Ok(())
    }

    fn solve_multi_in_place(
        &self,
        rhs: &mut [[f64; MULTI]],
        scratch: &mut Scratch,
    ) -> Result<(), SolveError> {
        scratch.make_room(self.lines_of_eight());
        let (x, local) = scratch.lines.split_at_mut(self.unknowns() + 1);
        x[self.unknowns()] = Eight::default();
        x.iter_mut().zip(&self.unknown).for_each(|(x, &u)| x.0 = rhs[u as usize]);
        self.arch.dispatch(MultiSolve { panels: &self.panels, x, local: local.as_chunks_mut().0 });
        x.iter().zip(&self.unknown).for_each(|(x, &u)| rhs[u as usize] = x.0);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::dense_inverse::DenseInverse;
    use crate::testing::{check_linear_solver, check_multi};
    use ndda_contact::testing::Random;

    #[test]
    fn it_keeps_the_contract_of_a_linear_solver() {
        check_linear_solver(&Supernodal);
    }

    /// A matrix with −1 at these pairs, and a diagonal that exceeds the sum of its row by one.
    fn dominant(n: usize, pairs: &[(usize, usize)]) -> SymmetricMatrix {
        let mut pairs: Vec<_> = pairs.iter().map(|&(i, j)| (i.min(j), i.max(j))).collect();
        pairs.retain(|(i, j)| i != j);
        pairs.sort_unstable();
        pairs.dedup();
        let mut diagonal = vec![1.0; n];
        pairs.iter().for_each(|&(i, j)| [i, j].into_iter().for_each(|k| diagonal[k] += 1.0));
        SymmetricMatrix::from_lower(n, |j, out| {
            out.push((j, diagonal[j]));
            out.extend(pairs.iter().filter(|pair| pair.0 == j).map(|pair| (pair.1, -1.0)));
        })
    }

    /// Panics unless A x = b holds to rounding, with the same bits for eight right-hand sides.
    fn check(matrix: &SymmetricMatrix) {
        let factor = Supernodal.factor(matrix).expect("the matrix is positive definite");
        let load: Vec<f64> = (0..matrix.n).map(|i| (1.3 * i as f64).cos()).collect();
        let mut x = load.clone();
        factor.solve_in_place(&mut x, &mut factor.new_scratch()).expect("a solution");
        let size = matrix.value.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        for (product, b) in matrix.times(&x).iter().zip(&load) {
            assert!((product - b).abs() < 1e-14 * size, "n = {}: {product} for {b}", matrix.n);
        }
        check_multi(factor.as_ref());
    }

    #[test]
    fn random_patterns_are_solved_to_rounding_and_as_the_inverse_does() {
        let mut random = Random(7);
        for round in 0..40 {
            let n = 1 + (random.unit() * 300.0) as usize;
            let at = |random: &mut Random| (random.unit() * n as f64) as usize;
            let count = n * (round % 5);
            let pairs: Vec<_> = (0..count).map(|_| (at(&mut random), at(&mut random))).collect();
            let matrix = dominant(n, &pairs);
            check(&matrix);
            let solve = |solver: &dyn LinearSolver| {
                let factor = solver.factor(&matrix).expect("the matrix is positive definite");
                let mut x = vec![1.0; n];
                factor.solve_in_place(&mut x, &mut factor.new_scratch()).expect("a solution");
                x
            };
            for (a, b) in solve(&Supernodal).iter().zip(solve(&DenseInverse)) {
                assert!((a - b).abs() < 1e-13, "{a} and {b}");
            }
        }
    }

    #[test]
    fn arrows_chains_stars_and_unconnected_unknowns_are_solved() {
        let n = 1000;
        let to_last: Vec<_> = (0..n - 1).map(|i| (i, n - 1)).collect();
        let to_first: Vec<_> = (1..n).map(|i| (0, i)).collect();
        let chain: Vec<_> = (1..n).map(|i| (i - 1, i)).collect();
        let rings: Vec<_> = (0..n).map(|i| (i, i / 50 * 50 + (i + 1) % 50)).collect();
        for pairs in [vec![], to_last, to_first, chain, rings] {
            check(&dominant(n, &pairs));
        }
    }

    #[test]
    fn a_full_matrix_wider_than_a_panel_is_solved() {
        for n in [127, 128, 129, 300] {
            let all: Vec<_> = (0..n).flat_map(|i| (0..i).map(move |j| (i, j))).collect();
            check(&dominant(n, &all));
        }
    }

    #[test]
    fn a_grid_of_three_unknowns_a_node_is_solved() {
        let side = 12;
        let node = |x: usize, y: usize, z: usize| x + side * (y + side * z);
        let mut pairs = Vec::new();
        for (x, y, z) in (0..side.pow(3)).map(|k| (k % side, k / side % side, k / side / side)) {
            let ahead =
                [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (0, 1, 1), (1, 0, 1), (1, 1, 1), (0, 0, 0)];
            for (u, v, w) in ahead.map(|(u, v, w)| (x + u, y + v, z + w)) {
                if u.max(v).max(w) < side {
                    let [a, b] = [3 * node(x, y, z), 3 * node(u, v, w)];
                    pairs.extend((0..9).map(|k| (a + k / 3, b + k % 3)));
                }
            }
        }
        check(&dominant(3 * side.pow(3), &pairs));
    }

    #[test]
    fn every_kind_of_processor_gives_the_same_bits() {
        let pairs: Vec<_> = (0..500).flat_map(|i| [(i, (i * 7 + 3) % 500), (i, (i + 25) % 500)]).collect();
        let SupernodalFactor { panels, .. } =
            Supernodal::factor_panels(&dominant(500, &pairs)).expect("definite");
        let solve = |solve: &dyn Fn(SingleSolve)| {
            let mut x: Vec<f64> = (0..501).map(|i| if i < 500 { (i as f64).sin() } else { 0.0 }).collect();
            let mut local = vec![Eight::default(); panels.most_height()];
            solve(SingleSolve { panels: &panels, x: &mut x, local: &mut local });
            x.into_iter().map(f64::to_bits).collect::<Vec<_>>()
        };
        let one_by_one = solve(&|one| pulp::Scalar::new().vectorize(one));
        assert_eq!(solve(&|one| Arch::new().dispatch(one)), one_by_one);
        #[cfg(target_arch = "x86_64")]
        if let Some(four_by_four) = pulp::x86::V3::try_new() {
            assert_eq!(solve(&|one| Simd::vectorize(four_by_four, one)), one_by_one);
        }
    }

    #[test]
    fn a_load_that_is_no_number_leaves_nothing_for_the_next() {
        let factor = Supernodal.factor(&dominant(30, &[(0, 1), (3, 29)])).expect("definite");
        let mut scratch = factor.new_multi_scratch();
        for value in [f64::NAN, f64::INFINITY, 1.0] {
            let (mut x, mut eight) = ([value; 30], [[value; MULTI]; 30]);
            factor.solve_in_place(&mut x, &mut scratch).expect("a solution");
            factor.solve_multi_in_place(&mut eight, &mut scratch).expect("a solution");
            let finite = x.iter().chain(eight.as_flattened()).all(|x| x.is_finite());
            assert_eq!(finite, value.is_finite());
        }
    }

    #[test]
    fn no_unknowns_are_solved() {
        check(&dominant(0, &[]));
    }

    #[test]
    fn what_is_not_definite_or_no_number_is_refused_wherever_it_is() {
        for at in [0, 17, 199] {
            for wrong in [-1.0, 0.0, f64::NAN] {
                let mut matrix = dominant(200, &(1..200).map(|i| (i - 1, i)).collect::<Vec<_>>());
                let k = matrix.column_start[at];
                matrix.value[k] = wrong;
                let refused = Supernodal.factor(&matrix).err();
                assert_eq!(
                    refused,
                    Some(FactorError::NotPositiveDefinite { unknowns: 200 }),
                    "{wrong} at {at}"
                );
            }
        }
    }
}
