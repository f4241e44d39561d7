//! `ndda resume`: a run from its last checkpoint to its end.

use std::path::Path;

use ndda::Run;
use ndda::run::{ResumeError, Resumed};

use super::run::{Options, execute, in_pool};
use crate::args::ResumeArgs;
use crate::exit;
use crate::terminal::console::say;

/// Goes on with a run and reports; the result is the exit code.
pub fn resume(args: &ResumeArgs) -> u8 {
    in_pool(&args.how, |options| resume_here(&args.folder, options))
}

fn resume_here(folder: &Path, options: &Options) -> u8 {
    let Resumed { run, warnings } = match Run::resume(folder) {
        Ok(resumed) => resumed,
        Err(error) => return refuse(&error, options),
    };
    warnings.iter().for_each(|warning| options.events.warn(warning));
    if !options.quiet {
        let (step, steps) = (run.model().simulation.state().step, run.model().steps());
        say(&match run.settling_steps() {
            Some(settled) => format!("going on with settling after {settled} steps"),
            None => format!("going on from step {step} of {steps}"),
        });
    }
    execute(run, folder, options)
}

fn refuse(error: &ResumeError, options: &Options) -> u8 {
    match error {
        ResumeError::HasEnded(_) => {
            let message = error.told(options.sensitivity);
            if !options.events.are_read() {
                say(&message);
            }
            options.events.emit("nothing_to_do", &serde_json::json!({ "message": message }));
            exit::DONE
        }
        ResumeError::Scene(errors) => options.events.refuse(errors),
        ResumeError::Write(error) => options.events.fail(exit::of_write(error), &error.to_string()),
        ResumeError::Unusable(_) | ResumeError::DoesNotFit(_) | ResumeError::Ranks(_) => {
            options.events.fail(exit::BAD_INPUT, &error.to_string())
        }
    }
}
