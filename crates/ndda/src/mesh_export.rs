//! Blocks in the formats of other programs.

use std::path::Path;
use std::str::FromStr;

use ndda_io::{WriteError, mesh_file, surface_file};

use crate::build::{CutRock, Meshes};

/// A format of meshes or blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Export {
    /// mesh.msh, with a physical volume per block.
    Gmsh,
    /// mesh.inp.
    Abaqus,
    /// mesh.node, mesh.ele and mesh.face.
    Tetgen,
    /// mesh.vtu, with the sets of nodes.
    Vtu,
    /// ROCK_parts.vtu, with the blocks of a rock as polyhedra.
    Polyhedra,
    /// ROCK_parts.obj.
    Obj,
}

impl FromStr for Export {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "gmsh" => Ok(Self::Gmsh),
            "abaqus" => Ok(Self::Abaqus),
            "tetgen" => Ok(Self::Tetgen),
            "vtu" => Ok(Self::Vtu),
            "polyhedra" => Ok(Self::Polyhedra),
            "obj" => Ok(Self::Obj),
            _ => Err("write gmsh, abaqus, tetgen, vtu, polyhedra or obj".into()),
        }
    }
}

/// Writes blocks in a format; returns the names of the files.
///
/// # Errors
/// [`WriteError`] when one of them cannot be written.
pub fn write(
    folder: &Path,
    export: Export,
    meshes: &Meshes,
    rock: &[CutRock],
) -> Result<Vec<String>, WriteError> {
    let ending = match export {
        Export::Gmsh => "msh",
        Export::Abaqus => "inp",
        Export::Tetgen => "ele",
        Export::Vtu => "vtu",
        Export::Polyhedra | Export::Obj => return parts(folder, export, rock),
    };
    let name = format!("mesh.{ending}");
    mesh_file::write(&folder.join(&name), meshes)?;
    Ok(vec![name])
}

/// Writes the convex parts of each rock.
fn parts(folder: &Path, export: Export, rock: &[CutRock]) -> Result<Vec<String>, WriteError> {
    let mut names = Vec::new();
    for CutRock { report, blocks } in rock {
        let is_obj = export == Export::Obj;
        let name = format!("{}_parts.{}", report.name, if is_obj { "obj" } else { "vtu" });
        if is_obj {
            surface_file::write_blocks(&folder.join(&name), blocks)?;
        } else {
            mesh_file::write_polyhedra(&folder.join(&name), blocks)?;
        }
        names.push(name);
    }
    Ok(names)
}
