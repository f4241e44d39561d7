//! The numbers of the factor, front by front (Duff & Reid 1983), on dense kernels of faer.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltRegularization, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::triangular::{BlockStructure, matmul as triangular_matmul};
use faer::linalg::triangular_inverse::invert_lower_triangular;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, MatRef, Par, Spec};

use super::panels::{Panel, Panels};
use super::symbolic::{Supernode, Symbolic};
use crate::linear::linear_solver::{Eight, FactorError, MULTI, SymmetricMatrix};

/// Most columns of a panel, a multiple of eight: wider supernodes are cut, so that no large block is inverted.
const MOST_COLUMNS: usize = 128;

/// The matrix in the order of the factor, its lower triangle by columns.
struct Ordered {
    start: Vec<usize>,
    row: Vec<u32>,
    value: Vec<f64>,
}

impl Ordered {
    fn new(matrix: &SymmetricMatrix, unknown: &[u32]) -> Self {
        let n = matrix.n;
        let mut position = vec![0; n];
        unknown.iter().enumerate().for_each(|(k, &u)| position[u as usize] = k);
        let entries = || {
            (0..n)
                .flat_map(|j| (matrix.column_start[j]..matrix.column_start[j + 1]).map(move |k| (j, k)))
                .map(|(j, k)| {
                    let (a, b) = (position[j], position[matrix.row[k]]);
                    (a.min(b), a.max(b), matrix.value[k])
                })
        };
        let mut start = vec![0; n + 1];
        entries().for_each(|(column, ..)| start[column + 1] += 1);
        (0..n).for_each(|j| start[j + 1] += start[j]);
        let mut end = start.clone();
        let (mut row, mut value) = (vec![0; start[n]], vec![0.0; start[n]]);
        for (column, i, v) in entries() {
            (row[end[column]], value[end[column]]) = (i as u32, v);
            end[column] += 1;
        }
        Self { start, row, value }
    }
}

/// A vector of this many copies, or the error that there is no memory for it.
fn filled<T: Clone>(len: usize, value: T, unknowns: usize) -> Result<Vec<T>, FactorError> {
    let mut vector = Vec::new();
    vector.try_reserve_exact(len).map_err(|_| FactorError::OutOfMemory { unknowns })?;
    vector.resize(len, value);
    Ok(vector)
}

/// Factors `matrix`.
pub(super) fn factor(matrix: &SymmetricMatrix, symbolic: &Symbolic) -> Result<Panels, FactorError> {
    let mut panels = lay_out(matrix.n, symbolic)?;
    let ordered = Ordered::new(matrix, &symbolic.unknown);
    let mut place = vec![0u32; matrix.n];
    let mut updates: Vec<Vec<f64>> = vec![Vec::new(); symbolic.supernodes.len()];
    let mut next = 0;
    for (k, node) in symbolic.supernodes.iter().enumerate() {
        let mut front = Front::new(node, matrix.n)?;
        front.gather(node, &ordered, &mut place);
        for &child in &node.children {
            let update = std::mem::take(&mut updates[child as usize]);
            front.extend(&symbolic.supernodes[child as usize].rows, &update, &place);
        }
        front.eliminate(matrix.n)?;
        while let Some(panel) = panels.panels.get(next).filter(|panel| panel.first < node.columns.end) {
            let offset = panel.first - node.columns.start;
            front.copy(offset, *panel, &mut panels.tiles[panel.tiles..panel.tiles + panel.len()])?;
            next += 1;
        }
        updates[k] = front.update;
    }
    Ok(panels)
}

/// Panels of zeros.
fn lay_out(unknowns: usize, symbolic: &Symbolic) -> Result<Panels, FactorError> {
    let (mut panels, mut tiles) = (Panels { unknowns, ..Panels::default() }, 0);
    for node in &symbolic.supernodes {
        let start = panels.row.len();
        let rows: Vec<u32> =
            node.columns.clone().map(|j| j as u32).chain(node.rows.iter().copied()).collect();
        for eight in rows.chunks(MULTI) {
            panels.row.push(std::array::from_fn(|r| eight.get(r).copied().unwrap_or(unknowns as u32)));
        }
        let eights = node.columns.len().div_ceil(MULTI);
        let most = MULTI * eights.div_ceil(node.columns.len().div_ceil(MOST_COLUMNS));
        for first in node.columns.clone().step_by(most) {
            let skipped = (first - node.columns.start) / MULTI;
            let (width, height) = (most.min(node.columns.end - first), panels.row.len() - start - skipped);
            let panel = Panel { first, width, rows: start + skipped, height, tiles };
            tiles += panel.len();
            panels.panels.push(panel);
        }
    }
    panels.tiles = filled(tiles, Eight::default(), unknowns)?;
    Ok(panels)
}

