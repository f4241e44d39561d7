//! The largest value of a diagnosis over all blocks, and what scales it.

use serde::{Deserialize, Serialize};

/// Scales of a block for its diagnostics.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct BlockScale {
    /// Mass [kg].
    pub mass_kg: f64,
    /// Whether supports hold it, so that no contact moves it as a whole.
    pub is_held: bool,
    /// Whether it moves and deforms.
    pub deforms: bool,
    /// Farthest node from the mass centre [m].
    pub radius_m: f64,
    /// Smallest height of its tetrahedra [m].
    pub height_m: f64,
}

impl BlockScale {
    /// Order by which the lighter of two blocks is chosen; held ones are heavier than all.
    pub(crate) fn weight(&self) -> f64 {
        if self.is_held { f64::INFINITY } else { self.mass_kg }
    }
}

/// The worst of all blocks, with the block that it is of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// The value.
    pub value: f64,
    /// Index of the block.
    pub block: u32,
}

impl Worst {
    pub(crate) fn take(&mut self, value: f64, block: usize) {
        if value > self.value {
            *self = Self { value, block: block as u32 };
        }
    }
}
