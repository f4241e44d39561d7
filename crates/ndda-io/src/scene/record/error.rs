//! Why a record cannot be used.

use std::path::PathBuf;

use super::MOST_ROWS;

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
    /// A spacing that leaves too few rows or makes too many.
    #[error(
        "{}: `resample_s` (--resample), or the shortest spacing of {given} rows, would make {rows} rows: give a spacing that makes between 2 and {MOST_ROWS}", file.display()
    )]
    Spacing {
        /// The file.
        file: PathBuf,
        /// Rows that it would have.
        rows: usize,
        /// Rows that it has.
        given: usize,
    },
    /// A filter so slow that the quiet that it needs before and after the record takes too many rows.
    #[error(
        "{}: a corner of {slowest_hz:e} Hz is too low for this record: give at least {least_hz:.1e} Hz, or a low corner of 0, which lets low frequencies pass", file.display()
    )]
    Filter {
        /// The file.
        file: PathBuf,
        /// The low corner, or the high one if that is all there is [Hz].
        slowest_hz: f64,
        /// The lowest corner that is possible [Hz].
        least_hz: f64,
    },
    /// Values that are no record.
    #[error("{}: line {line} {reason}", file.display())]
    Line {
        /// The file.
        file: PathBuf,
        /// Line of the file, the first being 1.
        line: u64,
        /// The problem.
        reason: &'static str,
    },
    /// Accelerations that no ground can follow.
    #[error(
        "{}: the ground would move faster than light from {time_s} s on: give accelerations in m/s², or a smaller factor", file.display()
    )]
    Speed {
        /// The file.
        file: PathBuf,
        /// Time of the row that brings it so far [s].
        time_s: f64,
    },
}
