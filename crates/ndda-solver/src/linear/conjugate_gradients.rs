//! Conjugate gradients, preconditioned by the diagonal: no factor, so little memory, and many products per solve.

use rayon::prelude::*;

use crate::linear::linear_solver::{Factor, FactorError, LinearSolver, Scratch, SolveError, SymmetricMatrix};

/// Iterations without a smaller residual after which rounding has the last word.
const PATIENCE: usize = 50;
/// A residual that has stalled above this part of the right-hand side is no solution. On the way there it is not rounding that keeps
/// it from shrinking: it rises and falls until what pushes one end has come to the other, an element in each iteration.
const STALLED: f64 = 1e-9;
/// Elements from end to end of the longest mesh that is waited for.
const LONGEST: usize = 10_000;
/// Rows below which a second thread costs more than it brings.
const GRAIN_ROWS: usize = 2048;

/// Solves anew in every step (Hestenes & Stiefel 1952); for blocks too large to factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConjugateGradients {
    /// Residual over right-hand side at which to stop.
    pub tolerance: f64,
}

/// All rows of the matrix, both triangles.
struct Rows {
    start: Vec<usize>,
    column: Vec<u32>,
    value: Vec<f64>,
    inverse_diagonal: Vec<f64>,
    tolerance: f64,
}

impl LinearSolver for ConjugateGradients {
    fn factor(&self, matrix: &SymmetricMatrix) -> Result<Box<dyn Factor>, FactorError> {
        let unknowns = matrix.n;
        let diagonal: Vec<f64> = matrix.column_start[..unknowns].iter().map(|&k| matrix.value[k]).collect();
        // All that can be known beforehand; the rest shows in the iteration.
        if !diagonal.iter().all(|&d| d > 0.0 && d.is_finite()) {
            return Err(FactorError::NotPositiveDefinite { unknowns });
        }
        let mut entries = Vec::with_capacity(2 * matrix.value.len());
        for j in 0..unknowns {
            for k in matrix.column_start[j]..matrix.column_start[j + 1] {
                let (i, value) = (matrix.row[k], matrix.value[k]);
                entries.push((i, j, value));
                if i != j {
                    entries.push((j, i, value));
                }
            }
        }
        entries.sort_unstable_by_key(|&(row, column, _)| (row, column));
        let mut start = vec![0; unknowns + 1];
        entries.iter().for_each(|entry| start[entry.0 + 1] += 1);
        (0..unknowns).for_each(|i| start[i + 1] += start[i]);
        Ok(Box::new(Rows {
            start,
            column: entries.iter().map(|entry| entry.1 as u32).collect(),
            value: entries.iter().map(|entry| entry.2).collect(),
            inverse_diagonal: diagonal.iter().map(|d| 1.0 / d).collect(),
            tolerance: self.tolerance,
        }))
    }
}

