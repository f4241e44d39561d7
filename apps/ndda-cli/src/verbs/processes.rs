//! Cases of a study as processes of their own, so that memory is measured per case and a crash ends one run, not all.

use std::ffi::OsString;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use ndda::study::error::StudyError;
use ndda::study::ranks;
use ndda::study::record::Cause;
use ndda::study::runner::{CaseRun, CaseRunner};

use crate::exit;
use crate::terminal::console::{colour, complain};

/// Words that start this program.
pub static PROGRAM: OnceLock<Vec<OsString>> = OnceLock::new();

/// Runs cases as processes of this program.
pub struct Processes {
    /// Raised when somebody asks the study to end.
    pub stop: Arc<AtomicBool>,
    /// Ranks that take a case together.
    pub ranks: u16,
}

impl CaseRunner for Processes {
    fn ranks(&self) -> u16 {
        self.ranks
    }

    fn run(&self, run: &CaseRun) -> Result<Option<(Cause, String)>, StudyError> {
        if self.stop.load(Ordering::Relaxed) {
            return Err(StudyError::Interrupted);
        }
        let program = PROGRAM.get().map_or(&[][..], Vec::as_slice);
        let mut command = ranks::command(run, program, self.ranks)?;
        let done = command.output().map_err(|error| ranks::not_started(&command, &error))?;
        let is = |code: u8| done.status.code() == Some(i32::from(code));
        if is(exit::INTERRUPTED) {
            return Err(StudyError::Interrupted);
        }
        if done.status.success() {
            return Ok(None);
        }
        let said = String::from_utf8_lossy(&done.stderr);
        let reason = said.lines().find(|line| line.contains("error")).or(said.lines().next());
        let reason = reason.map_or_else(|| done.status.to_string(), String::from);
        let cause = match () {
            () if is(exit::BAD_INPUT) => Cause::Scene,
            () if is(exit::STOPPED) => Cause::Stopped,
            () => Cause::Other,
        };
        Ok(Some((cause, reason)))
    }
}

/// Says why a study cannot go on; gives the exit code.
pub fn refuse(error: &StudyError) -> u8 {
    match error {
        StudyError::Scene(errors) => complain(&errors.render(colour())),
        StudyError::Interrupted => complain(&error.to_string()),
        _ => complain(&format!("error: {error}")),
    }
    exit::of_study(error)
}
