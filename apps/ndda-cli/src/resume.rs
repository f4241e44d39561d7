//! `ndda resume`: a run from its last checkpoint to its end.

use std::path::Path;

use ndda_io::{OutputFolder, checkpoint, read};

use crate::args::ResumeArgs;
use crate::check::prepare_loaded;
use crate::checkpoint::SavedRun;
use crate::console::{colour, complain, say};
use crate::exit;
use crate::run::{Job, Options, execute, in_pool};
use crate::wiring;

/// Goes on with a run and reports; the result is the exit code.
pub fn resume(args: &ResumeArgs) -> u8 {
    in_pool(&args.how, |options| resume_here(&args.folder, options))
}

fn resume_here(folder: &Path, options: &Options) -> u8 {
    let folder = match OutputFolder::open(folder) {
        Ok(folder) => folder,
        Err(error) => {
            complain(&format!("error: {error}"));
            return exit::INPUT_OUTPUT;
        }
    };
    let (saved, passed_over) = match checkpoint::read::<SavedRun>(&folder) {
        Ok(found) => found,
        Err(error) => {
            complain(&format!("error: {error}"));
            return exit::BAD_INPUT;
        }
    };
    if let Some(error) = passed_over {
        complain(&format!("warning: {error}; going on from the checkpoint before"));
    }
    let meshes = saved.identity.file.parent().unwrap_or(Path::new("."));
    let name = saved.identity.file.display().to_string();
    let loaded = read::load_text(&name, &saved.identity.text, &[], Some(meshes));
    let mut ready = match loaded.and_then(|loaded| prepare_loaded(loaded, meshes)) {
        Ok(ready) => ready,
        Err(errors) => {
            complain(&errors.render(colour()));
            return exit::BAD_INPUT;
        }
    };
    let steps = wiring::steps(&ready.loaded.scene.time);
    // Killed between its last step and its summary, a run still owes the summary.
    if saved.snapshot.state.step >= steps && folder.summary().exists() {
        say(&format!("{} has run to its end: nothing to resume", folder.path().display()));
        return exit::DONE;
    }
    if !options.quiet {
        say(&format!("going on from step {} of {steps}", saved.snapshot.state.step));
    }
    // What is compared with the start must see the start.
    let comparison = ready.comparison();
    let SavedRun { identity, snapshot, earlier } = saved;
    if let Err(error) = ready.simulation.restore(snapshot) {
        complain(&format!("error: the checkpoint does not fit: {error}"));
        return exit::BAD_INPUT;
    }
    execute(Job { ready, comparison, identity, folder, earlier: Some(earlier) }, options)
}
