//! Writes meshes as `.vtu` with inline base 64 arrays, which every reader knows.

use std::path::Path;

use ndda_mesh::BlockMesh;

use super::data::{BODY_NAMES, SET, TETRA};
use super::grid::Grid;
use crate::atomic;
use crate::mesh::join::Joined;
use crate::scene::FieldFormat;
use crate::write_error::WriteError;

/// Writes a mesh of tetrahedra as `.vtu`.
///
/// Cell data `body` counts the bodies from 0; their names are the field data `body_names`, one to a line. Each node
/// set is point data `set:name` of 0 and 1.
///
/// # Errors
/// [`WriteError`] for a number that is not finite, a name that cannot be kept, and what the operating system refuses.
pub(crate) fn write(path: &Path, bodies: &[(String, BlockMesh)]) -> Result<(), WriteError> {
    let joined = Joined::new(path, bodies)?;
    let mut grid = Grid::new(joined.nodes.len(), joined.tets.len(), FieldFormat::Base64);
    grid.open("FieldData");
    grid.field_bytes(BODY_NAMES, joined.names.join("\n").as_bytes());
    grid.close("FieldData");
    grid.open_piece();
    grid.open("PointData");
    for (name, nodes) in &joined.sets {
        let mut flags = vec![0; joined.nodes.len()];
        nodes.iter().for_each(|&node| flags[node as usize] = 1);
        grid.bytes(&format!("{SET}{name}"), &flags);
    }
    grid.close("PointData");
    grid.open("CellData");
    grid.integers("body", joined.body_of_tets().map(i64::from));
    grid.close("CellData");
    grid.points(joined.nodes.iter().map(|x| [x.x, x.y, x.z]));
    grid.open("Cells");
    grid.integers("connectivity", joined.tets.as_flattened().iter().map(|&node| i64::from(node)));
    grid.integers("offsets", (1..=joined.tets.len() as i64).map(|tet| 4 * tet));
    grid.bytes("types", &vec![TETRA; joined.tets.len()]);
    grid.close("Cells");
    atomic::write_named(path, &grid.finish())
}
