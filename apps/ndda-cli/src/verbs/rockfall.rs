//! `ndda rockfall`: boulders that fall over terrain.

use ndda::places;
use ndda::rockfall::{Request, RockfallError, make};

use crate::args::RockfallArgs;
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
    if !loaded.warnings.is_empty() && !args.quiet {
        events.doubt(&loaded.errors(loaded.warnings.clone()));
    }
    let file = input::file(&args.input);
    let request = Request {
        out: places::folder_for(args.out.as_deref(), &file, ""),
        file,
        count: args.count,
        seed: args.seed,
        jobs: args.jobs.map_or(0, usize::from),
    };
    match make(loaded, &request, &interrupt::watch(), &complain_unless(args.quiet)) {
        Ok(outcome) if args.json => say(&serde_json::to_string_pretty(&outcome).expect("an outcome has no NaN")),
        Ok(outcome) => say(&format!("{outcome}results in {}", request.out.display())),
        Err(RockfallError::Scene(errors)) => return events.refuse(&errors),
        Err(error) => return events.fail(exit::of_rockfall(&error), &error.to_string()),
    }
    exit::DONE
}
