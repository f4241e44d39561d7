//! The history: one row of numbers per recorded step, as CSV that grows while the run goes on.

use std::collections::HashSet;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, Seek, SeekFrom};
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

    /// Goes on with the table at `path` after its first `rows` rows; later ones are cut off.
    ///
    /// # Errors
    /// [`WriteError::NotThatTable`] when it has other columns or fewer rows; [`WriteError::Io`] when it cannot be read
    /// or written.
    pub fn resume(path: &Path, columns: &[String], rows: usize) -> Result<Self, WriteError> {
        let mismatch = |what: String| WriteError::NotThatTable { path: path.to_path_buf(), what };
        let mut table = csv::ReaderBuilder::new()
            .has_headers(false)
            .from_path(path)
            .map_err(|e| WriteError::io("read", path)(io::Error::other(e)))?;
        let mut record = csv::ByteRecord::new();
        let mut found = 0;
        let mut end = 0;
        while found <= rows && table.read_byte_record(&mut record).unwrap_or(false) {
            let same = record.iter().eq(columns.iter().map(String::as_bytes));
            if found == 0 && !same {
                return Err(mismatch("other columns".to_owned()));
            }
            found += 1;
            end = table.position().byte();
        }
        if found <= rows {
            return Err(mismatch(format!("{} rows, not {rows}", found.max(1) - 1)));
        }
        let mut file = File::options().write(true).open(path).map_err(WriteError::io("open", path))?;
        file.set_len(end).map_err(WriteError::io("cut", path))?;
        file.seek(SeekFrom::End(0)).map_err(WriteError::io("open", path))?;
        Ok(Self {
            path: path.to_path_buf(),
            columns: columns.to_vec(),
            writer: csv::Writer::from_writer(file),
            number: String::new(),
            rows,
            flushed: Instant::now(),
        })
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
        self.push_with_text(values, &[])
    }

    /// The same, with text in the last columns.
    ///
    /// # Errors
    /// As [`push`](Self::push).
    ///
    /// # Panics
    /// As [`push`](Self::push).
    pub fn push_with_text(&mut self, values: &[f64], text: &[&str]) -> Result<(), WriteError> {
        assert_eq!(values.len() + text.len(), self.columns.len(), "values per row");
        if let Some(column) = values.iter().position(|value| !value.is_finite()) {
            return Err(WriteError::not_finite(&self.path, &self.columns[column], Some(self.rows)));
        }
        for value in values {
            self.number.clear();
            write!(self.number, "{value:?}").expect("writing to memory");
            self.writer.write_field(&self.number).map_err(|e| self.csv_error(e))?;
        }
        for text in text {
            self.writer.write_field(text).map_err(|e| self.csv_error(e))?;
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

    /// Waits until all rows are on the disk.
    ///
    /// # Errors
    /// [`WriteError::Io`] when they are not.
    pub fn sync(&mut self) -> Result<(), WriteError> {
        self.flush()?;
        self.writer.get_ref().sync_data().map_err(WriteError::io("sync", &self.path))
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
    fn a_table_goes_on_after_the_rows_that_count() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        let names = columns(&["time_s", "block, left"]);
        let mut history = History::create(&path, &names).unwrap();
        (0..5).for_each(|i| history.push(&[f64::from(i), 1.5]).unwrap());
        history.finish().unwrap();
        let mut text = fs::read_to_string(&path).unwrap();
        text.push_str("5.0,");
        fs::write(&path, &text).unwrap();
        let mut history = History::resume(&path, &names, 2).unwrap();
        history.push(&[7.0, 2.5]).unwrap();
        assert_eq!(history.rows(), 3);
        history.finish().unwrap();
        let expected = "time_s,\"block, left\"\n0.0,1.5\n1.0,1.5\n7.0,2.5\n";
        assert_eq!(fs::read_to_string(&path).unwrap(), expected);
        let other = History::resume(&path, &columns(&["time_s", "right"]), 2);
        assert!(matches!(other, Err(WriteError::NotThatTable { .. })));
        assert!(matches!(History::resume(&path, &names, 4), Err(WriteError::NotThatTable { .. })));
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
