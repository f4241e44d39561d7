//! Balances of blocks to which nothing has happened yet.

use super::{BlockBalance, BlockDiagnostics};

impl BlockDiagnostics {
    /// Takes the balances out if nothing has happened yet, and gives their number; leaves any others.
    pub(crate) fn take_empty(&mut self) -> usize {
        let is_empty = self.balances.iter().all(|balance| *balance == BlockBalance::default());
        if is_empty { std::mem::take(&mut self.balances).len() } else { 0 }
    }

    /// Puts that many balances back, of blocks to which nothing has happened yet.
    pub(crate) fn put_empty(&mut self, blocks: usize) {
        self.balances = vec![BlockBalance::default(); blocks];
    }
}
