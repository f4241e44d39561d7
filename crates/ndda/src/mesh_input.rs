//! Blocks of a file: a mesh of tetrahedra, or a closed surface that is filled with as few of them as there can be.

use std::path::Path;

use ndda_io::mesh_file::{self, FileProblem, MeshFileError};
use ndda_mesh::repair;

use crate::build::{self, Meshes};

/// A repair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Repair {
    /// Turn inverted tetrahedra round.
    Orient,
    /// Merge coincident nodes within a part of the size of a block.
    Merge(f64),
}

/// Endings of files that hold surfaces and no tetrahedra.
const SURFACES: [&str; 3] = ["stl", "obj", "vtp"];

/// Reads and repairs the bodies of a file; with them come words on each repair.
///
/// # Errors
/// What is wrong with the file, or cannot be repaired.
pub fn read(path: &Path, repairs: &[Repair]) -> Result<(Meshes, Vec<String>), String> {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let mut meshes = match SURFACES.contains(&ending.as_str()) {
        true => {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            vec![(name, build::body_in_surface(path)?)]
        }
        false => mesh_file::read(path).map_err(|error| with_surfaces(&error))?.bodies,
    };
    let mut done = Vec::new();
    for repair in repairs {
        for (name, mesh) in &mut meshes {
            let words = match repair {
                Repair::Orient => format!("{} tetrahedra turned round", repair::orient(mesh).flipped.len()),
                Repair::Merge(within) => {
                    let merged =
                        repair::merge(mesh, *within).map_err(|error| format!("body `{name}`: {error}"))?;
                    let (nodes, tets) = (merged.nodes.len(), merged.dropped_tets.len());
                    let within_m = merged.tolerance_m;
                    format!("{nodes} nodes merged within {within_m:e} m, {tets} flat tetrahedra dropped")
                }
            };
            done.push(format!("{name}: {words}"));
        }
    }
    Ok((meshes, done))
}

/// The words of an error, with what else can be measured where the ending of a file is unknown.
fn with_surfaces(error: &MeshFileError) -> String {
    match error.problem {
        FileProblem::Extension { .. } => {
            format!("{error}; a closed surface, .stl, .obj or .vtp; or a scene, .ron")
        }
        _ => error.to_string(),
    }
}
