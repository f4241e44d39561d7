//! Bolts as lines for ParaView: `bolts.pvd` lists a file of lines for each frame.

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use crate::atomic;
use crate::results::folder::{FIELDS_FOLDER, OutputFolder};
use crate::write_error::WriteError;

/// Name of the file of the lines of a frame: `bolts_000012.vtu`.
pub fn bolts_name(number: usize) -> String {
    format!("bolts_{number:06}.vtu")
}

/// A piece of a bolt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoltLine {
    /// Its ends [m].
    pub ends_m: [[f64; 3]; 2],
    /// Index of the bolt.
    pub bolt: usize,
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
        let frames = folder.path().join(FIELDS_FOLDER);
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
        atomic::write(&self.index, self.list().as_bytes())
    }

    fn list(&self) -> String {
        let mut text = String::from(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n",
        );
        for (k, time_s) in self.times_s.iter().enumerate() {
            let _ = writeln!(
                text,
                "<DataSet timestep=\"{time_s:?}\" file=\"{FIELDS_FOLDER}/{}\"/>",
                bolts_name(k)
            );
        }
        text + "</Collection>\n</VTKFile>\n"
    }
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
    array(&mut text, "UInt8", "types", 1, (0..count).map(|_| "3".to_string()));
    text.push_str("</Cells>\n<CellData>\n");
    array(&mut text, "Int32", "bolt", 1, lines.iter().map(|line| line.bolt.to_string()));
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
