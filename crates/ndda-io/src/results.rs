//! Results of a run: writing and reading them.

pub(crate) mod bolt_lines;
pub mod checkpoint;
pub mod folder;
pub(crate) mod history;
pub(crate) mod pvd;
mod read;
pub mod summary;
pub mod table;
pub mod tables;
pub mod vtu;

#[cfg(test)]
mod testing;

pub use bolt_lines::bolt_lines;
pub use read::{
    Array, BoltForces, FieldFrame, ListedFrame, ResultsError, Table, bolt_forces, frame, frame_list, history,
    history_file, summary,
};
