//! What stages of construction book.

use crate::diagnostics::ledger::Ledger;

impl Ledger {
    /// Books energy that was taken out with blocks, less that of blocks that were added [J].
    pub(crate) fn add_removed(&mut self, energy_j: f64) {
        self.removed_j += energy_j;
    }

    /// Makes room for other energies of contact than those that its work has led to.
    pub(crate) fn begin_anew_at_contact(&mut self) {
        self.blocks.begin_anew_at_contact();
    }

    /// Books the work on a way to rest, of which another ledger was kept, and as damping what is left of a change of energy [J].
    pub(crate) fn add_way_to_rest(&mut self, way: &Self, change_j: f64) {
        let friction_j = way.friction_work_j - self.friction_work_j;
        let motion_j = way.motion_work_j - self.motion_work_j;
        let load_j = way.load_work_j - self.load_work_j;
        let restitution_j = way.restitution_work_j - self.restitution_work_j;
        let radiated_j = way.radiated_j - self.radiated_j;
        self.add_work(
            friction_j,
            motion_j,
            load_j,
            change_j - friction_j - motion_j - load_j - restitution_j + radiated_j,
        );
        self.add_radiated(radiated_j);
        self.add_restitution_work(restitution_j);
    }

    /// Keeps the deepest penetration of a look at contact.
    pub(crate) fn watch_depth(&mut self, ratio: f64) {
        self.worst.max_penetration_ratio = self.worst.max_penetration_ratio.max(ratio);
    }
}
