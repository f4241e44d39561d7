//! Files in and out: RON scenes with their diagnostics, Gmsh meshes, VTU fields, history and summary.

pub mod atomic;
pub mod folder;
pub mod history;
pub mod msh;
pub mod pvd;
pub mod scene;
pub mod summary;
pub mod vtu;
pub mod write_error;

pub use folder::OutputFolder;
pub use history::History;
pub use pvd::FieldSeries;
pub use summary::Summary;
pub use vtu::Frame;
pub use write_error::WriteError;
