//! Blocks of a cut as polyhedra, VTK's cell type 42.

use std::path::Path;

use ndda_mesh::cut::Blocks;

use super::grid::Grid;
use crate::atomic;
use crate::scene::FieldFormat;
use crate::write_error::WriteError;

/// Number of the polyhedron among VTK's cell types.
const POLYHEDRON: u8 = 42;

/// Writes blocks as polyhedra to a `.vtu`, with cell data `block` and `volume_m3`; nodes are not shared.
///
/// # Errors
/// [`WriteError`] for a number that is not finite, and what the operating system refuses.
pub fn write(path: &Path, blocks: &Blocks) -> Result<(), WriteError> {
    let points = || blocks.blocks.iter().flat_map(|block| &block.vertices);
    if let Some(index) = points().position(|x| !x.iter().all(|c| c.is_finite())) {
        return Err(WriteError::not_finite(path, "vertex", Some(index)));
    }
    let count = blocks.blocks.len();
    let mut grid = Grid::new(points().count(), count, FieldFormat::Base64);
    grid.open_piece();
    grid.open("CellData");
    grid.integers("block", 0..count as i64);
    grid.reals("volume_m3", blocks.blocks.iter().map(|block| block.volume_m3()));
    grid.close("CellData");
    grid.points(points().map(|x| [x.x, x.y, x.z]));

    let (mut ends, mut faces, mut face_ends, mut first) = (Vec::new(), Vec::new(), Vec::new(), 0);
    for block in &blocks.blocks {
        faces.push(block.faces.len() as i64);
        for face in &block.faces {
            faces.push(face.vertices.len() as i64);
            faces.extend(face.vertices.iter().map(|&vertex| first + i64::from(vertex)));
        }
        first += block.vertices.len() as i64;
        ends.push(first);
        face_ends.push(faces.len() as i64);
    }
    grid.open("Cells");
    grid.integers("connectivity", 0..first);
    grid.integers("offsets", ends.into_iter());
    grid.bytes("types", &vec![POLYHEDRON; count]);
    grid.integers("faces", faces.into_iter());
    grid.integers("faceoffsets", face_ends.into_iter());
    grid.close("Cells");
    atomic::write_named(path, &grid.finish())
}
