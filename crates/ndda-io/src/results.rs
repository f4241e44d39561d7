//! Results of a run: writing and reading them.

pub(crate) mod bolt_lines;
pub mod checkpoint;
pub(crate) mod folder;
pub(crate) mod history;
pub(crate) mod pvd;
mod read;
pub mod table;
pub(crate) mod tables;
pub mod vtu;

#[cfg(test)]
mod testing;

pub use read::{Array, BoltForces, FieldFrame, ListedFrame, Table};
