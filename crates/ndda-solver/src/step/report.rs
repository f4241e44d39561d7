//! The report of one step.

use ndda_contact::ContactReport;
use serde::{Deserialize, Serialize};

use crate::diagnostics::worst::Worst;

/// The report of one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Contact at x*.
    pub contact: ContactReport,
    /// h = ω_c Δt, ω_c² taken as the largest row sum of contact's stiffness over the node's lumped mass.
    pub h: f64,
    /// Largest relative travel of two blocks that may meet in the step over the width of the thinner one, and which that is; only
    /// bounded from above where it is below a quarter of what is allowed.
    pub travel: Worst,
    /// Work of normal contact, the sum over facets without sign; only where steps are controlled [J].
    pub contact_work_j: f64,
    /// Iterations of implicit contact; none where contact is taken at predicted positions.
    pub iterations: Iterations,
}

impl StepReport {
    /// The worst of both, contact and iterations as they were last.
    pub(super) fn joined(self, later: Self) -> Self {
        Self {
            h: self.h.max(later.h),
            travel: if later.travel.value > self.travel.value { later.travel } else { self.travel },
            contact_work_j: self.contact_work_j + later.contact_work_j,
            contact: later.contact,
            iterations: later.iterations,
        }
    }
}

/// Iterations of implicit contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Iterations {
    /// Evaluations of contact.
    pub newton: u32,
    /// Solves per block within them.
    pub krylov: u32,
}

/// Counts of step control; zero without control.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepCounts {
    /// Discarded steps.
    pub rejected: u64,
    /// Most halvings of a step.
    pub most_halvings: u32,
}

/// Seconds spent per stage of the step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StageTimes {
    /// Contact forces.
    pub contact_s: f64,
    /// Block solves.
    pub blocks_s: f64,
    /// Bookkeeping and energies.
    pub ledger_s: f64,
}
