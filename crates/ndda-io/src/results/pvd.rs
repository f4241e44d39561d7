//! The series of frames: `fields.pvd` lists each `.vtu` with its time, and is the file to open in ParaView.

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use crate::atomic;
use crate::results::folder::OutputFolder;
use crate::results::vtu::{Frame, Topology};
use crate::write_error::WriteError;

/// Writes frames one after the other and keeps the index up to date: a file that is listed is whole.
#[derive(Debug)]
pub struct FieldSeries {
    index: PathBuf,
    frames: PathBuf,
    topology: Topology,
    times_s: Vec<f64>,
    /// Frames that may not be on the disk yet.
    unsynced: Vec<PathBuf>,
}

impl FieldSeries {
    /// Begins a series without frames in `folder`.
    ///
    /// # Errors
    /// [`WriteError::Io`] when the folder of the frames cannot be created.
    pub fn create(folder: &OutputFolder, topology: Topology) -> Result<Self, WriteError> {
        let frames = folder.path().join(OutputFolder::FIELDS_FOLDER);
        fs::create_dir_all(&frames).map_err(WriteError::io("create", &frames))?;
        let index = folder.fields_index();
        Ok(Self { index, frames, topology, times_s: Vec::new(), unsynced: Vec::new() })
    }

    /// Goes on with a series in `folder` after the frames of these times \[s\]; frames after them are replaced as they
    /// come, and not listed before.
    ///
    /// # Errors
    /// [`WriteError::LostFrames`] when one of these frames is not there; [`WriteError::Io`] when the index cannot be
    /// written.
    pub fn resume(folder: &OutputFolder, topology: Topology, times_s: Vec<f64>) -> Result<Self, WriteError> {
        let series = Self { times_s, ..Self::create(folder, topology)? };
        let is_lost = |name: &String| {
            let file = fs::metadata(series.frames.join(name));
            !file.is_ok_and(|file| file.is_file() && file.len() > 0)
        };
        let lost: Vec<String> =
            (0..series.times_s.len()).map(OutputFolder::frame_name).filter(is_lost).collect();
        if !lost.is_empty() {
            return Err(WriteError::LostFrames { folder: series.frames, frames: lost });
        }
        atomic::write(&series.index, series.text().as_bytes())?;
        Ok(series)
    }

    /// Times of the frames so far \[s\].
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// Writes the frame of `time_s` \[s\] as `fields/frame_000012.vtu` and then the index that lists it, both whole; they
    /// are on the disk for good after the next [`sync`](Self::sync).
    ///
    /// # Errors
    /// As [`Frame::encode`], or [`WriteError::Io`]; the index then still lists the frames before.
    ///
    /// # Panics
    /// When times do not increase, and as [`Frame::encode`].
    pub fn push(&mut self, time_s: f64, frame: &Frame) -> Result<(), WriteError> {
        let number = self.times_s.len();
        if !time_s.is_finite() {
            return Err(WriteError::not_finite(&self.index, "timestep", Some(number)));
        }
        if let Some(last) = self.times_s.last() {
            assert!(time_s > *last, "frame at {time_s} s after one at {last} s");
        }
        let path = self.frames.join(OutputFolder::frame_name(number));
        atomic::write_unsynced(&path, &frame.encode(&path, &self.topology)?)?;
        self.times_s.push(time_s);
        let written = atomic::write_unsynced(&self.index, self.text().as_bytes());
        match &written {
            Ok(()) => self.unsynced.push(path),
            Err(_) => drop(self.times_s.pop()),
        }
        written
    }

    /// Waits until all frames and the index are on the disk.
    ///
    /// # Errors
    /// [`WriteError::Io`] when one of them is not.
    pub fn sync(&mut self) -> Result<(), WriteError> {
        if !self.unsynced.is_empty() {
            atomic::sync(&self.unsynced)?;
            atomic::sync(std::slice::from_ref(&self.index))?;
            self.unsynced.clear();
        }
        Ok(())
    }

    /// The index: times in the shortest form that reads back to the same bits, paths relative to the index.
    fn text(&self) -> String {
        let mut text = String::from(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  \
             <Collection>\n",
        );
        for (number, time_s) in self.times_s.iter().enumerate() {
            let file = OutputFolder::frame_name(number);
            writeln!(
                text,
                "    <DataSet timestep=\"{time_s:?}\" part=\"0\" file=\"{}/{file}\"/>",
                OutputFolder::FIELDS_FOLDER
            )
            .expect("writing to memory");
        }
        text.push_str("  </Collection>\n</VTKFile>\n");
        text
    }
}

#[cfg(test)]
mod tests {
    use ndda_mesh::Vec3;

    use super::*;
    use crate::results::testing::one_tet;
    use crate::scene::FieldFormat;

    fn series_in(folder: &std::path::Path) -> (OutputFolder, FieldSeries) {
        let output = OutputFolder::create(folder, false).unwrap();
        let topology = Topology::new(&one_tet(), FieldFormat::default());
        let series = FieldSeries::create(&output, topology).unwrap();
        (output, series)
    }

    #[test]
    fn the_index_lists_whole_files_with_exact_times() {
        let folder = tempfile::tempdir().unwrap();
        let (output, mut series) = series_in(folder.path());
        let blocks = one_tet();
        let frame = Frame::new(&blocks, &blocks.rest_position);
        let times_s = [0.0, 1e-7, 0.1 + 0.2];
        for time_s in times_s {
            series.push(time_s, &frame).unwrap();
        }
        assert_eq!(series.times_s().len(), 3);
        series.sync().unwrap();
        let text = fs::read_to_string(output.fields_index()).unwrap();
        let value = |line: &str, key: &str| {
            let (_, rest) = line.split_once(&format!("{key}=\"")).unwrap();
            rest.split_once('"').unwrap().0.to_owned()
        };
        let entries: Vec<&str> = text.lines().filter(|line| line.contains("<DataSet")).collect();
        for (line, time_s) in entries.iter().zip(times_s) {
            assert_eq!(value(line, "timestep").parse::<f64>().unwrap(), time_s);
            assert!(folder.path().join(value(line, "file")).is_file());
        }
        assert_eq!(entries.len(), 3);
        assert_eq!(value(entries[2], "file"), "fields/frame_000002.vtu");
    }

    #[test]
    fn a_frame_that_cannot_be_written_is_not_listed() {
        let folder = tempfile::tempdir().unwrap();
        let (output, mut series) = series_in(folder.path());
        let blocks = one_tet();
        let good = Frame::new(&blocks, &blocks.rest_position);
        series.push(0.0, &good).unwrap();
        series.push(1.0, &Frame::new(&blocks, &[Vec3::repeat(f64::NAN); 4])).unwrap_err();
        let error = series.push(f64::NAN, &good).unwrap_err();
        assert!(matches!(error, WriteError::NotFinite { index: Some(1), .. }));
        assert_eq!(fs::read_to_string(output.fields_index()).unwrap().matches("<DataSet").count(), 1);
        series.push(1.0, &good).unwrap();
        assert_eq!(series.times_s().len(), 2);
    }
}
