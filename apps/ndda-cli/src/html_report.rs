//! `ndda report` and `ndda view`: a run as one page that needs no network.
//!
//! Curves are drawn by uPlot, blocks by three.js, both embedded. plotly could draw both, but its `mesh3d` has no edges of
//! blocks and is built anew for every frame; three.js moves the corners in place.

mod charts;
mod colours;
mod error;
mod input;
mod motion;
mod packed;
mod page;
mod sections;
mod surface;

use std::fs;
use std::path::{Path, PathBuf};

use ndda_io::folder::{REPORT, SUMMARY};
use serde::Serialize;

use crate::args::{ReportArgs, ViewArgs};
use crate::console::{complain, say};
use crate::exit;
use error::ReportError;
use input::Input;
use motion::Motion;

/// What was written.
#[derive(Debug, Serialize)]
struct Written {
    report: PathBuf,
    bytes: usize,
    /// Frames that the report shows.
    frames: usize,
    /// Frames that the run has.
    frames_of_run: usize,
    blocks: usize,
    triangles: usize,
}

/// Runs `ndda report`; returns the exit code.
pub fn report(args: &ReportArgs) -> u8 {
    let file = args.out.clone().unwrap_or_else(|| args.folder.join(REPORT));
    match write(&args.folder, &file, args.frames) {
        Ok(written) => {
            say(&if args.json { json(&written) } else { words(&written) });
            exit::DONE
        }
        Err(error) => failed(&error),
    }
}

/// Runs `ndda view`; returns the exit code.
pub fn view(args: &ViewArgs) -> u8 {
    let file = args.folder.join(REPORT);
    if !is_current(&args.folder, &file) {
        match write(&args.folder, &file, None) {
            Ok(written) => say(&words(&written)),
            Err(error) => return failed(&error),
        }
    }
    let file = std::path::absolute(&file).unwrap_or(file);
    say(&format!("opening {}", file.display()));
    if let Err(error) = open::that(&file) {
        complain(&format!("no program was found that shows it ({error}): open it in a browser"));
    }
    exit::DONE
}

fn failed(error: &ReportError) -> u8 {
    complain(&format!("error: {error}"));
    if matches!(error, ReportError::Write(_)) { exit::INPUT_OUTPUT } else { exit::BAD_INPUT }
}

/// Whether there is a report that is no older than the summary.
fn is_current(folder: &Path, report: &Path) -> bool {
    let changed = |path: &Path| fs::metadata(path).and_then(|m| m.modified()).ok();
    let summary = changed(&folder.join(SUMMARY));
    summary.is_some() && changed(report) >= summary
}

fn write(folder: &Path, file: &Path, frames: Option<u32>) -> Result<Written, ReportError> {
    let input = Input::read(folder)?;
    let motion = match input.frames.is_empty() || frames == Some(0) {
        true => None,
        false => Some(Motion::read(&input.frames, frames.map(|n| n as usize))?),
    };
    let text = page::page(&input, motion.as_ref());
    ndda_io::atomic::write(file, text.as_bytes())?;
    Ok(Written {
        report: file.to_path_buf(),
        bytes: text.len(),
        frames: motion.as_ref().map_or(0, |m| m.times_s.len()),
        frames_of_run: input.frames.len(),
        blocks: input.summary.counts.blocks,
        triangles: motion.as_ref().map_or(0, |m| m.surface.triangles.len()),
    })
}

fn words(written: &Written) -> String {
    let Written { report, bytes, frames, frames_of_run, .. } = written;
    let motion = match frames {
        0 => "no frames of fields, so without blocks in 3D".to_string(),
        _ => format!("{frames} of {frames_of_run} frames"),
    };
    format!("{}: {:.1} MB, {motion}", report.display(), *bytes as f64 / 1e6)
}

fn json(written: &Written) -> String {
    serde_json::to_string_pretty(written).unwrap_or_else(|error| format!("{{\"error\": \"{error}\"}}"))
}
