//! VTK's files: meshes from `.vtu` and legacy `.vtk`, and what a mesh and blocks are written to.
//!
//! Format: VTK user's guide, "VTK File Formats". Legacy files are written by `vtkio`. XML is read and written here: `vtkio` keeps no field
//! data, where the names of bodies are, and no faces of polyhedra, unpacks only with a crate that has an advisory, and gives no line for what it refuses.

mod base64;
mod binary;
mod data;
pub(crate) mod grid;
mod legacy;
mod polyhedra;
mod sections;
mod write;
pub(super) mod write_legacy;
mod xml;

use std::path::Path;

use crate::mesh::error::bytes_of;
use crate::mesh::{MeshFile, MeshFileError};

pub use data::Array;
pub(crate) use data::{Data, TETRA};
pub use polyhedra::write as write_polyhedra;
pub(crate) use write::write;

/// Reads a mesh: `.vtu` (ASCII, binary, appended; plain or zlib) or legacy `.vtk` (ASCII or binary).
///
/// The cell data `body`, `block`, `block_id`, `material` or `gmsh:physical` is the body; point data `set:name` of
/// 0 and 1 is a node set. Cells of surfaces and lines are left out.
///
/// # Errors
/// [`MeshFileError`] with the line of a text.
pub(crate) fn read(path: &Path) -> Result<MeshFile, MeshFileError> {
    let bytes = bytes_of(path)?;
    let bodies = data(&bytes).and_then(|data| data.parts()?.split());
    Ok(MeshFile { bodies: bodies.map_err(|fault| fault.of(path))? })
}

/// Content of a file of either format.
pub(crate) fn data(bytes: &[u8]) -> Result<Data, crate::mesh::error::Fault> {
    if bytes.starts_with(b"# vtk") { legacy::read(bytes) } else { xml::read(bytes) }
}
