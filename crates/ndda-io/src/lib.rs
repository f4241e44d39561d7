//! Files in and out: RON scenes with their diagnostics, meshes of other programs, VTU fields, history, summary and checkpoints.

pub mod abaqus;
pub mod atomic;
pub mod check;
pub mod checkpoint;
pub mod code;
pub mod diagnostic;
pub mod folder;
pub mod gmsh_program;
pub mod history;
pub mod locate;
pub mod mesh_file;
pub mod msh;
pub mod outside_files;
pub mod overrides;
#[cfg(feature = "parquet")]
pub mod parquet_file;
#[cfg(feature = "fancy")]
mod picture;
pub mod pvd;
pub mod read;
pub mod record;
pub mod results;
pub mod scene;
#[cfg(feature = "schema")]
pub mod schema;
pub mod study;
pub mod summary;
pub mod surface_file;
pub mod table;
pub mod tables;
pub mod tetgen;
#[cfg(feature = "tetgen")]
pub mod tetgen_fill;
pub mod units;
pub mod vtk_file;
pub mod vtu;
pub mod write_error;

pub use folder::OutputFolder;
pub use history::History;
pub use pvd::FieldSeries;
pub use summary::Summary;
pub use vtu::Frame;
pub use write_error::WriteError;
