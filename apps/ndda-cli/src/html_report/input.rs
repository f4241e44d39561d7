//! The files of a run.

use std::path::Path;

use ndda_io::folder::{CHECKPOINT, FIELDS_INDEX, HISTORY, SUMMARY};
use ndda_io::results::{self, ListedFrame, Table};
use ndda_io::summary::Summary;

use super::error::ReportError;

/// What a run left, but for the frames themselves.
pub struct Input {
    /// Its summary.
    pub summary: Summary,
    /// Its history.
    pub history: Table,
    /// Its frames; none where it wrote no fields.
    pub frames: Vec<ListedFrame>,
}

impl Input {
    /// Reads an output folder.
    ///
    /// # Errors
    /// [`ReportError`] when it is none, is that of a run that did not end, or a file is damaged.
    pub fn read(folder: &Path) -> Result<Self, ReportError> {
        if !folder.is_dir() {
            return Err(ReportError::NotAFolder(folder.to_path_buf()));
        }
        let has = |name: &str| folder.join(name).is_file();
        if !has(SUMMARY) && !has(HISTORY) && !has(CHECKPOINT) {
            return Err(ReportError::NotARun(folder.to_path_buf()));
        }
        if let Some(missing) = [SUMMARY, HISTORY].into_iter().find(|name| !has(name)) {
            return Err(ReportError::Incomplete { folder: folder.to_path_buf(), missing });
        }
        let index = folder.join(FIELDS_INDEX);
        Ok(Self {
            summary: results::summary(&folder.join(SUMMARY))?,
            history: results::history(&folder.join(HISTORY))?,
            frames: if index.is_file() { results::frame_list(&index)? } else { Vec::new() },
        })
    }
}
