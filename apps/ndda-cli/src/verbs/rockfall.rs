//! `ndda rockfall`: boulders that fall over terrain.

use std::path::Path;

use ndda::places;
use ndda::rockfall::{Model, Request, RockfallError, make};
use ndda_io::read;
use serde_json::json;

use crate::args::{RockfallArgs, SceneArgs};
use crate::terminal::console::{complain_unless, say};
use crate::terminal::events::Events;
use crate::terminal::interrupt;
use crate::{exit, input};

/// Runs `ndda rockfall`; returns the exit code.
pub fn rockfall(args: &RockfallArgs) -> u8 {
    let events = Events::default();
    let loaded = match input::scene(&args.input, events) {
        Ok(loaded) => loaded,
        Err(code) => return code,
    };
    if !args.quiet {
        input::warn(&loaded, events);
    }
    let file = input::file(&args.input);
    let (out, jobs) = (places::folder_for(args.out.as_deref(), &file, ""), args.jobs.map_or(0, usize::from));
    let request = Request { out, file, count: args.count, seed: args.seed, jobs, force: args.force };
    let outcome = match make(loaded, &request, &interrupt::watch(), &complain_unless(args.quiet)) {
        Ok(outcome) => outcome,
        Err(error) => return fail(&error, events),
    };
    let words = || format!("{outcome}results in {}", request.out.display());
    say(&if args.json { format!("{:#}", json!(outcome)) } else { words() });
    if outcome.count < outcome.asked { exit::INTERRUPTED } else { exit::DONE }
}

/// Checks a scene of boulders; nothing if it is another one, or cannot be read.
pub fn check(input: &SceneArgs, events: Events) -> Option<u8> {
    let file = input::file(input);
    let loaded = read::load(&file, &input.overrides).ok().filter(|found| found.scene.rockfall.is_some())?;
    Some(match Model::new(loaded, file.parent().unwrap_or(Path::new(".")), (None, None)) {
        Ok(model) => {
            input::warn(&model.loaded, events);
            events.emit("finished", &json!({"exit_code": exit::DONE, "scene": file}));
            if !events.are_read() {
                say(&format!("{}: no errors; {model}", file.display()));
            }
            exit::DONE
        }
        Err(error) => fail(&error, events),
    })
}

fn fail(error: &RockfallError, events: Events) -> u8 {
    match error {
        RockfallError::Scene(errors) => events.refuse(errors),
        error => events.fail(exit::of_rockfall(error), &error.to_string()),
    }
}
