//! The history: one row of numbers per recorded step, as CSV that grows while the run goes on.

use std::collections::HashSet;
use std::fmt::Write as _;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::write_error::WriteError;

/// Rows wait in memory no longer than this before the next one pushes them out.
const FLUSH_INTERVAL: Duration = Duration::from_secs(1);

/// A table that is written row by row.
#[derive(Debug)]
pub struct History {
    path: PathBuf,
    columns: Vec<String>,
    writer: csv::Writer<File>,
    number: String,
    rows: usize,
    flushed: Instant,
}

impl History {
    /// Begins the table at `path` with its header; an older file is replaced.
    ///
    /// # Errors
    /// [`WriteError::DuplicateColumn`] when two columns have one name; [`WriteError::Io`] when the file cannot be
    /// written.
    ///
    /// # Panics
    /// When there is no column.
    pub fn create(path: &Path, columns: &[String]) -> Result<Self, WriteError> {
        assert!(!columns.is_empty(), "a table without columns");
        let mut seen = HashSet::new();
        if let Some(column) = columns.iter().find(|name| !seen.insert(*name)) {
            return Err(WriteError::DuplicateColumn { path: path.to_path_buf(), column: column.clone() });
        }
        let file = File::create(path).map_err(WriteError::io("create", path))?;
        let mut history = Self {
            path: path.to_path_buf(),
            columns: columns.to_vec(),
            writer: csv::Writer::from_writer(file),
            number: String::new(),
            rows: 0,
            flushed: Instant::now(),
        };
        history.writer.write_record(columns).map_err(|e| history.csv_error(e))?;
        history.flush()?;
        Ok(history)
    }

    /// Adds a row, one value per column.
    ///
    /// Each value is written in the shortest form that reads back to the same bits, so equal bits give equal bytes.
    ///
    /// # Errors
    /// [`WriteError::NotFinite`] with the column's name and the row's index, the row being left out;
    /// [`WriteError::Io`] when the file cannot be written.
    ///
    /// # Panics
    /// When there is not one value per column.
    pub fn push(&mut self, values: &[f64]) -> Result<(), WriteError> {
        assert_eq!(values.len(), self.columns.len(), "values per row");
        if let Some(column) = values.iter().position(|value| !value.is_finite()) {
            return Err(WriteError::not_finite(&self.path, &self.columns[column], Some(self.rows)));
        }
        for value in values {
            self.number.clear();
            write!(self.number, "{value:?}").expect("writing to memory");
            self.writer.write_field(&self.number).map_err(|e| self.csv_error(e))?;
        }
        self.writer.write_record(None::<&[u8]>).map_err(|e| self.csv_error(e))?;
        self.rows += 1;
        if self.flushed.elapsed() >= FLUSH_INTERVAL { self.flush() } else { Ok(()) }
    }

    /// Hands all rows to the operating system.
    ///
    /// # Errors
    /// [`WriteError::Io`] when it does not take them.
    pub fn flush(&mut self) -> Result<(), WriteError> {
        self.flushed = Instant::now();
        self.writer.flush().map_err(WriteError::io("write", &self.path))
    }

    /// Ends the table and waits until it is on the disk. A table that is only dropped is complete too unless the
    /// disk is full, which then nobody hears of.
    ///
    /// # Errors
    /// [`WriteError::Io`] when the last rows cannot be written.
    pub fn finish(mut self) -> Result<(), WriteError> {
        self.flush()?;
        let Self { path, writer, .. } = self;
        let file = writer.into_inner().map_err(|e| WriteError::io("write", &path)(e.into_error()))?;
        file.sync_all().map_err(WriteError::io("sync", &path))
    }

    /// Number of rows so far.
    pub fn rows(&self) -> usize {
        self.rows
    }

    fn csv_error(&self, error: csv::Error) -> WriteError {
        let source = match error.into_kind() {
            csv::ErrorKind::Io(source) => source,
            other => io::Error::other(format!("{other:?}")),
        };
        WriteError::io("write", &self.path)(source)
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use proptest::prelude::*;

    use super::*;

    fn columns(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| name.to_string()).collect()
    }

    #[test]
    fn a_table_is_a_header_and_shortest_numbers() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        let mut history = History::create(&path, &columns(&["time_s", "block, left"])).unwrap();
        history.push(&[0.0, -0.0]).unwrap();
        history.push(&[0.1 + 0.2, 1e-300]).unwrap();
        assert_eq!(history.rows(), 2);
        history.finish().unwrap();
        let text = fs::read_to_string(&path).unwrap();
        assert_eq!(text, "time_s,\"block, left\"\n0.0,-0.0\n0.30000000000000004,1e-300\n");
    }

    #[test]
    fn a_row_with_a_number_that_is_not_finite_is_left_out_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        let mut history = History::create(&path, &columns(&["time_s", "energy_j"])).unwrap();
        history.push(&[0.0, 1.0]).unwrap();
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let error = history.push(&[1.0, bad]).unwrap_err();
            assert!(
                matches!(&error, WriteError::NotFinite { array, index: Some(1), .. } if array == "energy_j")
            );
        }
        history.finish().unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "time_s,energy_j\n0.0,1.0\n");
    }

    #[test]
    fn two_columns_of_one_name_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        let error = History::create(&path, &columns(&["a", "b", "a"])).unwrap_err();
        assert!(matches!(&error, WriteError::DuplicateColumn { column, .. } if column == "a"));
        assert!(!path.exists());
    }

    #[test]
    fn the_header_and_flushed_rows_can_be_read_during_the_run() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        let mut history = History::create(&path, &columns(&["time_s"])).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "time_s\n");
        history.push(&[0.5]).unwrap();
        history.flush().unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "time_s\n0.5\n");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_reported_with_the_cure() {
        let error = History::create(Path::new("/dev/full"), &columns(&["time_s"])).unwrap_err().to_string();
        assert!(
            error.starts_with("cannot write /dev/full: ") && error.contains("free some space"),
            "{error}"
        );
    }

    proptest! {
        #[test]
        fn any_finite_number_reads_back_to_the_same_bits(bits in prop::collection::vec(any::<u64>(), 1..20)) {
            let values: Vec<f64> = bits.into_iter().map(f64::from_bits).filter(|x| x.is_finite()).collect();
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("history.csv");
            let mut history = History::create(&path, &columns(&["x"])).unwrap();
            for value in &values {
                history.push(&[*value]).unwrap();
            }
            history.finish().unwrap();
            let text = fs::read_to_string(&path).unwrap();
            let read: Vec<u64> = text.lines().skip(1).map(|x| x.parse::<f64>().unwrap().to_bits()).collect();
            prop_assert_eq!(read, values.iter().map(|x| x.to_bits()).collect::<Vec<_>>());
        }
    }
}
