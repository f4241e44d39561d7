//! Congruent blocks solved for together: their factor is read once for all of them.

use crate::body::{BlockError, Body};
use crate::linear_solver::{EIGHT, Factor, Scratch};
use crate::shape::Shape;

/// Blocks from which on solving them together is quicker than one by one (a block of eight costs 0.2 to 0.6 of one alone).
pub const ENOUGH_TOGETHER: usize = 6;

/// Right-hand sides of up to eight blocks, side by side.
pub struct Batch {
    lanes: Vec<[f64; EIGHT]>,
    scratch: Scratch,
}

impl Batch {
    /// Room for blocks with this factor.
    pub fn new(factor: &dyn Factor) -> Self {
        Self { lanes: vec![[0.0; EIGHT]; factor.unknowns()], scratch: factor.new_scratch_of_eight() }
    }
}

/// unknowns ← K̃⁻¹ unknowns for a run of prepared blocks, to the bits of solving them one by one.
pub fn solve_together(shape: &Shape, run: &mut [Body]) {
    let (Some(factor), Some(mut batch)) = (&shape.factor, run[0].batch.take()) else { return };
    let Batch { lanes, scratch } = &mut *batch;
    lanes.fill([0.0; EIGHT]);
    for (lane, body) in run.iter_mut().enumerate() {
        let Some(body) = body.elastic() else { continue };
        lanes.iter_mut().zip(&body.unknowns).for_each(|(row, b)| row[lane] = *b);
    }
    let solved = factor.solve_eight_in_place(lanes, scratch);
    for (lane, body) in run.iter_mut().enumerate() {
        if let Err(error) = &solved {
            body.error.get_or_insert(BlockError::Solve(*error));
        }
        let Some(body) = body.elastic() else { continue };
        body.unknowns.iter_mut().zip(&*lanes).for_each(|(x, row)| *x = row[lane]);
    }
    run[0].batch = Some(batch);
}
