//! Congruent blocks solved for together: their factor is read once for all of them.

use crate::linear::linear_solver::{Factor, MULTI, Scratch};

/// Blocks from which on solving them together is quicker than one by one (a block of eight costs 0.2 to 0.6 of one alone).
pub(crate) const ENOUGH_TOGETHER: usize = 6;

/// Right-hand sides of up to eight blocks, side by side.
pub(crate) struct Batch {
    pub(super) lanes: Vec<[f64; MULTI]>,
    pub(super) scratch: Scratch,
}

impl Batch {
    /// Workspace for blocks with this factor.
    pub(crate) fn new(factor: &dyn Factor) -> Self {
        Self { lanes: vec![[0.0; MULTI]; factor.unknowns()], scratch: factor.new_multi_scratch() }
    }
}
