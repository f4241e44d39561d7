//! One frame of fields as a VTK unstructured grid (`.vtu`), the file that ParaView opens.
//!
//! Written by `vtkio`, at the release candidate 0.7.0-rc2: the stable 0.6.3 depends on nom 3.2.1 and
//! quick-xml 0.22, which rustc reports as code that future versions will reject.
//! Arrays are inline binary (base64, 64-bit header, little endian). vtkio cannot write raw appended data:
//! its `Raw` encoding is behind a feature that the crate does not declare.

use std::path::Path;

use ndda_mesh::{BlockSet, Vec3};
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataSet, UnstructuredGridPiece, Version,
    VertexNumbers, Vtk,
};

use crate::atomic;
use crate::write_error::WriteError;

/// The fields of one moment.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Topology, block of each tetrahedron, origin of the coordinates.
    pub blocks: &'a BlockSet,
    /// Position per node \[m\], relative to the origin of `blocks`.
    pub position: &'a [Vec3],
    /// Displacement since the start per node \[m\].
    pub displacement: &'a [Vec3],
    /// Velocity per node [m/s].
    pub velocity: &'a [Vec3],
    /// Cauchy stress per tetrahedron in global axes, tension positive, as xx yy zz xy yz zx \[Pa\].
    pub stress_pa: &'a [[f64; 6]],
}

/// Writes a frame to `path`, replacing an older file whole.
///
/// Points are the positions in the coordinates of the scene file. Per point: `displacement_m`, `velocity_m_s`.
/// Per cell: `block_id` (index into the scene's blocks), `von_mises_pa`, and `stress_pa` with six components
/// in VTK's order of a symmetric tensor, XX YY ZZ XY YZ XZ, which is also ours.
///
/// # Errors
/// [`WriteError::NotFinite`] for the first number that is not finite, before anything is written;
/// [`WriteError::Io`] when the file cannot be written.
///
/// # Panics
/// When there is no block, or an array has not one entry per node or tetrahedron.
pub fn write(path: &Path, frame: &Frame) -> Result<(), WriteError> {
    check_lengths(frame);
    let origin = frame.blocks.origin_m;
    let points = flat(path, "position", frame.position.iter().map(|x| <[f64; 3]>::from(x + origin)))?;
    let displacement = flat(path, "displacement_m", frame.displacement.iter().map(|u| <[f64; 3]>::from(*u)))?;
    let velocity = flat(path, "velocity_m_s", frame.velocity.iter().map(|v| <[f64; 3]>::from(*v)))?;
    let stress = flat(path, "stress_pa", frame.stress_pa.iter().copied())?;
    let von_mises = flat(path, "von_mises_pa", frame.stress_pa.iter().map(|s| [von_mises_pa(s)]))?;
    let block_id: Vec<u32> = frame.blocks.tet_block.iter().map(|block| block.0).collect();

    // The first vectors and scalars are the ones that ParaView's filters offer first.
    let data = Attributes {
        point: vec![
            Attribute::vectors("displacement_m").with_data(displacement),
            Attribute::vectors("velocity_m_s").with_data(velocity),
        ],
        cell: vec![
            Attribute::scalars("von_mises_pa", 1).with_data(von_mises),
            Attribute::generic("block_id", 1).with_data(block_id),
            Attribute::generic("stress_pa", 6).with_data(stress),
        ],
    };
    let piece = UnstructuredGridPiece { points: points.into(), cells: cells(frame.blocks), data };
    let file = Vtk {
        version: Version::new_xml(1, 0),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        file_path: None,
        data: DataSet::inline(piece),
    };
    // Through memory, because vtkio does not pass on what the operating system says.
    let mut content = Vec::new();
    file.write_xml(&mut content)
        .map_err(|e| WriteError::Encode { path: path.to_path_buf(), reason: e.to_string() })?;
    atomic::write(path, &content)
}

/// The von Mises stress √(½ [(xx − yy)² + (yy − zz)² + (zz − xx)²] + 3 [xy² + yz² + zx²]) \[Pa\].
pub fn von_mises_pa(stress_pa: &[f64; 6]) -> f64 {
    let [xx, yy, zz, xy, yz, zx] = *stress_pa;
    let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    let shear = xy * xy + yz * yz + zx * zx;
    (0.5 * normal + 3.0 * shear).sqrt()
}

fn check_lengths(frame: &Frame) {
    assert!(!frame.blocks.is_empty(), "a frame without blocks");
    let nodes = frame.blocks.rest_position.len();
    assert_eq!(frame.position.len(), nodes, "positions per node");
    assert_eq!(frame.displacement.len(), nodes, "displacements per node");
    assert_eq!(frame.velocity.len(), nodes, "velocities per node");
    assert_eq!(frame.stress_pa.len(), frame.blocks.tets.len(), "stresses per tetrahedron");
}

/// All components one after the other, or the index of the first entry that is not finite.
fn flat<const N: usize>(
    path: &Path,
    array: &str,
    entries: impl ExactSizeIterator<Item = [f64; N]>,
) -> Result<Vec<f64>, WriteError> {
    let mut numbers = Vec::with_capacity(N * entries.len());
    for (index, entry) in entries.enumerate() {
        if !entry.iter().all(|x| x.is_finite()) {
            return Err(WriteError::not_finite(path, array, Some(index)));
        }
        numbers.extend(entry);
    }
    Ok(numbers)
}

