//! Contacts sorted by block, so that the forces on a block are summed in one order on any number of threads.

use std::ops::Range;

use ndda_mesh::BlockId;

use crate::room::make_room;

/// Index of the contacts on each block, in compressed rows: facets in contact, or faces, of the block itself and of others on it.
#[derive(Default)]
pub struct BlockContactIndex {
    /// First of each block's own; they are sorted by block.
    own_start: Vec<u32>,
    /// Contacts on each block, by (target, number), and where each block's begin.
    on_target: Vec<u32>,
    target_start: Vec<u32>,
}

impl BlockContactIndex {
    /// Sorts them by block, of so many blocks, from the owner, ascending, and target of each.
    pub fn arrange(
        &mut self,
        blocks: usize,
        each: impl ExactSizeIterator<Item = (BlockId, BlockId)> + Clone,
    ) {
        for starts in [&mut self.own_start, &mut self.target_start] {
            starts.clear();
            starts.resize(blocks + 2, 0);
        }
        for (owner, target) in each.clone() {
            self.own_start[owner.index() + 1] += 1;
            self.target_start[target.index() + 2] += 1;
        }
        for b in 0..blocks {
            self.own_start[b + 1] += self.own_start[b];
            self.target_start[b + 2] += self.target_start[b + 1];
        }
        // Each entry moves on from where its block begins to where the next one does.
        self.on_target.clear();
        make_room(&mut self.on_target, each.len());
        self.on_target.resize(each.len(), 0);
        for (k, (_, target)) in (0..).zip(each) {
            let place = &mut self.target_start[target.index() + 1];
            self.on_target[*place as usize] = k;
            *place += 1;
        }
    }

    /// Contacts of a block's own facets, by number.
    pub(crate) fn of(&self, block: BlockId) -> Range<u32> {
        self.own_start[block.index()]..self.own_start[block.index() + 1]
    }

    /// Contacts of other blocks' facets with it, ascending.
    pub(crate) fn on(&self, block: BlockId) -> &[u32] {
        let range = self.target_start[block.index()]..self.target_start[block.index() + 1];
        &self.on_target[range.start as usize..range.end as usize]
    }

    /// Contacts of a block's own facets with sign +1, and of other blocks' facets with it with sign −1.
    pub(crate) fn at(&self, block: BlockId) -> impl Iterator<Item = (u32, f64)> {
        self.of(block).map(|k| (k, 1.0)).chain(self.on(block).iter().map(|&k| (k, -1.0)))
    }

    /// How many are of some blocks, or on them.
    pub(crate) fn count(&self, blocks: &Range<usize>) -> usize {
        let between = |starts: &[u32]| (starts[blocks.end] - starts[blocks.start]) as usize;
        between(&self.own_start) + between(&self.target_start)
    }
}
