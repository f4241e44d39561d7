//! What control of the step books.

use crate::diagnostics::ledger::Ledger;

impl Ledger {
    /// Counts a discarded step.
    pub(crate) fn note_rejected(&mut self) {
        self.worst.control.rejected += 1;
    }

    /// Keeps the most halvings of a step.
    pub(crate) fn note_halvings(&mut self, halvings: u32) {
        let control = &mut self.worst.control;
        control.most_halvings = control.most_halvings.max(halvings);
    }
}
