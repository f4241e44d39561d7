//! Files in and out: RON scenes with their diagnostics, meshes of other programs, VTU fields, history, summary and checkpoints.
//!
//! | module | contents |
//! |---|---|
//! | [`scene`] | the scene's types, reading and checking them, messages with their places, studies, records |
//! | [`mesh`] | meshes of tetrahedra and surfaces in the formats of Gmsh, TetGen, VTK, Abaqus, STL and OBJ |
//! | [`results`] | fields, history, tables, summary and checkpoints: written, and read back |
//! | [`atomic`] | whole files or none |

pub mod atomic;
pub mod mesh;
pub mod results;
pub mod scene;
pub mod write_error;

#[cfg(feature = "tetgen")]
pub use mesh::tetgen_fill;
pub use mesh::{self as mesh_file, abaqus, gmsh_program, msh, surface_file, tetgen, vtk_file};
#[cfg(feature = "parquet")]
pub use results::table::parquet as parquet_file;
pub use results::{checkpoint, folder, history, pvd, summary, table, tables, vtu};
#[cfg(feature = "schema")]
pub use scene::schema;
pub use scene::{check, code, diagnostic, locate, outside_files, overrides, read, record, study, units};

pub use folder::OutputFolder;
pub use history::History;
pub use pvd::FieldSeries;
pub use summary::Summary;
pub use vtu::Frame;
pub use write_error::WriteError;
