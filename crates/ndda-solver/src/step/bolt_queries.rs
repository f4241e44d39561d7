//! What bolts carry, asked from outside.

use crate::bolts::embedding::Portion;
use crate::bolts::report::{BoltPiece, BoltStatus};
use crate::step::Simulation;

impl Simulation {
    /// Number of bolts.
    pub fn bolt_count(&self) -> usize {
        self.bolts.as_ref().map_or(0, |bolts| bolts.list.len())
    }

    /// Whether a bolt is there: installed, and not released.
    pub fn is_installed(&self, index: usize) -> bool {
        self.bolts.as_ref().and_then(|bolts| bolts.list.get(index)).is_some_and(|bolt| bolt.is_installed)
    }

    /// Name of a bolt, and its pieces in blocks.
    pub fn bolt(&self, index: usize) -> Option<(&str, &[Portion])> {
        let bolt = self.bolts.as_ref()?.list.get(index)?;
        Some((&bolt.name, &bolt.portions))
    }

    /// Length of a bolt from its head to its end [m].
    pub fn bolt_length_m(&self, index: usize) -> f64 {
        self.bolts.as_ref().and_then(|bolts| bolts.list.get(index)).map_or(0.0, |bolt| bolt.length_m)
    }

    /// Bonded length of a bolt in blocks [m].
    pub fn bonded_m(&self, index: usize) -> f64 {
        self.bonded_parts(index).iter().map(|part| part.to_m - part.from_m).sum()
    }

    /// Parts of a bolt that are bonded in blocks, from its head.
    pub fn bonded_parts(&self, index: usize) -> &[Portion] {
        self.bolts.as_ref().and_then(|bolts| bolts.list.get(index)).map_or(&[], |bolt| &bolt.bonded)
    }

    /// Replaces `out` by the pieces of all bolts that are there, as they were when forces were last taken, at the present places of blocks.
    pub fn bolt_pieces(&self, out: &mut Vec<BoltPiece>) {
        out.clear();
        let Some(bolts) = &self.bolts else { return };
        let mut memory = self.state.bolts.clone();
        memory.each(&bolts.sizes, |k, memory| {
            if bolts.list[k].is_installed {
                bolts.list[k].add_pieces(k, &self.state.position, &memory, out);
            }
        });
    }

    /// Replaces `out` by all bolts as a whole.
    pub fn bolt_statuses(&self, out: &mut Vec<BoltStatus>) {
        out.clear();
        let Some(bolts) = &self.bolts else { return };
        let mut memory = self.state.bolts.clone();
        let mut pieces = Vec::new();
        memory.each(&bolts.sizes, |k, memory| {
            let bolt = &bolts.list[k];
            pieces.clear();
            bolt.add_pieces(0, &self.state.position, &memory, &mut pieces);
            out.push(bolt.status(&self.state.position, &memory, &pieces));
        });
    }
}
