//! Balances of blocks across stages of construction, where contact changes at once.

use crate::diagnostics::block_diagnostics::BlockDiagnostics;
use crate::diagnostics::worst::BlockScale;

impl BlockDiagnostics {
    /// Blocks weigh otherwise from now on: some were taken out or added.
    pub(crate) fn weigh_anew(&mut self, scales: Vec<BlockScale>) {
        self.scales = scales;
        self.begin_anew_at_contact();
    }

    /// Forgets work and energy of contact so far, which [`rebase`](Self::rebase) follows; the errors so far stay.
    pub(crate) fn begin_anew_at_contact(&mut self) {
        for balance in &mut self.balances {
            balance.start_j -= balance.work_j + balance.contact_j;
            balance.contact_j = 0.0;
            balance.work_j = 0.0;
        }
    }

    /// Takes energies of contact from a look at it; the errors so far stay.
    pub(crate) fn rebase(&mut self, looked: &Self) {
        for (balance, looked) in self.balances.iter_mut().zip(&looked.balances) {
            balance.contact_j = looked.contact_j;
            balance.start_j += looked.contact_j;
        }
    }
}
