//! Reads the results of a run: summary, history, fields.

mod bolts;
mod fields;

use std::fs;
use std::path::{Path, PathBuf};

use crate::mesh::MeshFileError;
use crate::results::folder::OutputFolder;
use crate::results::summary::Summary;
use crate::results::table::TableError;

pub use crate::mesh::vtk_file::Array;
pub use crate::results::table::Table;
pub use bolts::BoltForces;
pub use fields::{FieldFrame, ListedFrame};

/// Why results cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// A file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// The summary is none of this version.
    #[error("{}: {source}; it is damaged or of another version of ndda: run the scene again", path.display())]
    Summary {
        /// The file.
        path: PathBuf,
        /// Error of the reader, with line and column.
        source: serde_json::Error,
    },
    /// A row of the history is not numbers, one per column.
    #[error("{0}; the history is damaged: run the scene again")]
    History(#[from] TableError),
    /// The list of frames, or a frame.
    #[error(transparent)]
    Fields(#[from] MeshFileError),
}

impl Summary {
    /// Reads `summary.json`.
    ///
    /// # Errors
    /// [`ResultsError`] when the file cannot be read, or is no summary of this version.
    pub fn read(path: &Path) -> Result<Self, ResultsError> {
        let unreadable = |source| ResultsError::Unreadable { path: path.to_path_buf(), source };
        let text = fs::read_to_string(path).map_err(unreadable)?;
        serde_json::from_str(&text)
            .map_err(|source| ResultsError::Summary { path: path.to_path_buf(), source })
    }
}

impl OutputFolder {
    /// The history in the output folder of a run: as text, or else in columns.
    pub fn history_in(folder: &Path) -> Option<PathBuf> {
        [OutputFolder::HISTORY, OutputFolder::PARQUET[0]]
            .map(|name| folder.join(name))
            .into_iter()
            .find(|file| file.is_file())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::History;

    fn history(path: &Path) -> Result<Table, ResultsError> {
        Ok(Table::read(path)?)
    }

    #[test]
    fn a_history_is_read_back_bit_by_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        let names = ["time_s".to_string(), "a, b".to_string()];
        let mut written = History::create(&path, &names).unwrap();
        let rows = [[0.0, 1.0 / 3.0], [0.1 + 0.2, -5e-324]];
        rows.iter().for_each(|row| written.push(row).unwrap());
        written.finish().unwrap();
        let table = history(&path).unwrap();
        assert_eq!(table.names, names);
        assert_eq!(table.columns, [[rows[0][0], rows[1][0]], [rows[0][1], rows[1][1]]]);
    }

    #[test]
    fn a_damaged_row_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        for (bad, place) in [("0.0,1.0\n0.1,x\n", "row 2"), ("0.0,1.0\n0.1\n", "line 3 has 1 value")] {
            std::fs::write(&path, format!("time_s,a\n{bad}")).unwrap();
            let error = history(&path).unwrap_err().to_string();
            assert!(error.contains(place) && error.contains("run the scene again"), "{error}");
        }
        assert!(matches!(history(&folder.path().join("none.csv")), Err(ResultsError::History(_))));
    }

    #[test]
    fn a_summary_that_is_none_is_named_with_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("summary.json");
        std::fs::write(&path, "{\n  \"version\": 3 }").unwrap();
        let error = Summary::read(&path).unwrap_err().to_string();
        assert!(error.contains("line 2") && error.contains("run the scene again"), "{error}");
    }
}
