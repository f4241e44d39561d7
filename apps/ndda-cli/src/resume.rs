//! `ndda resume`: a run from its last checkpoint to its end.

use std::path::Path;

use ndda_io::{OutputFolder, checkpoint, outside_files, read};
use serde::Serialize;

use crate::args::ResumeArgs;
use crate::check::build;
use crate::checkpoint::SavedRun;
use crate::console::say;
use crate::exit;
use crate::run::{Job, Options, execute, in_pool};
use crate::{run_log, wiring};

/// Goes on with a run and reports; the result is the exit code.
pub fn resume(args: &ResumeArgs) -> u8 {
    in_pool(&args.how, |options| resume_here(&args.folder, options))
}

#[derive(Serialize)]
struct NothingToDo {
    message: String,
}

fn resume_here(folder: &Path, options: &Options) -> u8 {
    let folder = match OutputFolder::open(folder) {
        Ok(folder) => folder,
        Err(error) => return options.events.fail(exit::INPUT_OUTPUT, &error.to_string()),
    };
    let scene = run_log::scene_crc32(&folder);
    let of_this_run = |saved: &SavedRun| match scene {
        Some(known) if known != saved.identity.crc32() => {
            Err(format!("of {}", saved.identity.file.display()))
        }
        _ => Ok(()),
    };
    let (saved, passed_over) = match checkpoint::read(&folder, of_this_run) {
        Ok(found) => found,
        Err(error) => return options.events.fail(exit::BAD_INPUT, &error.to_string()),
    };
    if let Some(error) = passed_over {
        options.events.warn(&format!("{error}; going on from the checkpoint before"));
        if let Err(error) = checkpoint::go_back(&folder) {
            return options.events.fail(exit::INPUT_OUTPUT, &error.to_string());
        }
    }
    let meshes = saved.identity.folder();
    if let Err(error) = outside_files::verify(&saved.identity.outside, meshes) {
        return options.events.fail(exit::BAD_INPUT, &error.to_string());
    }
    let name = saved.identity.file.display().to_string();
    let loaded = read::load_text(&name, &saved.identity.text, &[], Some(meshes));
    let mut ready = match loaded.and_then(|loaded| build(loaded, meshes)) {
        Ok(ready) => ready,
        Err(errors) => return options.events.refuse(&errors),
    };
    let steps = wiring::steps(&ready.loaded.scene.time);
    // Killed between its last step and its summary, a run still owes the summary.
    if saved.snapshot.state.step >= steps && folder.summary().exists() {
        let message = format!("{} has run to its end: nothing to resume", folder.path().display());
        if !options.events.are_read() {
            say(&message);
        }
        options.events.emit("nothing_to_do", &NothingToDo { message });
        return exit::DONE;
    }
    if !options.quiet {
        say(&format!("going on from step {} of {steps}", saved.snapshot.state.step));
    }
    // What is compared with the start must see the start.
    let comparison = ready.comparison();
    let SavedRun { identity, snapshot, earlier } = saved;
    if let Err(error) = ready.simulation.restore(snapshot) {
        return options.events.fail(exit::BAD_INPUT, &format!("the checkpoint does not fit: {error}"));
    }
    execute(Job { ready, comparison, identity, folder, earlier: Some(earlier) }, options)
}
