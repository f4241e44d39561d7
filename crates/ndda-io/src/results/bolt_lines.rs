//! Bolts as lines for ParaView: `bolts.pvd` lists a file of lines for each frame.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use crate::atomic;
use crate::mesh::error::{Fault, bytes_of};
use crate::mesh::vtk_file::{self, Data};
use crate::mesh::{FileProblem, MeshFileError};
use crate::results::folder::OutputFolder;
use crate::write_error::WriteError;

/// Number of the line among VTK's cell types.
const LINE: u8 = 3;

/// Name of the file of the lines of a frame: `bolts_000012.vtu`.
pub(super) fn bolts_name(number: usize) -> String {
    format!("bolts_{number:06}.vtu")
}

/// A piece of a bolt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoltLine {
    /// Its ends [m].
    pub ends_m: [[f64; 3]; 2],
    /// Index of the bolt.
    pub bolt: usize,
    /// Index of the block in which it begins.
    pub block: u32,
    /// Tension [N].
    pub axial_n: f64,
    /// Tension over the force at which it yields.
    pub utilisation: f64,
    /// Slip of the grout [m].
    pub slip_m: f64,
    /// State: 0 elastic, 1 debonded, 2 yielding, 3 broken.
    pub state: u8,
}

/// Writes frames of lines one after the other, and the index that lists them.
#[derive(Debug)]
pub struct BoltSeries {
    index: PathBuf,
    frames: PathBuf,
    times_s: Vec<f64>,
}

impl BoltSeries {
    /// Begins a series, or goes on after the frames of these times [s].
    ///
    /// # Errors
    /// [`WriteError::Io`] when the folder of the frames cannot be created.
    pub fn new(folder: &OutputFolder, times_s: Vec<f64>) -> Result<Self, WriteError> {
        let frames = folder.path().join(OutputFolder::FIELDS_FOLDER);
        fs::create_dir_all(&frames).map_err(WriteError::io("create", &frames))?;
        Ok(Self { index: folder.bolts_index(), frames, times_s })
    }

    /// Times of the frames so far [s].
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// Writes the frame of a time [s], then the index.
    ///
    /// # Errors
    /// [`WriteError::Io`] when a file cannot be written.
    pub fn push(&mut self, time_s: f64, lines: &[BoltLine]) -> Result<(), WriteError> {
        let path = self.frames.join(bolts_name(self.times_s.len()));
        atomic::write(&path, file(lines).as_bytes())?;
        self.times_s.push(time_s);
        let written = atomic::write(&self.index, self.list().as_bytes());
        if written.is_err() {
            self.times_s.pop();
        }
        written
    }

    fn list(&self) -> String {
        let mut text = String::from(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n",
        );
        for (k, time_s) in self.times_s.iter().enumerate() {
            let _ = writeln!(
                text,
                "<DataSet timestep=\"{time_s:?}\" file=\"{}/{}\"/>",
                OutputFolder::FIELDS_FOLDER,
                bolts_name(k)
            );
        }
        text + "</Collection>\n</VTKFile>\n"
    }
}

impl BoltLine {
    /// Reads the lines of a frame.
    ///
    /// # Errors
    /// [`MeshFileError`] when the file cannot be read, holds other cells than lines, or lacks an array.
    pub fn read_all(path: &Path) -> Result<Vec<Self>, MeshFileError> {
        let bytes = bytes_of(path)?;
        vtk_file::data(&bytes).and_then(|data| from_data(&data)).map_err(|fault| fault.of(path))
    }
}

fn from_data(data: &Data) -> Result<Vec<BoltLine>, Fault> {
    let unexpected =
        |expected: String, found: String| Fault::from(FileProblem::Unexpected { expected, found });
    let array = |name: &str| {
        let values = data.cell_data.get(name).filter(|values| values.len() == data.kinds.len());
        values
            .ok_or_else(|| unexpected(format!("an array {name} with a number for each line"), "none".into()))
    };
    let (bolt, block, state) = (array("bolt")?, array("block")?, array("state")?);
    let (axial_n, utilisation, slip_m) = (array("axial_n")?, array("utilisation")?, array("slip_m")?);
    let line = |(k, (kind, nodes)): (usize, (u8, &[u32]))| match (kind, nodes) {
        (LINE, &[from, to]) => Ok(BoltLine {
            ends_m: [from, to].map(|node| data.points[node as usize].into()),
            bolt: bolt[k] as usize,
            block: block[k] as u32,
            axial_n: axial_n[k],
            utilisation: utilisation[k],
            slip_m: slip_m[k],
            state: state[k] as u8,
        }),
        _ => Err(unexpected("lines".into(), format!("a cell of VTK's type {kind}"))),
    };
    data.cells().enumerate().map(line).collect()
}

