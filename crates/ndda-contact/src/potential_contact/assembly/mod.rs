//! From integrals to forces on nodes, energies, stiffnesses and the report of a step.

pub(crate) mod adjacency;
mod block_shares;
pub(crate) mod couples;
pub(crate) mod energy;
pub(crate) mod facet_energy;
pub(crate) mod join_if;
pub(crate) mod nodal_forces;
pub(crate) mod overlap_parts;
mod overlap_volumes;
pub(crate) mod report;
pub(crate) mod searched_friction;
pub(crate) mod shared_forces;
mod shared_overlaps;
pub(crate) mod tangent;

pub use adjacency::BlockContactIndex;
pub use nodal_forces::{ScatterScene, add as add_nodal_forces};
pub use report::Reporter;
