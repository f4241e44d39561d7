//! Common part of `ndda certify` and `ndda tune`: a scene that is run many times.

use std::path::PathBuf;

use ndda::certify::Trial;
use ndda::certify::error::CertifyError;
use ndda::{Model, examples, places};
use ndda_io::scene::Scene;
use ndda_io::{WriteError, atomic, read};

use super::processes;
use crate::args::{SceneArgs, TrialHow};
use crate::terminal::console::complain;
use crate::terminal::events::Events;
use crate::{exit, input};

/// Reads, checks and builds a scene once, and makes its output folder, `out/NAME_purpose` unless another is requested;
/// `steps` is the number of steps of its longest step.
///
/// # Errors
/// The exit code, after the reason has been printed.
pub fn open(
    args: &SceneArgs,
    how: &TrialHow,
    purpose: &str,
    steps: impl FnOnce(&Scene) -> u64,
) -> Result<(Trial, Model), u8> {
    let events = Events::default();
    let model = input::model(args, events)?;
    if !how.quiet {
        input::warn(&model.loaded, events);
    }
    let file = input::file(args);
    let out = places::folder_for(how.out.as_deref(), &file, &format!("_{purpose}"));
    let text = match &args.example {
        None => read::text_of(&file).map_err(|errors| events.refuse(&errors))?,
        Some(example) => examples::find(example).unwrap_or_default().to_string(),
    };
    let is_file = args.example.is_none() && !read::is_standard_input(&file);
    let steps = steps(&model.loaded.scene);
    let mut trial =
        Trial::new(&model, (file, text), &args.overrides, out, steps).map_err(|error| refuse(&error))?;
    if !is_file {
        trial.loaded.scene = kept_file(&trial).map_err(|error| refuse(&error.into()))?;
    }
    Ok((trial, model))
}

/// Writes a scene that is no file, an example or standard input, to the folder, so that runs have a file to read.
fn kept_file(trial: &Trial) -> Result<PathBuf, WriteError> {
    let file = trial.out.join("scene.ron");
    atomic::write(&file, trial.loaded.scene_text.as_bytes()).map(|()| file)
}

/// Says why a scene cannot be certified; gives the exit code.
pub fn refuse(error: &CertifyError) -> u8 {
    if let CertifyError::Run(error) = error {
        return processes::refuse(error);
    }
    complain(&format!("error: {error}"));
    exit::of_certify(error)
}
