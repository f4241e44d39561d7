//! Writes `.node`, `.ele` and `.face`.

use std::fmt::Write;
use std::path::Path;

use ndda_mesh::BlockMesh;
use ndda_mesh::surface::boundary_faces;

use crate::atomic;
use crate::mesh::join::Joined;
use crate::write_error::WriteError;

/// Writes `.node`, `.ele` and `.face` beside each other; `path` has any of these endings. Numbers from 0.
///
/// Bodies are regions from 1, named in comments; node sets are attributes of nodes, named alike. The faces are the
/// boundaries of the bodies.
///
/// # Errors
/// [`WriteError`] for a number that is not finite, a name that cannot be kept, and what the operating system refuses.
pub(crate) fn write(path: &Path, bodies: &[(String, BlockMesh)]) -> Result<(), WriteError> {
    let joined = Joined::new(path, bodies)?;
    let content = nodes(&joined).and_then(|n| Ok([n, tets(&joined)?, faces(&joined)?]));
    let content = content.expect("a String takes all that is written to it");
    for (ending, text) in ["node", "ele", "face"].into_iter().zip(content) {
        atomic::write_named(&path.with_extension(ending), text.as_bytes())?;
    }
    Ok(())
}

fn nodes(joined: &Joined) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for (attribute, name) in (1..).zip(joined.sets.keys()) {
        writeln!(text, "# attribute {attribute} = {name}")?;
    }
    writeln!(text, "{} 3 {} 0", joined.nodes.len(), joined.sets.len())?;
    for (i, x) in (0..).zip(&joined.nodes) {
        write!(text, "{i} {:?} {:?} {:?}", x.x, x.y, x.z)?;
        for set in joined.sets.values() {
            write!(text, " {}", u8::from(set.binary_search(&i).is_ok()))?;
        }
        writeln!(text)?;
    }
    Ok(text)
}

fn tets(joined: &Joined) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for (region, name) in (1..).zip(&joined.names) {
        writeln!(text, "# region {region} = {name}")?;
    }
    writeln!(text, "{} 4 1", joined.tets.len())?;
    for (i, ([a, b, c, d], body)) in joined.tets.iter().zip(joined.body_of_tets()).enumerate() {
        writeln!(text, "{i} {a} {b} {c} {d} {}", body + 1)?;
    }
    Ok(text)
}

/// Without markers: our sets are attributes of nodes.
fn faces(joined: &Joined) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    let faces = boundary_faces(&joined.tets);
    writeln!(text, "{} 0", faces.len())?;
    for (i, face) in faces.iter().enumerate() {
        let [a, b, c] = face.nodes;
        writeln!(text, "{i} {a} {b} {c}")?;
    }
    Ok(text)
}
