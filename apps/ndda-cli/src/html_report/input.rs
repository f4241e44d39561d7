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
        let history = results::history_file(folder);
        if !has(SUMMARY) && history.is_none() && !has(CHECKPOINT) {
            return Err(ReportError::NotARun(folder.to_path_buf()));
        }
        let incomplete = |missing| ReportError::Incomplete { folder: folder.to_path_buf(), missing };
        if !has(SUMMARY) {
            return Err(incomplete(SUMMARY));
        }
        let history = history.ok_or_else(|| incomplete(HISTORY))?;
        let index = folder.join(FIELDS_INDEX);
        Ok(Self {
            summary: results::summary(&folder.join(SUMMARY))?,
            history: results::history(&history)?,
            frames: if index.is_file() { results::frame_list(&index)? } else { Vec::new() },
        })
    }
}
