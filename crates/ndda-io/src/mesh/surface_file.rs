//! Closed surfaces of rock from STL, OBJ and VTK files, for [`ndda_mesh::cut::Domain::polyhedral`].

mod obj;
mod stl;
mod weld;

use std::path::Path;

use ndda_mesh::Vec3;
use ndda_mesh::cut::DomainFace;

use crate::mesh::error::{Fault, bytes_of, ending};
use crate::mesh::vtk_file;
use crate::mesh::{FileProblem, MeshFileError};

pub use obj::write_blocks;

/// Name of faces that the file does not name.
const ONLY_NAME: &str = "surface";

/// A closed surface of triangles or polygons.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Vertices [unit of the file]; each is of a face.
    pub vertices: Vec<Vec3>,
    /// Faces, counter-clockwise seen from outside, named by the file's solid, group or material.
    pub faces: Vec<DomainFace>,
}

impl Surface {
    /// Volume under it, from tetrahedra to its first vertex [unit of the file, cubed]; negative if inside out.
    pub(crate) fn volume(&self) -> f64 {
        let Some(origin) = self.vertices.first() else { return 0.0 };
        let at = |v: u32| self.vertices[v as usize] - origin;
        let fan = |vertices: &[u32]| -> f64 {
            let corners = vertices.get(1..).unwrap_or_default();
            corners.windows(2).map(|w| at(vertices[0]).dot(&at(w[0]).cross(&at(w[1])))).sum()
        };
        self.faces.iter().map(|face| fan(&face.vertices)).sum::<f64>() / 6.0
    }
}

impl Surface {
    /// Reads a closed surface: STL (ASCII or binary), OBJ, VTK's `.vtp` or legacy `.vtk`, by the ending of `path`.
    ///
    /// Vertices nearer to each other than `tolerance` times the diagonal are one; 0 joins those that are equal. Faces
    /// that this leaves without area are dropped. A surface that is inside out as a whole is turned.
    ///
    /// # Errors
    /// [`MeshFileError`] with the line of a text, and with the first open edges of a surface that is not closed.
    pub fn read(path: &Path, tolerance: f64) -> Result<Self, MeshFileError> {
        let bytes = bytes_of(path)?;
        parse(&ending(path), &bytes, tolerance).map_err(|fault| fault.of(path))
    }
}

/// The triangles of an STL as they are, whether or not they close a surface.
pub(crate) fn open_stl(bytes: &[u8]) -> Result<Surface, Fault> {
    let surface = stl::read(bytes)?;
    if surface.faces.is_empty() { Err(FileProblem::NoFaces.into()) } else { Ok(surface) }
}

fn parse(ending: &str, bytes: &[u8], tolerance: f64) -> Result<Surface, Fault> {
    let raw = match ending {
        "stl" => stl::read(bytes)?,
        "obj" => obj::read(bytes)?,
        "vtp" | "vtk" => polygons(vtk_file::data(bytes)?)?,
        _ => {
            let (found, known) = (ending.to_string(), ".stl, .obj, .vtp, .vtk");
            return Err(FileProblem::Extension { found, known }.into());
        }
    };
    if raw.faces.is_empty() {
        return Err(FileProblem::NoFaces.into());
    }
    weld::closed(raw, tolerance)
}

/// Triangles, quadrangles and polygons of a file of VTK.
fn polygons(data: vtk_file::Data) -> Result<Surface, Fault> {
    let mut faces = Vec::new();
    for (kind, vertices) in data.cells() {
        match kind {
            1..=4 => {}
            5 | 7 | 9 if vertices.len() >= 3 => {
                faces.push(DomainFace { name: ONLY_NAME.into(), vertices: vertices.to_vec() });
            }
            _ => {
                let what = format!("a cell of VTK's type {kind} with {} points", vertices.len());
                return Err(
                    FileProblem::NotRead { what, cure: "save a surface of triangles or polygons" }.into()
                );
            }
        }
    }
    Ok(Surface { vertices: data.points, faces })
}
