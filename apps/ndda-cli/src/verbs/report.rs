//! `ndda report` and `ndda view`: a run as one page that needs no network.

use ndda::report::{self, ReportError, Written};
use ndda_io::OutputFolder;
use serde_json::json;

use crate::args::{ReportArgs, ViewArgs};
use crate::exit;
use crate::terminal::console::say;
use crate::terminal::events::{self, Events};

/// Says what was written, in words or as an event.
fn tell(written: &Written, events: Events) {
    events.emit("written", written);
    if !events.are_read() {
        say(&written.to_string());
    }
}

/// Runs `ndda report`; returns the exit code.
pub fn report(args: &ReportArgs) -> u8 {
    let file = args.out.clone().unwrap_or_else(|| args.folder.join(OutputFolder::REPORT));
    let events = Events::new(args.json, events::REPORT);
    match report::write(&args.folder, &file, args.frames) {
        Ok(written) => {
            tell(&written, events);
            events.emit("finished", &json!({"exit_code": exit::DONE, "report": file}));
            exit::DONE
        }
        Err(error) => failed(events, &error),
    }
}

/// Runs `ndda view`; returns the exit code.
pub fn view(args: &ViewArgs) -> u8 {
    let file = args.folder.join(OutputFolder::REPORT);
    let events = Events::new(args.json, events::REPORT);
    if !report::is_current(&args.folder, &file) {
        match report::write(&args.folder, &file, None) {
            Ok(written) => tell(&written, events),
            Err(error) => return failed(events, &error),
        }
    }
    let file = std::path::absolute(&file).unwrap_or(file);
    if !args.json {
        say(&format!("opening {}", file.display()));
    }
    if open::that(&file).is_err() {
        events.warn(&format!("no browser could be started: open {} in one", file.display()));
    }
    events.emit("finished", &json!({"exit_code": exit::DONE, "report": file}));
    exit::DONE
}

fn failed(events: Events, error: &ReportError) -> u8 {
    let code = if matches!(error, ReportError::Write(_)) { exit::INPUT_OUTPUT } else { exit::BAD_INPUT };
    events.fail(code, &error.to_string())
}
