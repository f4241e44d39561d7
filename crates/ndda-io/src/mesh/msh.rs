//! Gmsh `.msh` files, 2.2 and 4.1, ASCII and binary of either byte order: the linear tetrahedra in them.
//!
//! Format: Gmsh reference manual, "MSH file format" and "MSH file format version 2 (Legacy)".
//! Physical volumes become bodies; physical surfaces, curves and points become node sets of the bodies that
//! their elements lie on. Every count is held against the length of the file before memory is taken for it.

mod bodies;
mod cursor;
pub(super) mod error;
mod mesh;
mod sections;
mod v2;
mod v4;
mod write;

use std::path::Path;

use crate::mesh::error::bytes_of;
use crate::mesh::{MeshFile, MeshFileError};
pub use error::MshProblem;
pub(crate) use write::write;

/// Reads a Gmsh mesh.
///
/// Each body has nodes of its own in the order of the file, even where Gmsh lets bodies share them. Nodes of no
/// tetrahedron are left out. A volume without a name is `volume_<tag>`; a group without a name is
/// `surface_<tag>`, `curve_<tag>` or `point_<tag>`; a file without any group is one body, `body`.
/// Whether the mesh can be computed with is not looked at: see [`ndda_mesh::validate`].
///
/// # Errors
/// [`MeshFileError`] with the line (ASCII) or byte (binary) when the file cannot be read or understood, holds anything
/// but points, lines, triangles and tetrahedra of first order, or leaves open which body a tetrahedron is in.
pub(crate) fn read(path: &Path) -> Result<MeshFile, MeshFileError> {
    parse(path, &bytes_of(path)?)
}

/// Reads a Gmsh mesh from memory; `path` is only for the error.
///
/// # Errors
/// As [`mesh::read`](crate::mesh::read) of a file.
pub fn parse(path: &Path, bytes: &[u8]) -> Result<MeshFile, MeshFileError> {
    let mut cursor = cursor::Cursor::new(bytes);
    sections::read(&mut cursor)
        .and_then(|mesh| bodies::split(&mesh))
        .map(|bodies| MeshFile { bodies })
        .map_err(|fault| MeshFileError {
            path: path.to_owned(),
            place: fault.at.map(|at| cursor.place(at)),
            problem: fault.problem,
        })
}
