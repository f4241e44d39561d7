//! Meshes of geometry by Gmsh, an external program: `.geo`, `.step`, `.stp`, `.brep` in, its `.msh` read.

use std::path::Path;

use crate::mesh::error::{Fault, ending};
use crate::mesh::{FileProblem, MeshFile, MeshFileError};

/// Environment variable that names the program.
const VARIABLE: &str = "NDDA_GMSH";

/// How long edges may be [unit of the file].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sizes {
    /// Longest edge; the geometry's own sizes if none.
    pub size: Option<f64>,
    /// Where edges are shorter.
    pub finer: Vec<Finer>,
}

/// Edges of `size` at a place, growing by `growth` per distance from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finer {
    /// The place: a point, or the plane through it with this normal.
    pub place: ([f64; 3], Option<[f64; 3]>),
    /// Length of edges there.
    pub size: f64,
    /// Growth of the length with distance.
    pub growth: f64,
}

/// Whether the ending of a file is that of a geometry, for Gmsh to mesh.
pub fn is_geometry(path: &Path) -> bool {
    ["geo", "step", "stp", "brep"].contains(&ending(path).as_str())
}

/// Meshes a geometry with tetrahedra of first order.
///
/// The program is `program`, or what `NDDA_GMSH` names, or `gmsh`. A `.geo` file can run commands: mesh only files that you trust. Gmsh reads
/// `.step` files in millimetres.
///
/// # Errors
/// [`FileProblem::Program`] when the program is missing (with what to install) or complains, and those of
/// [`msh::read`] for its mesh.
pub fn mesh(geometry: &Path, sizes: &Sizes, program: Option<&Path>) -> Result<MeshFile, MeshFileError> {
    if let Err(error) = std::fs::metadata(geometry) {
        return Err(Fault::from(FileProblem::Unreadable(error.to_string())).of(geometry));
    }
    by_program(geometry, sizes, program)
}

#[cfg(not(feature = "gmsh"))]
fn by_program(geometry: &Path, _: &Sizes, _: Option<&Path>) -> Result<MeshFile, MeshFileError> {
    let said = "this program was built without calling Gmsh: build it with `--features gmsh`";
    Err(Fault::from(FileProblem::Program(said.into())).of(geometry))
}

#[cfg(feature = "gmsh")]
fn by_program(geometry: &Path, sizes: &Sizes, program: Option<&Path>) -> Result<MeshFile, MeshFileError> {
    use std::ffi::OsString;
    use std::process::{Command, Stdio};

    /// Lines of the program's complaints that are passed on.
    const LINES: usize = 4;

    let fail = |problem| Fault::from(problem).of(geometry);
    let name = program.map(|path| path.as_os_str().to_owned()).or_else(|| std::env::var_os(VARIABLE));
    let name = name.unwrap_or_else(|| OsString::from("gmsh"));
    let folder = tempfile::tempdir().map_err(|e| fail(FileProblem::Unreadable(e.to_string())))?;
    let result = folder.path().join("mesh.msh");
    let mut command = Command::new(&name);
    command.arg(geometry);
    if !sizes.finer.is_empty() {
        let fields = folder.path().join("fields.geo");
        std::fs::write(&fields, fields_text(&sizes.finer))
            .map_err(|e| fail(FileProblem::Unreadable(e.to_string())))?;
        command.arg(fields);
    }
    command.args(["-3", "-order", "1", "-format", "msh41", "-bin", "-v", "2", "-o"]).arg(&result);
    if let Some(size) = sizes.size {
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
    crate::mesh::msh::parse(geometry, &bytes)
}

/// Gmsh's fields for the places where edges are shorter; the least counts.
#[cfg(feature = "gmsh")]
fn fields_text(places: &[Finer]) -> String {
    let mut text = String::new();
    for (i, finer) in (1..).zip(places) {
        let ([x, y, z], normal) = finer.place;
        let squared = match normal {
            None => format!("(x-({x:?}))^2+(y-({y:?}))^2+(z-({z:?}))^2"),
            Some([a, b, c]) => {
                let length = (a * a + b * b + c * c).sqrt();
                let [a, b, c] = [a / length, b / length, c / length];
                format!("(({a:?})*(x-({x:?}))+({b:?})*(y-({y:?}))+({c:?})*(z-({z:?})))^2")
            }
        };
        let Finer { size, growth, .. } = finer;
        text += &format!("Field[{i}] = MathEval;\nField[{i}].F = \"{size:?}+{growth:?}*Sqrt({squared})\";\n");
    }
    let all: Vec<String> = (1..=places.len()).map(|i| i.to_string()).collect();
    let (least, all) = (places.len() + 1, all.join(", "));
    text += &format!(
        "Field[{least}] = Min;\nField[{least}].FieldsList = {{{all}}};\nBackground Field = {least};\n"
    );
    text
}
