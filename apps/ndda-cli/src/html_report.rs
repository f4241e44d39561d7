//! `ndda report` and `ndda view`: a run as one page that needs no network.
//!
//! Curves are drawn by uPlot, blocks by three.js, both embedded. plotly could draw both, but its `mesh3d` has no edges of
//! blocks and is built anew for every frame; three.js moves the corners in place.

mod certificate;
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
use crate::console::say;
use crate::events::{self, Events};
use crate::{certify, exit};
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

#[derive(Serialize)]
struct Finished<'a> {
    exit_code: u8,
    report: &'a Path,
}

impl Written {
    /// Says what was written, in words or as an event.
    fn said(&self, events: Events) {
        events.emit("written", self);
        if !events.are_read() {
            say(&self.words());
        }
    }

    fn words(&self) -> String {
        let Self { report, bytes, frames, frames_of_run, .. } = self;
        let motion = match frames {
            0 => "no frames of fields, so without blocks in 3D".to_string(),
            _ => format!("{frames} of {frames_of_run} frames"),
        };
        format!("{}: {:.1} MB, {motion}", report.display(), *bytes as f64 / 1e6)
    }
}

/// Runs `ndda report`; returns the exit code.
pub fn report(args: &ReportArgs) -> u8 {
    let file = args.out.clone().unwrap_or_else(|| args.folder.join(REPORT));
    let events = Events::new(args.json, events::REPORT);
    match write(&args.folder, &file, args.frames) {
        Ok(written) => {
            written.said(events);
            events.emit("finished", &Finished { exit_code: exit::DONE, report: &file });
            exit::DONE
        }
        Err(error) => failed(events, &error),
    }
}

/// Runs `ndda view`; returns the exit code.
pub fn view(args: &ViewArgs) -> u8 {
    let file = args.folder.join(REPORT);
    let events = Events::new(args.json, events::REPORT);
    if !is_current(&args.folder, &file) {
        match write(&args.folder, &file, None) {
            Ok(written) => written.said(events),
            Err(error) => return failed(events, &error),
        }
    }
    let file = std::path::absolute(&file).unwrap_or(file);
    if !args.json {
        say(&format!("opening {}", file.display()));
    }
    if let Err(error) = open::that(&file) {
        events.warn(&format!("no program was found that shows it ({error}): open it in a browser"));
    }
    events.emit("finished", &Finished { exit_code: exit::DONE, report: &file });
    exit::DONE
}

fn failed(events: Events, error: &ReportError) -> u8 {
    let code = if matches!(error, ReportError::Write(_)) { exit::INPUT_OUTPUT } else { exit::BAD_INPUT };
    events.fail(code, &error.to_string())
}

/// Whether there is a report that is no older than the summary and the certificate.
fn is_current(folder: &Path, report: &Path) -> bool {
    let changed = |path: &Path| fs::metadata(path).and_then(|m| m.modified()).ok();
    let summary = changed(&input::run_folder(folder).join(SUMMARY));
    let certificate = changed(&folder.join(certify::certificate::FILE));
    summary.is_some() && changed(report) >= summary.max(certificate)
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
