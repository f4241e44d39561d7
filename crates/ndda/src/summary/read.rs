//! Reading a summary.

use std::path::{Path, PathBuf};
use std::{fs, io};

use super::Summary;

/// Why a summary cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum SummaryError {
    /// The file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// It is no summary of this version.
    #[error("{}: {source}; it is damaged or of another version of ndda: run the scene again", path.display())]
    Other {
        /// The file.
        path: PathBuf,
        /// Error of the reader, with line and column.
        source: serde_json::Error,
    },
}

impl Summary {
    /// Reads `summary.json`.
    ///
    /// # Errors
    /// [`SummaryError`] when the file cannot be read, or is no summary of this version.
    pub fn read(path: &Path) -> Result<Self, SummaryError> {
        let unreadable = |source| SummaryError::Unreadable { path: path.to_path_buf(), source };
        let text = fs::read_to_string(path).map_err(unreadable)?;
        serde_json::from_str(&text).map_err(|source| SummaryError::Other { path: path.to_path_buf(), source })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_summary_that_is_none_is_named_with_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("summary.json");
        fs::write(&path, "{\n  \"version\": 3 }").unwrap();
        let error = Summary::read(&path).unwrap_err().to_string();
        assert!(error.contains("line 2") && error.contains("run the scene again"), "{error}");
    }
}