impl Rows {
    fn times(&self, x: &[f64], out: &mut [f64]) {
        let row = |(i, out): (usize, &mut f64)| {
            let range = self.start[i]..self.start[i + 1];
            let row = self.column[range.clone()].iter().zip(&self.value[range]);
            *out = row.map(|(&j, value)| value * x[j as usize]).sum();
        };
        out.par_iter_mut().enumerate().with_min_len(GRAIN_ROWS).for_each(row);
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Factor for Rows {
    fn name(&self) -> &'static str {
        "conjugate gradients"
    }

    fn unknowns(&self) -> usize {
        self.inverse_diagonal.len()
    }

    fn new_scratch(&self) -> Scratch {
        Scratch { numbers: vec![0.0; 4 * self.unknowns()], ..Scratch::default() }
    }

    /// x ← 0, r ← b, p ← D⁻¹ r;  α = r·D⁻¹r / p·Ap,  x ← x + α p,  r ← r − α Ap,  β = new over old r·D⁻¹r.
    fn solve_in_place(&self, rhs: &mut [f64], scratch: &mut Scratch) -> Result<(), SolveError> {
        let n = self.unknowns();
        let [x, r, p, product] = quarters(&mut scratch.numbers, n);
        let size = dot(rhs, rhs).sqrt();
        if !size.is_finite() {
            // As by a factorisation: the block of a force that is no number is named where its speeds are.
            rhs.fill(f64::NAN);
            return Ok(());
        }
        x.fill(0.0);
        r.copy_from_slice(rhs);
        let precondition = |(r, d): (&f64, &f64)| r * d;
        p.iter_mut().zip(r.iter().zip(&self.inverse_diagonal).map(precondition)).for_each(|(p, z)| *p = z);
        let mut weight = dot(r, p);
        let (mut least, mut waited) = (f64::INFINITY, 0);
        let crossing = |least: f64| if least > STALLED * size { n.min(LONGEST) } else { 0 };
        while least > self.tolerance * size && waited < PATIENCE + crossing(least) {
            self.times(p, product);
            let curvature = dot(p, product);
            if curvature.is_nan() || curvature <= 0.0 {
                break;
            }
            let step = weight / curvature;
            x.iter_mut().zip(&*p).for_each(|(x, p)| *x += step * p);
            r.iter_mut().zip(&*product).for_each(|(r, q)| *r -= step * q);
            let residual = dot(r, r).sqrt();
            waited = if residual < least { 0 } else { waited + 1 };
            least = least.min(residual);
            let old = weight;
            weight = r.iter().zip(&self.inverse_diagonal).map(|(r, d)| r * r * d).sum();
            let turn = weight / old;
            let preconditioned = r.iter().zip(&self.inverse_diagonal).map(precondition);
            p.iter_mut().zip(preconditioned).for_each(|(p, z)| *p = z + turn * *p);
        }
        if size > 0.0 && (least.is_nan() || least > STALLED.max(self.tolerance) * size) {
            return Err(SolveError { residual: least / size });
        }
        rhs.copy_from_slice(x);
        Ok(())
    }
}

fn quarters(numbers: &mut [f64], n: usize) -> [&mut [f64]; 4] {
    let (a, rest) = numbers.split_at_mut(n);
    let (b, rest) = rest.split_at_mut(n);
    let (c, d) = rest.split_at_mut(n);
    [a, b, c, d]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::check_linear_solver;

    #[test]
    fn it_keeps_the_contract_of_a_linear_solver() {
        check_linear_solver(&ConjugateGradients { tolerance: 1e-15 });
    }

    #[test]
    fn a_long_bar_pulled_at_its_end_is_solved_for() {
        // Springs in a row, the first held: each end moves by one more than the one before.
        let links = 1500;
        let matrix = SymmetricMatrix::from_lower(links, |j, out| {
            out.push((j, if j + 1 < links { 2.0 } else { 1.0 }));
            out.extend((j + 1 < links).then_some((j + 1, -1.0)));
        });
        let bar = ConjugateGradients { tolerance: 1e-12 }.factor(&matrix).expect("a positive diagonal");
        let mut moved = vec![0.0; links];
        moved[links - 1] = 1.0;
        bar.solve_in_place(&mut moved, &mut bar.new_scratch()).expect("an answer");
        for (j, x) in moved.iter().enumerate() {
            assert!((x / (j + 1) as f64 - 1.0).abs() < 1e-6, "{j}: {x}");
        }
    }

    #[test]
    fn a_matrix_that_is_not_definite_shows_in_the_solve() {
        // [1 2; 2 1] has a positive diagonal and the eigenvalue −1.
        let matrix = SymmetricMatrix::from_lower(2, |j, out| {
            out.extend(if j == 0 { vec![(0, 1.0), (1, 2.0)] } else { vec![(1, 1.0)] });
        });
        let factor = ConjugateGradients { tolerance: 1e-12 }.factor(&matrix).expect("a positive diagonal");
        let mut rhs = [1.0, -1.0];
        assert!(factor.solve_in_place(&mut rhs, &mut factor.new_scratch()).is_err());
    }
}