fn cells(blocks: &BlockSet) -> Cells {
    let connectivity = blocks.tets.iter().flatten().map(|node| u64::from(node.0)).collect();
    let offsets = (1..=blocks.tets.len() as u64).map(|tet| 4 * tet).collect();
    Cells {
        cell_verts: VertexNumbers::XML { connectivity, offsets },
        types: vec![CellType::Tetra; blocks.tets.len()],
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use ndda_mesh::BlockMesh;
    use vtkio::model::{DataArray, Piece};

    use super::*;

    fn two_tets_at(x: f64) -> BlockSet {
        let corners = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)];
        let at = |x0: f64| BlockMesh {
            nodes: corners.map(|(x, y, z)| Vec3::new(x0 + x, y, z)).to_vec(),
            tets: vec![[0, 1, 2, 3]],
            ..BlockMesh::default()
        };
        BlockSet::new(vec![("a".into(), at(x)), ("b".into(), at(x + 2.0))]).unwrap()
    }

    fn read_back(path: &Path) -> UnstructuredGridPiece {
        let DataSet::UnstructuredGrid { mut pieces, .. } = Vtk::import(path).unwrap().data else {
            panic!("not an unstructured grid");
        };
        let Piece::Inline(piece) = pieces.remove(0) else { panic!("not inline") };
        *piece
    }

    fn array(attributes: &[Attribute], name: &str) -> DataArray {
        let found = attributes.iter().find(|a| a.name() == name).unwrap();
        let Attribute::DataArray(array) = found else { panic!("{name} is no data array") };
        array.clone()
    }

    #[test]
    fn what_is_written_is_read_back_bit_by_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.vtu");
        let blocks = two_tets_at(4.5e6);
        let displacement: Vec<Vec3> =
            (0..8).map(|i| Vec3::new(0.1 * f64::from(i), 1e-300, -1.0 / 3.0)).collect();
        let position: Vec<Vec3> =
            blocks.rest_position.iter().zip(&displacement).map(|(x, u)| x + u).collect();
        let velocity = vec![Vec3::new(1.0, 2.0, 3.0); 8];
        let stress_pa = [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [0.0; 6]];
        let frame = Frame {
            blocks: &blocks,
            position: &position,
            displacement: &displacement,
            velocity: &velocity,
            stress_pa: &stress_pa,
        };
        write(&path, &frame).unwrap();

        let piece = read_back(&path);
        let points: Vec<f64> = piece.points.cast_into().unwrap();
        assert_eq!(points[0], position[0].x + blocks.origin_m.x);
        assert!((points[0] - 4.5e6).abs() < 1.0);
        assert_eq!(piece.cells.types, [CellType::Tetra; 2]);
        let u: Vec<f64> = array(&piece.data.point, "displacement_m").data.cast_into().unwrap();
        assert_eq!(u, displacement.iter().flat_map(|u| [u.x, u.y, u.z]).collect::<Vec<_>>());
        let s = array(&piece.data.cell, "stress_pa");
        assert_eq!(s.num_comp(), 6);
        assert_eq!(s.data.cast_into::<f64>().unwrap(), stress_pa.concat());
        let ids: Vec<u32> = array(&piece.data.cell, "block_id").data.cast_into().unwrap();
        assert_eq!(ids, [0, 1]);
    }

    #[test]
    fn the_arrays_are_binary() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.vtu");
        let blocks = two_tets_at(0.0);
        let zero = vec![Vec3::zeros(); 8];
        let (position, stress_pa) = (&blocks.rest_position, &[[0.0; 6]; 2]);
        write(&path, &Frame { blocks: &blocks, position, displacement: &zero, velocity: &zero, stress_pa })
            .unwrap();
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains("format=\"binary\"") && !text.contains("format=\"ascii\""));
    }

    #[test]
    fn a_number_that_is_not_finite_is_refused_before_writing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.vtu");
        let blocks = two_tets_at(0.0);
        let zero = vec![Vec3::zeros(); 8];
        let mut velocity = zero.clone();
        velocity[5].z = f64::NAN;
        let (position, stress_pa) = (&blocks.rest_position, &[[0.0; 6]; 2]);
        let frame = Frame { blocks: &blocks, position, displacement: &zero, velocity: &velocity, stress_pa };
        let error = write(&path, &frame).unwrap_err();
        assert!(
            matches!(&error, WriteError::NotFinite { array, index: Some(5), .. } if array == "velocity_m_s")
        );

        let overflow = &[[0.0; 6], [1e200, 0.0, 0.0, 0.0, 0.0, 0.0]];
        let frame = Frame { velocity: &zero, stress_pa: overflow, ..frame };
        let error = write(&path, &frame).unwrap_err();
        assert!(
            matches!(&error, WriteError::NotFinite { array, index: Some(1), .. } if array == "von_mises_pa")
        );
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn von_mises_is_the_axial_stress_in_tension_and_root_three_times_pure_shear() {
        assert_eq!(von_mises_pa(&[7.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 7.0);
        assert_eq!(von_mises_pa(&[5.0, 5.0, 5.0, 0.0, 0.0, 0.0]), 0.0);
        assert!((von_mises_pa(&[0.0, 0.0, 0.0, 0.0, 2.0, 0.0]) - 2.0 * 3f64.sqrt()).abs() < 1e-15);
    }
}