/// Two points and a line for each piece.
fn file(lines: &[BoltLine]) -> String {
    let count = lines.len();
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n\
         <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{count}\">\n<Points>\n",
        2 * count
    );
    let points = lines.iter().flat_map(|line| line.ends_m).flatten();
    array(&mut text, "Float64", "Points", 3, points.map(|x| format!("{x:?}")));
    text.push_str("</Points>\n<Cells>\n");
    array(&mut text, "Int32", "connectivity", 1, (0..2 * count).map(|k| k.to_string()));
    array(&mut text, "Int32", "offsets", 1, (1..=count).map(|k| (2 * k).to_string()));
    array(&mut text, "UInt8", "types", 1, (0..count).map(|_| LINE.to_string()));
    text.push_str("</Cells>\n<CellData>\n");
    array(&mut text, "Int32", "bolt", 1, lines.iter().map(|line| line.bolt.to_string()));
    array(&mut text, "Int32", "block", 1, lines.iter().map(|line| line.block.to_string()));
    array(&mut text, "Float64", "axial_n", 1, lines.iter().map(|line| format!("{:?}", line.axial_n)));
    array(&mut text, "Float64", "utilisation", 1, lines.iter().map(|line| format!("{:?}", line.utilisation)));
    array(&mut text, "Float64", "slip_m", 1, lines.iter().map(|line| format!("{:?}", line.slip_m)));
    array(&mut text, "UInt8", "state", 1, lines.iter().map(|line| line.state.to_string()));
    text + "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"
}

fn array(text: &mut String, kind: &str, name: &str, components: usize, values: impl Iterator<Item = String>) {
    let _ = writeln!(
        text,
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">"
    );
    for value in values {
        text.push_str(&value);
        text.push(' ');
    }
    text.push_str("\n</DataArray>\n");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::ListedFrame;

    fn lines() -> Vec<BoltLine> {
        let line = |k: usize| BoltLine {
            ends_m: [[k as f64, 1.0 / 3.0, -2e6], [k as f64 + 1.0, 0.1 + 0.2, -2e6]],
            bolt: k / 2,
            block: 7 - k as u32,
            axial_n: 1e5 / (k as f64 - 1.5),
            utilisation: 0.1 * k as f64,
            slip_m: 1e-9 * k as f64,
            state: k as u8,
        };
        (0..4).map(line).collect()
    }

    #[test]
    fn lines_that_were_written_are_read_back_and_none_are_none() {
        let folder = tempfile::tempdir().unwrap();
        let output = OutputFolder::create(folder.path(), false).unwrap();
        let mut series = BoltSeries::new(&output, Vec::new()).unwrap();
        series.push(0.0, &[]).unwrap();
        series.push(0.1 + 0.2, &lines()).unwrap();
        let listed = ListedFrame::read_all(&output.bolts_index()).unwrap();
        assert_eq!(listed.iter().map(|frame| frame.time_s).collect::<Vec<_>>(), [0.0, 0.1 + 0.2]);
        assert_eq!(BoltLine::read_all(&listed[0].path).unwrap(), []);
        assert_eq!(BoltLine::read_all(&listed[1].path).unwrap(), lines());
    }

    #[test]
    fn a_frame_whose_index_cannot_be_written_is_none() {
        let folder = tempfile::tempdir().unwrap();
        let output = OutputFolder::create(folder.path(), false).unwrap();
        let mut series = BoltSeries::new(&output, Vec::new()).unwrap();
        // A folder stands where the index goes.
        fs::create_dir(output.bolts_index()).unwrap();
        series.push(0.0, &lines()).unwrap_err();
        assert!(series.times_s().is_empty());
        fs::remove_dir(output.bolts_index()).unwrap();
        series.push(0.0, &lines()).unwrap();
        assert_eq!(ListedFrame::read_all(&output.bolts_index()).unwrap().len(), 1);
    }

    #[test]
    fn damaged_lines_are_errors_with_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bolts_000001.vtu");
        let whole = file(&lines());
        for part in 1..20 {
            fs::write(&path, &whole[..whole.len() * part / 20]).unwrap();
            assert!(
                BoltLine::read_all(&path).unwrap_err().to_string().contains("bolts_000001.vtu"),
                "{part}"
            );
        }
        for (from, to) in [("\"axial_n\"", "\"force\""), ("3 3 3 3", "3 3 1 3"), ("2 4 6 8", "2 4 5 8")] {
            assert!(whole.contains(from), "{from}");
            fs::write(&path, whole.replace(from, to)).unwrap();
            let error = BoltLine::read_all(&path).unwrap_err().to_string();
            assert!(error.contains("bolts_000001.vtu"), "{error}");
        }
    }
}
