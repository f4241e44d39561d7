//! Writes an Abaqus input file.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

use ndda_mesh::BlockMesh;

use crate::atomic;
use crate::mesh::join::Joined;
use crate::write_error::WriteError;

/// Writes `*NODE`, one `*ELEMENT, TYPE=C3D4, ELSET=body` per body and one `*NSET` per node set, numbered from 1.
///
/// # Errors
/// [`WriteError`] for a number that is not finite, a name that cannot be kept (Abaqus does not tell small letters
/// from capitals), and what the operating system refuses.
pub(crate) fn write(path: &Path, bodies: &[(String, BlockMesh)]) -> Result<(), WriteError> {
    let joined = Joined::new(path, bodies)?;
    for names in [joined.names.clone(), joined.sets.keys().copied().collect()] {
        let mut known = BTreeSet::new();
        if let Some(name) = names.iter().find(|name| !known.insert(name.to_uppercase())) {
            let reason = format!("two names differ from `{name}` in capitals only: rename one");
            return Err(WriteError::Encode { path: path.to_path_buf(), reason });
        }
    }
    let text = text(&joined).expect("a String takes all that is written to it");
    atomic::write_named(path, text.as_bytes())
}

fn text(joined: &Joined) -> Result<String, std::fmt::Error> {
    let mut text = String::from("*HEADING\nTetrahedra of blocks\n*NODE\n");
    for (i, x) in joined.nodes.iter().enumerate() {
        writeln!(text, "{}, {:?}, {:?}, {:?}", i + 1, x.x, x.y, x.z)?;
    }
    for (name, range) in joined.names.iter().zip(joined.first_tet.windows(2)) {
        writeln!(text, "*ELEMENT, TYPE=C3D4, ELSET={}", quoted(name))?;
        for i in range[0]..range[1] {
            let [a, b, c, d] = joined.tets[i].map(|node| u64::from(node) + 1);
            writeln!(text, "{}, {a}, {b}, {c}, {d}", i + 1)?;
        }
    }
    for (name, nodes) in &joined.sets {
        writeln!(text, "*NSET, NSET={}", quoted(name))?;
        for row in nodes.chunks(16) {
            let labels: Vec<String> = row.iter().map(|&node| (u64::from(node) + 1).to_string()).collect();
            writeln!(text, "{}", labels.join(", "))?;
        }
    }
    Ok(text)
}

/// In quotes where Abaqus needs them.
fn quoted(name: &str) -> String {
    let is_plain = name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if is_plain { name.to_string() } else { format!("\"{name}\"") }
}
