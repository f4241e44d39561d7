//! Why a report cannot be written.

use std::path::PathBuf;

use ndda_io::WriteError;
use ndda_io::mesh_file::MeshFileError;
use ndda_io::table::TableError;

use crate::frames::OtherBlocks;
use crate::summary::SummaryError;

/// Why a report cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// There is no such folder.
    #[error("{} is not a folder: name the output folder of a run, as out/sliding_45", .0.display())]
    NotAFolder(PathBuf),
    /// The folder is not one that `ndda run` wrote; what it holds instead, where that is known.
    #[error("{} holds no run: it has neither summary.json nor history.csv; {}", .0.display(), .1.as_deref().unwrap_or("`ndda run SCENE --out DIR` writes them"))]
    NotARun(PathBuf, Option<String>),
    /// The run is not over, or was killed.
    #[error("{} holds a run without its {missing}: wait if the run is still going; if it was killed, `ndda resume` finishes it", folder.display())]
    Incomplete {
        /// The output folder.
        folder: PathBuf,
        /// The file that is missing.
        missing: &'static str,
    },
    /// There is nothing to show.
    #[error("there are no frames to show: keep one first")]
    NoFrames,
    /// The summary cannot be used.
    #[error(transparent)]
    Summary(#[from] SummaryError),
    /// A row of the history, or of what bolts carry, is not numbers, one per column.
    #[error("{0}; the history is damaged: run the scene again")]
    History(#[from] TableError),
    /// A frame cannot be used.
    #[error(transparent)]
    Frame(#[from] MeshFileError),
    /// A frame that does not fit the first.
    #[error(transparent)]
    OtherBlocks(#[from] OtherBlocks),
    /// The page cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}
