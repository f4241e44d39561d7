//! The facets that touch, block by block, so that what a block gives and takes is summed in one order on any number of threads.

use std::ops::Range;

use ndda_mesh::BlockId;

use crate::integrals::Touch;

/// Where the touching facets of each block are, as contactor and as target.
#[derive(Default)]
pub struct ByBlock {
    /// First of each block's own; facets are sorted by contactor.
    own_start: Vec<u32>,
    /// Those on each block, by (target, facet), and where each block's begin.
    on_target: Vec<u32>,
    target_start: Vec<u32>,
}

impl ByBlock {
    /// Sorts the facets that touch by block, of so many blocks.
    pub fn arrange(&mut self, blocks: usize, touching: &[Touch]) {
        for starts in [&mut self.own_start, &mut self.target_start] {
            starts.clear();
            starts.resize(blocks + 2, 0);
        }
        for touch in touching {
            self.own_start[touch.owner.index() + 1] += 1;
            self.target_start[touch.target.index() + 2] += 1;
        }
        for b in 0..blocks {
            self.own_start[b + 1] += self.own_start[b];
            self.target_start[b + 2] += self.target_start[b + 1];
        }
        // Each entry moves on from where its block begins to where the next one does.
        self.on_target.clear();
        self.on_target.resize(touching.len(), 0);
        for (t, touch) in (0..).zip(touching) {
            let place = &mut self.target_start[touch.target.index() + 1];
            self.on_target[*place as usize] = t;
            *place += 1;
        }
    }

    /// The touching facets of a block, by number.
    pub fn of(&self, block: BlockId) -> Range<u32> {
        self.own_start[block.index()]..self.own_start[block.index() + 1]
    }

    /// Those of others on it, ascending.
    pub fn on(&self, block: BlockId) -> &[u32] {
        let range = self.target_start[block.index()]..self.target_start[block.index() + 1];
        &self.on_target[range.start as usize..range.end as usize]
    }

    /// How many facets touch the blocks, or are of them.
    pub fn count(&self, blocks: &Range<usize>) -> usize {
        let between = |starts: &[u32]| (starts[blocks.end] - starts[blocks.start]) as usize;
        between(&self.own_start) + between(&self.target_start)
    }
}
