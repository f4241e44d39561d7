//! The contract of a linear solver, and the matrix that it is given.

use std::any::Any;

/// A symmetric matrix by its lower triangle in compressed columns, rows ascending, diagonal first.
#[derive(Clone, Debug, PartialEq)]
pub struct SymmetricMatrix {
    /// Rows and columns.
    pub n: usize,
    /// First entry of each column (`n + 1` values).
    pub column_start: Vec<usize>,
    /// Row of each entry.
    pub row: Vec<usize>,
    /// Value of each entry.
    pub value: Vec<f64>,
}

impl SymmetricMatrix {
    /// Builds the matrix column by column; `fill` appends the (row, value) pairs of column j with rows j and up.
    pub fn from_lower(n: usize, mut fill: impl FnMut(usize, &mut Vec<(usize, f64)>)) -> Self {
        let mut matrix = Self { n, column_start: vec![0], row: Vec::new(), value: Vec::new() };
        let mut entries = Vec::new();
        for j in 0..n {
            entries.clear();
            fill(j, &mut entries);
            entries.sort_unstable_by_key(|entry| entry.0);
            assert!(entries.first().is_some_and(|entry| entry.0 == j), "column {j} has no diagonal");
            matrix.row.extend(entries.iter().map(|entry| entry.0));
            matrix.value.extend(entries.iter().map(|entry| entry.1));
            matrix.column_start.push(matrix.row.len());
        }
        matrix
    }

    /// A x, for tests and residuals.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.n];
        for j in 0..self.n {
            for k in self.column_start[j]..self.column_start[j + 1] {
                let (i, value) = (self.row[k], self.value[k]);
                out[i] += value * x[j];
                if i != j {
                    out[j] += value * x[i];
                }
            }
        }
        out
    }
}

/// Why a matrix could not be factored.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FactorError {
    /// The matrix is not positive definite.
    #[error(
        "the matrix of {unknowns} unknowns is not positive definite: check step_s, materials and mesh quality"
    )]
    NotPositiveDefinite {
        /// Size of the matrix.
        unknowns: usize,
    },
    /// The factor does not fit in memory.
    #[error("no memory for the factor of {unknowns} unknowns: use a coarser mesh")]
    OutOfMemory {
        /// Size of the matrix.
        unknowns: usize,
    },
}

/// Right-hand sides of [`Factor::solve_multi_in_place`].
pub const MULTI: usize = 8;

/// Eight numbers in one line of the cache.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Eight(pub(crate) [f64; MULTI]);

/// Memory that a solve may write over; made once, for one factor.
#[derive(Debug, Default)]
pub struct Scratch {
    /// Numbers one by one.
    pub(crate) numbers: Vec<f64>,
    /// Numbers by eights.
    pub(crate) lines: Vec<Eight>,
    /// One of eight right-hand sides, for solvers that take them one by one.
    pub(crate) lane: Vec<f64>,
    /// That of a solver of other people.
    pub(crate) own: Option<Box<dyn Any + Send + Sync>>,
}

impl Scratch {
    /// Memory of any kind, which [`own`](Self::own) gives back in each solve.
    pub fn of<T: Any + Send + Sync>(own: T) -> Self {
        Self { own: Some(Box::new(own)), ..Self::default() }
    }

    /// The value that it was made of; `None` if it was made of another type.
    pub fn own<T: Any>(&mut self) -> Option<&mut T> {
        self.own.as_mut().and_then(|own| own.downcast_mut())
    }

    /// At least so many lines; allocates only if there were fewer.
    pub(crate) fn make_room(&mut self, lines: usize) {
        if self.lines.len() < lines {
            self.lines.resize(lines, Eight::default());
        }
    }
}

/// A solve that did not reach a solution.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the solution of the equations did not converge (residual {residual:e} of the load): use the direct solver, or a shorter step_s"
)]
pub struct SolveError {
    /// Residual over right-hand side.
    pub residual: f64,
}

/// Factors symmetric positive definite matrices.
pub trait LinearSolver: Send + Sync {
    /// Factors `matrix`.
    ///
    /// # Errors
    /// [`FactorError`] when the matrix is not positive definite or too large.
    fn factor(&self, matrix: &SymmetricMatrix) -> Result<Box<dyn Factor>, FactorError>;
}

/// A factored matrix; it exists only once factored, so nothing can be called in the wrong order.
pub trait Factor: Send + Sync {
    /// Its kind, for reports.
    fn name(&self) -> &'static str;

    /// Number of unknowns.
    fn unknowns(&self) -> usize;

    /// Scratch for [`solve_in_place`](Self::solve_in_place).
    fn new_scratch(&self) -> Scratch;

    /// Solves A x = b in place; allocates nothing.
    ///
    /// # Errors
    /// [`SolveError`] when an iteration does not get there; a factor always does.
    fn solve_in_place(&self, rhs: &mut [f64], scratch: &mut Scratch) -> Result<(), SolveError>;

    /// Scratch for [`solve_multi_in_place`](Self::solve_multi_in_place), and as good for the other.
    fn new_multi_scratch(&self) -> Scratch {
        Scratch { lane: vec![0.0; self.unknowns()], ..self.new_scratch() }
    }

    /// Solves for eight right-hand sides in place, `rhs[unknown][lane]`; each gets the bits that
    /// [`solve_in_place`](Self::solve_in_place) gives it. Allocates nothing if the scratch is for eight.
    ///
    /// # Errors
    /// [`SolveError`] of the first lane whose iteration does not get there; a factor always does.
    fn solve_multi_in_place(
        &self,
        rhs: &mut [[f64; MULTI]],
        scratch: &mut Scratch,
    ) -> Result<(), SolveError> {
        let mut one = std::mem::take(&mut scratch.lane);
        one.resize(self.unknowns(), 0.0);
        let mut solve = |lane: usize| {
            one.iter_mut().zip(&*rhs).for_each(|(x, b)| *x = b[lane]);
            self.solve_in_place(&mut one, scratch)?;
            rhs.iter_mut().zip(&one).for_each(|(b, x)| b[lane] = *x);
            Ok(())
        };
        let outcome = (0..MULTI).try_for_each(&mut solve);
        scratch.lane = one;
        outcome
    }
}
