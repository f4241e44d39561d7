//! `ndda record`: a record of ground motion, its measures, response spectrum, and slip of a block.

use ndda::shaking::{ShakingError, make, tell};

use crate::terminal::console::say;
use crate::terminal::events::{self, Events};
use crate::{args::RecordArgs, exit};

/// Runs `ndda record`; returns the exit code.
pub fn record(args: &RecordArgs) -> u8 {
    let events = Events::new(args.json, events::RECORD);
    match make(&args.request()) {
        Ok(shaking) => {
            events.emit("finished", &shaking);
            if !args.json {
                say(&tell(&shaking));
            }
            exit::DONE
        }
        Err(ShakingError::Write(error)) => events.fail(exit::of_write(&error), &error.to_string()),
        Err(error @ ShakingError::Option { .. }) => events.fail(exit::USAGE, &error.to_string()),
        Err(error) => events.fail(exit::BAD_INPUT, &error.to_string()),
    }
}