/// One supernode's part of the matrix with all that was eliminated before, lower triangles by columns.
struct Front {
    width: usize,
    below: usize,
    /// Columns of the supernode.
    panel: Vec<f64>,
    /// Update matrix for the rows below.
    update: Vec<f64>,
    unknowns: usize,
}

impl Front {
    fn new(node: &Supernode, unknowns: usize) -> Result<Self, FactorError> {
        let (width, below) = (node.columns.len(), node.rows.len());
        let panel = filled((width + below) * width, 0.0, unknowns)?;
        let update = filled(below * below, 0.0, unknowns)?;
        Ok(Self { width, below, panel, update, unknowns })
    }

    /// Adds the matrix, and notes in `place` where the rows below are.
    fn gather(&mut self, node: &Supernode, ordered: &Ordered, place: &mut [u32]) {
        (self.width as u32..).zip(&node.rows).for_each(|(local, &row)| place[row as usize] = local);
        (0..).zip(node.columns.clone()).for_each(|(local, row)| place[row] = local);
        let rows = self.width + self.below;
        for (local, column) in node.columns.clone().enumerate() {
            for k in ordered.start[column]..ordered.start[column + 1] {
                self.panel[local * rows + place[ordered.row[k] as usize] as usize] = ordered.value[k];
            }
        }
    }

    /// Adds what a child left.
    fn extend(&mut self, child_rows: &[u32], child: &[f64], place: &[u32]) {
        let (rows, below, width) = (self.width + self.below, self.below, self.width);
        let local: Vec<usize> = child_rows.iter().map(|&row| place[row as usize] as usize).collect();
        for (j, column) in child.chunks_exact(local.len().max(1)).enumerate() {
            let target = match local[j] {
                c if c < width => &mut self.panel[c * rows..(c + 1) * rows],
                c => &mut self.update[(c - width) * below..(c - width + 1) * below],
            };
            let shift = if local[j] < width { 0 } else { width };
            for (&row, value) in local[j..].iter().zip(&column[j..]) {
                target[row - shift] += value;
            }
        }
    }

    /// L of the columns, and A − L Lᵀ of the rest.
    fn eliminate(&mut self, unknowns: usize) -> Result<(), FactorError> {
        let (width, below) = (self.width, self.below);
        let need = cholesky_in_place_scratch::<f64>(width, Par::Seq, Spec::default());
        let mut memory = MemBuffer::try_new(need).map_err(|_| FactorError::OutOfMemory { unknowns })?;
        let panel = MatMut::from_column_major_slice_mut(&mut self.panel, width + below, width);
        let (mut own, mut rest) = panel.split_at_row_mut(width);
        let stack = MemStack::new(&mut memory);
        cholesky_in_place(own.rb_mut(), LltRegularization::default(), Par::Seq, stack, Spec::default())
            .map_err(|_| FactorError::NotPositiveDefinite { unknowns })?;
        if below == 0 {
            return Ok(());
        }
        solve_lower_triangular_in_place(own.rb(), rest.rb_mut().transpose_mut(), Par::Seq);
        triangular_matmul(
            MatMut::from_column_major_slice_mut(&mut self.update, below, below),
            BlockStructure::TriangularLower,
            Accum::Add,
            rest.rb(),
            BlockStructure::Rectangular,
            rest.rb().transpose(),
            BlockStructure::Rectangular,
            -1.0,
            Par::Seq,
        );
        Ok(())
    }

    /// Writes P of the columns from `offset` on, see [`Panels`].
    fn copy(&self, offset: usize, panel: Panel, tiles: &mut [Eight]) -> Result<(), FactorError> {
        let (rows, width) = (self.width + self.below - offset, panel.width);
        let columns = MatRef::from_column_major_slice(&self.panel, self.width + self.below, self.width);
        let columns = columns.submatrix(offset, offset, rows, width);
        let mut product = filled(rows * width, 0.0, self.unknowns)?;
        let (mut inverse, mut rest) =
            MatMut::from_column_major_slice_mut(&mut product, rows, width).split_at_row_mut(width);
        invert_lower_triangular(inverse.rb_mut(), columns.get(..width, ..), Par::Seq);
        triangular_matmul(
            rest.rb_mut(),
            BlockStructure::Rectangular,
            Accum::Replace,
            columns.get(width.., ..),
            BlockStructure::Rectangular,
            inverse.rb(),
            BlockStructure::TriangularLower,
            -1.0,
            Par::Seq,
        );
        let mut tiles = tiles.iter_mut();
        for (columns, height) in panel.groups() {
            let first_row = MULTI * (panel.height - height);
            for row in (0..height).map(|t| first_row + MULTI * t) {
                for column in first_row..first_row + columns {
                    let tile = tiles.next().expect("as many tiles as the panel has");
                    for r in row.max(column)..rows.min(row + MULTI) {
                        tile.0[r - row] = product[column * rows + r];
                    }
                }
            }
        }
        Ok(())
    }
}
