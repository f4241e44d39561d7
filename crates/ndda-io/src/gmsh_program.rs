//! Meshes of geometry by Gmsh, an external program: `.geo`, `.step`, `.stp`, `.brep` in, its `.msh` read.

use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::mesh_file::error::Fault;
use crate::mesh_file::{FileProblem, MeshFile, MeshFileError};
use crate::msh;

/// Environment variable that names the program.
pub const VARIABLE: &str = "NDDA_GMSH";
/// Lines of the program's complaints that are passed on.
const LINES: usize = 4;

/// Meshes a geometry with tetrahedra of first order.
///
/// `size` is the largest edge [unit of the file], for the geometry's own sizes if none. The program is `program`, or
/// what `NDDA_GMSH` names, or `gmsh`. A `.geo` file can run commands: mesh only files that you trust. Gmsh reads
/// `.step` files in millimetres.
///
/// # Errors
/// [`FileProblem::Program`] when the program is missing (with what to install) or complains, and those of
/// [`msh::read`] for its mesh.
pub fn mesh(geometry: &Path, size: Option<f64>, program: Option<&Path>) -> Result<MeshFile, MeshFileError> {
    let fail = |problem| Fault::from(problem).of(geometry);
    if let Err(error) = std::fs::metadata(geometry) {
        return Err(fail(FileProblem::Unreadable(error.to_string())));
    }
    let name = program.map(|path| path.as_os_str().to_owned()).or_else(|| std::env::var_os(VARIABLE));
    let name = name.unwrap_or_else(|| OsString::from("gmsh"));
    let folder = tempfile::tempdir().map_err(|e| fail(FileProblem::Unreadable(e.to_string())))?;
    let result = folder.path().join("mesh.msh");
    let mut command = Command::new(&name);
    command
        .arg(geometry)
        .args(["-3", "-order", "1", "-format", "msh41", "-bin", "-v", "2", "-o"])
        .arg(&result);
    if let Some(size) = size {
        command.arg("-clmax").arg(size.to_string());
    }
    let output = command.stdin(Stdio::null()).output().map_err(|error| {
        fail(FileProblem::Program(format!(
            "Gmsh is needed to mesh it, but `{}` cannot be run ({error}): install Gmsh (https://gmsh.info, \
             `apt install gmsh` or `pip install gmsh`) or name the program in {VARIABLE}",
            name.to_string_lossy()
        )))
    })?;
    let text = String::from_utf8_lossy(&[&output.stdout[..], &output.stderr].concat()).into_owned();
    // A geometry that Gmsh cannot read is no failure to it.
    let is_wrong = text.lines().any(|line| line.starts_with("Error"));
    if !output.status.success() || is_wrong || !result.is_file() {
        let lines: Vec<&str> =
            text.lines().map(str::trim).filter(|line| !line.is_empty()).take(LINES).collect();
        let said = if lines.is_empty() { output.status.to_string() } else { lines.join("; ") };
        return Err(fail(FileProblem::Program(format!("Gmsh made no mesh of it: {said}"))));
    }
    let bytes = std::fs::read(&result).map_err(|e| fail(FileProblem::Unreadable(e.to_string())))?;
    // Errors name the geometry: the mesh is gone by then.
    Ok(msh::parse(geometry, &bytes)?)
}
