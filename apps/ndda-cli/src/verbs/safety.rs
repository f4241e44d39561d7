//! `ndda safety`: by how much the strength of joints may fall before blocks move.

use std::path::Path;

use ndda::places;
use ndda::safety::{self, Plan, Question, SafetyError, Watch};

use crate::args::{SafetyArgs, SafetyBy};
use crate::terminal::console::{complain, complain_unless, say};
use crate::terminal::events::Events;
use crate::terminal::interrupt;
use crate::{exit, input};

/// Finds the factor of safety; the result is the exit code.
pub fn safety(args: &SafetyArgs) -> u8 {
    let threads = args.threads.map_or(0, usize::from);
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(|| find(args)),
        Err(error) => {
            complain(&format!("error: cannot start {threads} threads: {error}; use a smaller --threads"));
            exit::RESOURCE
        }
    }
}

fn find(args: &SafetyArgs) -> u8 {
    let events = Events::default();
    let loaded = match input::scene(&args.input, events) {
        Ok(loaded) => loaded,
        Err(code) => return code,
    };
    if !args.quiet {
        input::warn(&loaded, events);
    }
    let file = input::file(&args.input);
    let (name, out) = (places::name_of(&file), places::folder_for(args.out.as_deref(), &file, "_safety"));
    if let Err(error) = safety::make_folder(&out, &name, args.force) {
        complain(&format!("error: {error}"));
        return exit::of_safety(&error);
    }
    if args.towards.is_some() && args.by != SafetyBy::Gravity {
        complain("error: --towards works only with --by gravity: add that, or leave --towards out");
        return exit::USAGE;
    }
    let by = match args.by {
        SafetyBy::Strength => Question::Strength,
        SafetyBy::Load => Question::Load,
        SafetyBy::Gravity => Question::Gravity { towards: args.towards },
    };
    let plan = Plan { by, error: args.error, ..Plan::default() };
    let (stop, tell) = (interrupt::watch(), complain_unless(args.quiet));
    let watch = Watch { out: Some(&out), stop: &stop, tell: &tell };
    let folder = file.parent().unwrap_or(Path::new("."));
    match safety::find(&loaded, (&name, folder), &plan, &watch) {
        Ok(found) if args.json => {
            say(&serde_json::to_string_pretty(&found).expect("an answer has no NaN"));
            exit::DONE
        }
        Ok(found) => {
            let film = safety::mechanism_folder(&out);
            let fails = found.mechanism.is_some() && cfg!(feature = "report");
            let view = || format!("; how blocks fail: ndda view {}", film.display());
            let next = if fails { view() } else { String::new() };
            say(&format!("{}results in {}{next}", safety::text(&found), safety::file(&out).display()));
            exit::DONE
        }
        Err(SafetyError::Scene(errors)) => events.refuse(&errors),
        Err(error) => {
            complain(&format!("error: {error}"));
            exit::of_safety(&error)
        }
    }
}
