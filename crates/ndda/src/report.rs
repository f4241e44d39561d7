//! A run as one page of HTML that needs no network.
//!
//! Curves are drawn by uPlot, blocks by three.js, both embedded. plotly could draw both, but its `mesh3d` has no edges of
//! blocks and is built anew for every frame; three.js moves the corners in place.

mod bolts;
mod certificate;
mod charts;
mod error;
mod input;
mod motion;
mod packed;
mod page;
mod sections;

use std::fs;
use std::path::{Path, PathBuf};

use ndda_io::OutputFolder;
use ndda_io::results::ListedFrame;
use serde::Serialize;

use crate::certify;
pub use error::ReportError;
use input::Input;
use motion::Motion;

/// The files that were written.
#[derive(Debug, Serialize)]
pub struct Written {
    /// The file.
    pub report: PathBuf,
    /// Its size [B].
    pub bytes: usize,
    /// Frames that the report shows.
    pub frames: usize,
    /// Frames that the run has.
    pub frames_of_run: usize,
    /// Blocks of the run.
    pub blocks: usize,
    /// Triangles that are drawn.
    pub triangles: usize,
}

impl std::fmt::Display for Written {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let Self { report, bytes, frames, frames_of_run, .. } = self;
        write!(f, "{}: {:.1} MB, ", report.display(), *bytes as f64 / 1e6)?;
        match frames {
            0 => write!(f, "no frames of fields, so without blocks in 3D"),
            _ => write!(f, "{frames} of {frames_of_run} frames"),
        }
    }
}

/// Whether there is a report that is no older than the summary and the certificate.
pub fn is_current(folder: &Path, report: &Path) -> bool {
    let changed = |path: &Path| fs::metadata(path).and_then(|m| m.modified()).ok();
    let summary = changed(&input::run_folder(folder).join(OutputFolder::SUMMARY));
    let certificate = changed(&folder.join(certify::certificate::FILE));
    summary.is_some() && changed(report) >= summary.max(certificate)
}

/// Writes the page of the run in a folder, with so many of its frames, all of them if not said.
///
/// # Errors
/// [`ReportError`] when the folder holds no run, or the page cannot be written.
pub fn write(folder: &Path, file: &Path, frames: Option<u32>) -> Result<Written, ReportError> {
    let input = Input::read(folder)?;
    let motion = match input.frames.is_empty() || frames == Some(0) {
        true => None,
        false => Some(Motion::read(&input.frames, &input.bolt_frames, frames.map(|n| n as usize))?),
    };
    let text = page::page(&input, motion.as_ref());
    ndda_io::atomic::write_named(file, text.as_bytes())?;
    Ok(Written {
        report: file.to_path_buf(),
        bytes: text.len(),
        frames: motion.as_ref().map_or(0, |m| m.times_s.len()),
        frames_of_run: input.frames.len(),
        blocks: input.summary.counts.blocks,
        triangles: motion.as_ref().map_or(0, |m| m.surface.triangles.len()),
    })
}

/// A page with nothing but the blocks of some frames, each with its time [s] and file, and their names.
///
/// # Errors
/// [`ReportError`] when a frame is damaged, does not fit the first, or there is none.
pub fn viewer(title: &str, block_names: &[String], frames: &[(f64, PathBuf)]) -> Result<String, ReportError> {
    let listed: Vec<ListedFrame> =
        frames.iter().map(|(time_s, path)| ListedFrame { time_s: *time_s, path: path.clone() }).collect();
    if listed.is_empty() {
        return Err(ReportError::NoFrames);
    }
    Ok(page::viewer(title, block_names, &Motion::read(&listed, &[], None)?))
}
