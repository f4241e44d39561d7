//! Frames of fields, and the list of them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use ndda_mesh::Vec3;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use crate::mesh::error::{Fault, bytes_of};
use crate::mesh::vtk_file::{self, Array, Data, TETRA};
use crate::mesh::{FileProblem, MeshFileError};

/// An entry of `fields.pvd`.
#[derive(Clone, Debug, PartialEq)]
pub struct ListedFrame {
    /// Its time [s].
    pub time_s: f64,
    /// Its file.
    pub path: PathBuf,
}

/// One moment: tetrahedra where they were, and their fields by name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FieldFrame {
    /// Positions [m].
    pub points: Vec<Vec3>,
    /// Tetrahedra, all nodes among the points.
    pub tets: Vec<[u32; 4]>,
    /// Arrays with one entry per point.
    pub point_data: BTreeMap<String, Array>,
    /// Arrays with one entry per tetrahedron.
    pub cell_data: BTreeMap<String, Array>,
}

impl ListedFrame {
    /// Reads `fields.pvd`: the frames in the order of the list.
    ///
    /// # Errors
    /// [`MeshFileError`] when it cannot be read, or an entry has no file or no time.
    pub fn read_all(path: &Path) -> Result<Vec<Self>, MeshFileError> {
        let bytes = bytes_of(path)?;
        let folder = path.parent().unwrap_or(Path::new("."));
        let mut reader = Reader::from_reader(bytes.as_slice());
        let mut frames = Vec::new();
        loop {
            let event = reader.read_event();
            let broken = |e: quick_xml::Error| unexpected("XML", &e.to_string()).of(path);
            match event.map_err(broken)? {
                Event::Eof => return Ok(frames),
                Event::Start(start) | Event::Empty(start) if start.local_name().as_ref() == b"DataSet" => {
                    frames.push(listed(&start, folder).map_err(|fault| fault.of(path))?);
                }
                _ => {}
            }
        }
    }
}

fn listed(entry: &BytesStart, folder: &Path) -> Result<ListedFrame, Fault> {
    let text = |name: &str| {
        let attribute = entry.try_get_attribute(name).ok().flatten();
        let value = attribute.and_then(|a| a.unescape_value().ok().map(|value| value.into_owned()));
        value.ok_or_else(|| unexpected(&format!("an entry with {name}"), "none"))
    };
    let timestep = text("timestep")?;
    let time_s = timestep.parse().ok().filter(|t: &f64| t.is_finite());
    let time_s = time_s.ok_or_else(|| unexpected("a time", &timestep))?;
    Ok(ListedFrame { time_s, path: folder.join(text("file")?) })
}

fn unexpected(expected: &str, found: &str) -> Fault {
    FileProblem::Unexpected { expected: expected.into(), found: found.into() }.into()
}

impl FieldFrame {
    /// Reads a frame.
    ///
    /// # Errors
    /// [`MeshFileError`] when it cannot be read, or holds other cells than tetrahedra.
    pub fn read(path: &Path) -> Result<Self, MeshFileError> {
        let bytes = bytes_of(path)?;
        vtk_file::data(&bytes).and_then(from_data).map_err(|fault| fault.of(path))
    }
}

fn from_data(data: Data) -> Result<FieldFrame, Fault> {
    let mut tets = Vec::with_capacity(data.kinds.len());
    for (kind, nodes) in data.cells() {
        match (kind, nodes) {
            (TETRA, &[a, b, c, d]) => tets.push([a, b, c, d]),
            _ => return Err(unexpected("tetrahedra", &format!("a cell of VTK's type {kind}"))),
        }
    }
    if tets.is_empty() {
        return Err(FileProblem::NoTetrahedra.into());
    }
    Ok(FieldFrame {
        points: data.points,
        tets,
        point_data: joined(data.point_data, data.point_arrays),
        cell_data: joined(data.cell_data, data.cell_arrays),
    })
}

fn joined(
    scalars: BTreeMap<String, Vec<f64>>,
    mut others: BTreeMap<String, Array>,
) -> BTreeMap<String, Array> {
    others.extend(scalars.into_iter().map(|(name, values)| (name, Array { components: 1, values })));
    others
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::testing::one_tet;
    use crate::results::vtu::{Topology, Values};
    use crate::scene::{FieldFormat, Precision};
    use crate::{FieldSeries, Frame, OutputFolder};

    #[test]
    fn frames_that_were_written_are_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let output = OutputFolder::create(folder.path(), false).unwrap();
        let blocks = one_tet();
        let topology = Topology::new(&blocks, FieldFormat::default()).with_blocks(&blocks);
        let mut series = FieldSeries::create(&output, topology).unwrap();
        let velocity = [Vec3::new(1.0, -2.0, 1.0 / 3.0); 4];
        for time_s in [0.0, 0.1 + 0.2] {
            let mut frame = Frame::new(&blocks, &blocks.rest_position);
            frame.add_points(Values::vectors("velocity_m_s", velocity.iter().copied(), Precision::F64));
            let stress = [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]];
            frame.add_cells(Values::new("stress_pa", stress.into_iter(), Precision::F64));
            series.push(time_s, &frame).unwrap();
        }
        let listed = ListedFrame::read_all(&output.fields_index()).unwrap();
        assert_eq!(listed.iter().map(|f| f.time_s).collect::<Vec<_>>(), [0.0, 0.1 + 0.2]);
        let read = FieldFrame::read(&listed[1].path).unwrap();
        assert_eq!(read.points, blocks.rest_position);
        assert_eq!(read.tets, [[0, 1, 2, 3]]);
        let found = &read.point_data["velocity_m_s"];
        assert_eq!((found.components, &found.values[9..]), (3, &[1.0, -2.0, 1.0 / 3.0][..]));
        assert_eq!(read.cell_data["stress_pa"].values, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(read.cell_data["block_id"], Array { components: 1, values: vec![0.0] });
    }

    #[test]
    fn a_list_without_times_and_a_frame_cut_short_are_errors_with_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let index = folder.path().join("fields.pvd");
        for entry in
            ["<DataSet file=\"a.vtu\"/>", "<DataSet timestep=\"x\" file=\"a.vtu\"/>", "<DataSet timestep"]
        {
            std::fs::write(&index, format!("<VTKFile><Collection>{entry}</Collection></VTKFile>")).unwrap();
            let error = ListedFrame::read_all(&index).unwrap_err().to_string();
            assert!(error.contains("fields.pvd"), "{error}");
        }
        let path = folder.path().join("frame.vtu");
        let blocks = one_tet();
        let topology = Topology::new(&blocks, FieldFormat::default()).with_blocks(&blocks);
        let whole = Frame::new(&blocks, &blocks.rest_position).encode(&path, &topology).unwrap();
        for part in 1..20 {
            std::fs::write(&path, &whole[..whole.len() * part / 20]).unwrap();
            let error = FieldFrame::read(&path).unwrap_err().to_string();
            assert!(error.contains("frame.vtu"), "{error}");
        }
    }
}
