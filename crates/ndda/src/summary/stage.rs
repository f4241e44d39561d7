//! How stages of construction ended.

use serde::{Deserialize, Serialize};

use super::{Label, Motion};

/// The end of a stage. Checkpoints keep it, so that no field may be left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StageEnd {
    /// Its name.
    pub name: String,
    /// Time of the run at its end \[s\].
    pub end_s: f64,
    /// Steps of the run at its end.
    pub steps: u64,
    /// Further steps, time standing still, until it was at rest; 0 where it was not to come to rest.
    pub settling_steps: u64,
    /// Blocks that are there.
    pub blocks: usize,
    /// Energy that blocks taken out so far had, and their contacts, less that of blocks added \[J\].
    pub removed_j: f64,
    /// Blocks that moved, and how far, since displacements began to count.
    pub motion: Motion,
    /// The run's judgement of itself so far.
    pub label: Label,
}
