//! Numbers of pairs of blocks, each found by one of the ranks.

use std::ops::Range;

use ndda_ranks::{Communicator, Gathered, Packer, RanksError, Topic, Unpacker, divide, share};

/// A list that ranks share; all of it is this rank's where it is alone.
pub(super) struct Shared<'a> {
    ranks: Option<&'a dyn Communicator>,
    starts: Vec<usize>,
    entries: usize,
}

impl<'a> Shared<'a> {
    /// So many entries, each about as much work.
    pub(super) fn new(ranks: Option<&'a dyn Communicator>, entries: usize) -> Self {
        let starts = ranks.map_or_else(Vec::new, |r| divide(std::iter::repeat_n(1, entries), r.size()));
        Self { ranks, starts, entries }
    }

    /// Those of this rank.
    pub(super) fn own(&self) -> Range<usize> {
        self.ranks.map_or(0..self.entries, |ranks| share(&self.starts, ranks.rank()))
    }

    /// Takes the entries of the others from them.
    pub(super) fn exchange(&self, entries: &mut [f64]) -> Result<(), RanksError> {
        let Some(ranks) = self.ranks else { return Ok(()) };
        let (mut packer, mut all) = (Packer::default(), Gathered::default());
        packer.put_each(&entries[self.own()], |entry| *entry);
        ranks.exchange(Topic::Pairs, packer.bytes(), &mut all)?;
        for rank in 0..ranks.size() {
            Unpacker::new(all.of(rank)).take_into(&mut entries[share(&self.starts, rank)], |entry| entry);
        }
        Ok(())
    }
}
