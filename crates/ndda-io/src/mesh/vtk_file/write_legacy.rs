//! Writes meshes as legacy `.vtk` (binary) by the crate `vtkio`, for programs that read no XML.

use std::path::Path;

use ndda_mesh::BlockMesh;
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataArray, DataSet, IOBuffer, Piece,
    UnstructuredGridPiece, Version, VertexNumbers, Vtk,
};

use super::data::SET;
use crate::atomic;
use crate::mesh::join::Joined;
use crate::write_error::WriteError;

/// Writes a mesh of tetrahedra as legacy `.vtk`: cell data `body` counts the bodies from 0, whose names the format cannot keep; each node
/// set is point data `set:name` of 0 and 1.
///
/// # Errors
/// As [`write`](super::write()).
pub(crate) fn write(path: &Path, bodies: &[(String, BlockMesh)]) -> Result<(), WriteError> {
    let joined = Joined::new(path, bodies)?;
    let refuse = |reason: String| WriteError::Encode { path: path.to_path_buf(), reason };
    let vertices = joined.tets.iter().flat_map(|tet| [4, tet[0], tet[1], tet[2], tet[3]]).collect();
    let num_cells =
        u32::try_from(joined.tets.len()).map_err(|_| refuse("more than 2³² tetrahedra".into()))?;
    let set = |(name, nodes): (&&str, &Vec<u32>)| {
        let mut flags = vec![0u8; joined.nodes.len()];
        nodes.iter().for_each(|&node| flags[node as usize] = 1);
        field(&format!("{SET}{name}"), IOBuffer::from(flags))
    };
    let body: Vec<i32> = joined.body_of_tets().map(|body| body as i32).collect();
    let piece = UnstructuredGridPiece {
        points: joined.nodes.iter().flat_map(|x| [x.x, x.y, x.z]).collect::<Vec<f64>>().into(),
        cells: Cells {
            cell_verts: VertexNumbers::Legacy { num_cells, vertices },
            types: vec![CellType::Tetra; joined.tets.len()],
        },
        data: Attributes {
            point: joined.sets.iter().map(set).collect(),
            cell: vec![field("body", IOBuffer::from(body))],
        },
    };
    let file = Vtk {
        version: Version::new_legacy(4, 2),
        title: "mesh of ndda".into(),
        byte_order: ByteOrder::BigEndian,
        file_path: None,
        data: DataSet::UnstructuredGrid { meta: None, pieces: vec![Piece::Inline(Box::new(piece))] },
    };
    let mut bytes = Vec::new();
    file.write_legacy(&mut bytes).map_err(|error| refuse(format!("vtkio: {error:?}")))?;
    atomic::write_named(path, &bytes)
}

/// One number per point or cell.
fn field(name: &str, values: IOBuffer) -> Attribute {
    // The format ends a name at white space; VTK writes it so.
    let name = name.replace('%', "%25").replace(' ', "%20");
    Attribute::DataArray(DataArray { data: values, ..DataArray::scalars(name, 1) })
}
