//! Writes meshes as legacy `.vtk` (version 4.2, binary) for programs that read no XML.

use std::path::Path;

use ndda_mesh::BlockMesh;

use super::data::SET;
use crate::atomic;
use crate::mesh::join::Joined;
use crate::write_error::WriteError;

/// Number of tetrahedra among VTK's kinds of cells.
const TETRAHEDRON: i32 = 10;

/// Writes a mesh of tetrahedra as legacy `.vtk`: cell data `body` counts the bodies from 0, whose names the format cannot keep; each node
/// set is point data `set:name` of 0 and 1.
///
/// # Errors
/// As [`write`](super::write()).
pub(crate) fn write(path: &Path, bodies: &[(String, BlockMesh)]) -> Result<(), WriteError> {
    let joined = Joined::new(path, bodies)?;
    let (nodes, tets) = (joined.nodes.len(), joined.tets.len());
    if u32::try_from(5 * tets).is_err() {
        let reason = "more tetrahedra than a legacy file has numbers for".into();
        return Err(WriteError::Encode { path: path.to_path_buf(), reason });
    }
    // All numbers are big-endian.
    let mut file =
        b"# vtk DataFile Version 4.2\nmesh of ndda\nBINARY\n\nDATASET UNSTRUCTURED_GRID\n".to_vec();
    let points = joined.nodes.iter().flat_map(|x| [x.x, x.y, x.z]);
    part(&mut file, &format!("POINTS {nodes} double"), points.flat_map(f64::to_be_bytes));
    let cells = joined.tets.iter().flat_map(|tet| [4, tet[0], tet[1], tet[2], tet[3]]);
    part(&mut file, &format!("\nCELLS {tets} {}", 5 * tets), cells.flat_map(u32::to_be_bytes));
    let kinds = std::iter::repeat_n(TETRAHEDRON, tets);
    part(&mut file, &format!("\nCELL_TYPES {tets}"), kinds.flat_map(i32::to_be_bytes));
    file.extend(format!("\nPOINT_DATA {nodes}\n").bytes());
    for (name, set) in &joined.sets {
        let mut flags = vec![0u8; nodes];
        set.iter().for_each(|&node| flags[node as usize] = 1);
        part(&mut file, &scalars(&format!("{SET}{name}"), "unsigned_char"), flags);
    }
    file.extend(format!("\nCELL_DATA {tets}\n").bytes());
    let body = joined.body_of_tets().map(|body| body as i32);
    part(&mut file, &scalars("body", "int"), body.flat_map(i32::to_be_bytes));
    file.push(b'\n');
    atomic::write(path, &file)
}

/// A header and the numbers after it.
fn part(file: &mut Vec<u8>, header: &str, numbers: impl IntoIterator<Item = u8>) {
    file.extend(header.bytes());
    file.push(b'\n');
    file.extend(numbers);
    file.push(b'\n');
}

/// Header of one number per point or cell.
fn scalars(name: &str, kind: &str) -> String {
    // The format ends a name at white space; VTK writes it so.
    let name = name.replace('%', "%25").replace(' ', "%20");
    format!("\nSCALARS {name} {kind} 1\nLOOKUP_TABLE default")
}
