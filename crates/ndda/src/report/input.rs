//! The files of a run.

use std::path::{Path, PathBuf};

use ndda_io::OutputFolder;
use ndda_io::results::{BoltForces, ListedFrame, Table};

use super::error::ReportError;
use crate::certify::certificate::Certificate;
use crate::places;
use crate::study::record;
use crate::summary::Summary;
use crate::view3d::bolts;

/// Results of a run, but for the frames themselves.
pub struct Input {
    /// Its summary.
    pub summary: Summary,
    /// Its history.
    pub history: Table,
    /// Its frames; none where it wrote no fields.
    pub frames: Vec<ListedFrame>,
    /// Its frames of bolts; none where it has no bolts.
    pub bolt_frames: Vec<ListedFrame>,
    /// What its bolts carry over time.
    pub bolt_forces: BoltForces,
    /// Error bars of its answers; none where it was not certified.
    pub certificate: Option<Certificate>,
}

/// The folder of the run that a page shows: that of the shortest of the steps that a certificate is from, where `folder`
/// holds one and no run of its own, or that of how blocks fail, where it holds a factor of safety.
pub fn run_folder(folder: &Path) -> PathBuf {
    let of_certificate = || {
        let certificate = Certificate::read(folder)?;
        let finest = certificate.runs.get(2)?;
        Some(record::folder(folder, &finest.name).join(record::RESULTS))
    };
    let mechanism = folder.join(places::MECHANISM);
    if folder.join(OutputFolder::SUMMARY).is_file() {
        folder.to_path_buf()
    } else if folder.join(places::SAFETY).is_file() && mechanism.join(OutputFolder::SUMMARY).is_file() {
        mechanism
    } else {
        of_certificate().unwrap_or_else(|| folder.to_path_buf())
    }
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
        let certificate = Certificate::read(folder);
        let folder = &run_folder(folder);
        let has = |name: &str| folder.join(name).is_file();
        let history = OutputFolder::history_in(folder);
        if !has(OutputFolder::SUMMARY) && history.is_none() && !has(OutputFolder::CHECKPOINT) {
            return Err(ReportError::NotARun(folder.to_path_buf(), places::instead(folder)));
        }
        let incomplete = |missing| ReportError::Incomplete { folder: folder.to_path_buf(), missing };
        if !has(OutputFolder::SUMMARY) {
            return Err(incomplete(OutputFolder::SUMMARY));
        }
        let history = history.ok_or_else(|| incomplete(OutputFolder::HISTORY))?;
        let index = folder.join(OutputFolder::FIELDS_INDEX);
        Ok(Self {
            summary: Summary::read(&folder.join(OutputFolder::SUMMARY))?,
            history: Table::read(&history)?,
            frames: if index.is_file() { ListedFrame::read_all(&index)? } else { Vec::new() },
            bolt_frames: bolts::listed(folder)?,
            bolt_forces: if has(OutputFolder::BOLTS) {
                BoltForces::read(&folder.join(OutputFolder::BOLTS))?
            } else {
                BoltForces::default()
            },
            certificate,
        })
    }
}
