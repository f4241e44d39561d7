//! Balances of energy and momentum, and diagnoses of what a step does not resolve.

pub(crate) mod block_diagnostics;
pub(crate) mod block_sums;
pub(crate) mod creep;
pub(crate) mod energies;
pub(crate) mod free_loads;
pub(crate) mod hops;
pub(crate) mod invariants;
pub(crate) mod kept_turn;
pub(crate) mod lateral_drift;
pub(crate) mod ledger;
pub(crate) mod many;
pub(crate) mod rebound;
pub(crate) mod ringing;
pub(crate) mod squeeze;
pub(crate) mod worst;
