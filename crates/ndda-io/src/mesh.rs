//! Meshes of tetrahedra in the formats of other programs, chosen by the file's ending.
//!
//! | ending | program | bodies | node sets |
//! |---|---|---|---|
//! | `.msh` | Gmsh 2.2, 4.1 | physical volumes | physical surfaces, curves, points |
//! | `.node` `.ele` `.face` | TetGen | region attribute | markers of faces |
//! | `.vtu`, `.vtk` | VTK, ParaView | cell data `body`, `block`, `block_id` or `material` | point data `set:name` |
//! | `.inp` | Abaqus | `*SOLID SECTION`, or `ELSET`s of C3D4 | `NSET`s, `ELSET`s of surface elements |
//! | `.geo` `.step` `.stp` `.brep` | meshed by an installed Gmsh | as `.msh` | as `.msh` |
//!
//! Coordinates are as in the file. Whether a mesh can be computed with is not looked at: see [`ndda_mesh::validate`].

pub(crate) mod abaqus;
pub(crate) mod error;
pub mod gmsh_program;
pub(crate) mod join;
pub(crate) mod lines;
pub mod msh;
pub(crate) mod parts;
pub mod surface_file;
pub mod terrain_grid;
pub(crate) mod tetgen;
#[cfg(feature = "tetgen")]
pub mod tetgen_fill;
pub(crate) mod vtk_file;

use std::path::Path;

use ndda_mesh::BlockMesh;

use crate::write_error::WriteError;
use error::{Fault, ending};
use gmsh_program::Sizes;

pub use error::{FileProblem, MeshFileError, Place};
pub use vtk_file::write_polyhedra;

/// Endings that [`read`] knows, for messages.
const ENDINGS: &str = ".msh, .node, .ele, .face, .vtu, .vtk, .inp, .geo, .step, .stp, .brep";

/// Content of a mesh file.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// Name and mesh of each body; coordinates as in the file.
    pub bodies: Vec<(String, BlockMesh)>,
}

/// Reads a mesh in the format that the ending of `path` says.
///
/// Each body has nodes of its own in the order of the file, even where bodies share them there. Nodes of no
/// tetrahedron are left out. A file that names no bodies is one, `body`.
///
/// # Errors
/// [`MeshFileError`] with the line when the file cannot be read or understood, or holds cells of a volume that are
/// not tetrahedra of first order.
pub fn read(path: &Path) -> Result<MeshFile, MeshFileError> {
    match ending(path).as_str() {
        "msh" => msh::read(path),
        "node" | "ele" | "face" => tetgen::read(path),
        "inp" => abaqus::read(path),
        "vtu" | "vtk" => vtk_file::read(path),
        _ if gmsh_program::is_geometry(path) => gmsh_program::mesh(path, &Sizes::default(), None),
        _ => Err(Fault::from(FileProblem::Extension { found: ending(path), known: ENDINGS }).of(path)),
    }
}

/// Writes bodies in the format that the ending of `path` says: what [`read`] reads.
///
/// Reading the file gives the same bodies again, but for empty node sets and nodes of no tetrahedron, and for names of bodies in `.vtk`,
/// where they are numbers.
///
/// # Errors
/// [`WriteError`] for an unknown ending, a number that is not finite, a name that the format cannot keep, and what
/// the operating system refuses.
pub fn write(path: &Path, bodies: &[(String, BlockMesh)]) -> Result<(), WriteError> {
    match ending(path).as_str() {
        "msh" => msh::write(path, bodies),
        "node" | "ele" | "face" => tetgen::write(path, bodies),
        "inp" => abaqus::write(path, bodies),
        "vtu" => vtk_file::write(path, bodies),
        "vtk" => vtk_file::write_legacy::write(path, bodies),
        found => {
            let reason = format!(
                "`.{found}` is not a format that is written here: give .msh, .node, .ele, .vtu, .vtk or .inp"
            );
            Err(WriteError::Encode { path: path.to_path_buf(), reason })
        }
    }
}
