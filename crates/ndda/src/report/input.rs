//! The files of a run.

use std::path::{Path, PathBuf};

use ndda_io::folder::{BOLTS, CHECKPOINT, FIELDS_INDEX, HISTORY, SUMMARY};
use ndda_io::results::{self, BoltForces, ListedFrame, Table};
use ndda_io::summary::Summary;

use super::error::ReportError;
use crate::certify::certificate::Certificate;
use crate::places;
use crate::study::record;
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
    if folder.join(SUMMARY).is_file() {
        folder.to_path_buf()
    } else if folder.join(places::SAFETY).is_file() && mechanism.join(SUMMARY).is_file() {
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
        let history = results::history_file(folder);
        if !has(SUMMARY) && history.is_none() && !has(CHECKPOINT) {
            return Err(ReportError::NotARun(folder.to_path_buf(), places::instead(folder)));
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
            bolt_frames: bolts::listed(folder)?,
            bolt_forces: if has(BOLTS) {
                results::bolt_forces(&folder.join(BOLTS))?
            } else {
                BoltForces::default()
            },
            certificate,
        })
    }
}
