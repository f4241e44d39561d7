//! Records of ground motion: a CSV file with the columns `time_s` and `acceleration_m_s2`.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::{csv_text, limited};

/// Why a record cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// It is no table, or a row is not two numbers.
    #[error("{}: {fault}", file.display())]
    Table {
        /// The file.
        file: PathBuf,
        /// The problem, with its line.
        fault: String,
    },
    /// The file cannot be read.
    #[error("{} cannot be read: {source}", file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// The problem.
        source: std::io::Error,
    },
    /// Values that are no record.
    #[error("{}, row {row}: {reason}", file.display())]
    Row {
        /// The file.
        file: PathBuf,
        /// Row of data, the first being 1.
        row: usize,
        /// The problem.
        reason: &'static str,
    },
}

/// Speed of light [m/s]: no ground moves faster, and far above it squares of speeds are no numbers any more.
const LIGHT_M_S: f64 = 299_792_458.0;

#[derive(Deserialize)]
struct Row {
    time_s: f64,
    acceleration_m_s2: f64,
}

/// Times [s] and accelerations [m/s²] of a record.
///
/// # Errors
/// [`RecordError`] naming file and row.
pub fn read(file: &Path) -> Result<Vec<(f64, f64)>, RecordError> {
    let broken = |error| RecordError::Table { file: file.to_path_buf(), fault: csv_text::in_words(&error) };
    let unreadable = |source| RecordError::Unreadable { file: file.to_path_buf(), source };
    let bytes = limited::file(file).map_err(unreadable)?;
    let mut reader = csv_text::reader(&bytes);
    if let Some(fault) = csv_text::fault_of_header(reader.headers().map_err(&broken)?) {
        return Err(RecordError::Table { file: file.to_path_buf(), fault });
    }
    let mut rows: Vec<(f64, f64)> = Vec::new();
    let wrong = |row: usize, reason| RecordError::Row { file: file.to_path_buf(), row, reason };
    for row in reader.deserialize() {
        let Row { time_s, acceleration_m_s2 } = row.map_err(broken)?;
        if !(time_s.is_finite() && acceleration_m_s2.is_finite()) {
            return Err(wrong(rows.len() + 1, "a value is not a number"));
        }
        match rows.last() {
            None if time_s < 0.0 => {
                return Err(wrong(1, "is before the start of the run: begin at 0 s or later"));
            }
            Some(last) if time_s <= last.0 => {
                return Err(wrong(
                    rows.len() + 1,
                    "is not later than the row before: sort the rows by time_s",
                ));
            }
            _ => rows.push((time_s, acceleration_m_s2)),
        }
    }
    if rows.len() < 2 {
        return Err(wrong(rows.len(), "is the last: a record has at least two rows"));
    }
    Ok(rows)
}

/// Holds the speed that a record times `factor` brings, acceleration being linear between rows, against that of light.
///
/// # Errors
/// [`RecordError::Row`] of the first row that is beyond it.
pub fn check_speed(file: &Path, rows: &[(f64, f64)], factor: f64) -> Result<(), RecordError> {
    let mut speed_m_s = 0.0;
    for (row, pair) in (2..).zip(rows.windows(2)) {
        let [(from_s, a), (to_s, b)] = [pair[0], pair[1]];
        speed_m_s += factor * (0.5 * a + 0.5 * b) * (to_s - from_s);
        // NaN is beyond the limit, too.
        if speed_m_s.is_nan() || speed_m_s.abs() > LIGHT_M_S {
            let reason = "brings the ground beyond the speed of light: give accelerations in m/s², or a smaller factor";
            return Err(RecordError::Row { file: file.to_path_buf(), row, reason });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<Vec<(f64, f64)>, String> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("quake.csv");
        std::fs::write(&file, text).unwrap();
        read(&file).map_err(|error| error.to_string())
    }

    #[test]
    fn a_record_is_read_with_comments_and_spaces() {
        let text = "# Somewhere, 1 January\ntime_s, acceleration_m_s2\n0, 0.5\n0.01, -1e-1\n";
        assert_eq!(read_text(text), Ok(vec![(0.0, 0.5), (0.01, -0.1)]));
    }

    #[test]
    fn what_is_no_record_is_refused_with_its_row() {
        for (text, word) in [
            ("time_s,acceleration_m_s2\n0,1\n0,2\n", "row 2"),
            ("time_s,acceleration_m_s2\n-1,1\n0,2\n", "row 1"),
            ("time_s,acceleration_m_s2\n0,1\n", "two rows"),
            ("time_s,acceleration_m_s2\n0,NaN\n1,1\n", "row 1"),
            ("time_s,acceleration_m_s2\n0,x\n", "line"),
            ("t,a\n0,1\n1,1\n", "time_s"),
        ] {
            let message = read_text(text).unwrap_err();
            assert!(message.contains(word), "{text:?}: {message}");
        }
        assert!(read(Path::new("no/such.csv")).is_err());
    }

    #[test]
    fn a_record_that_no_ground_can_follow_is_refused_with_its_row() {
        let check = |rows: &[(f64, f64)], factor| {
            check_speed(Path::new("quake.csv"), rows, factor).map_err(|error| error.to_string())
        };
        assert_eq!(check(&[(0.0, 9.8), (1.0, -9.8), (2.0, 3.0)], 1.0), Ok(()));
        for (rows, factor) in [
            ([(0.0, 0.0), (0.01, 1.0), (0.02, 1e308)], 1.0),
            ([(0.0, 0.0), (0.01, 1.0), (0.02, -1e200)], 1.0),
            ([(0.0, 0.0), (0.01, 0.0), (0.02, 1.0)], 1e300),
            ([(0.0, 0.0), (0.01, 0.0), (0.02, 1e308)], 1e308),
        ] {
            let message = check(&rows, factor).unwrap_err();
            assert!(message.contains("quake.csv, row 3: brings the ground"), "{message}");
        }
    }
}
