//! The scene that a verb works on: a file, or an example.

use std::path::{Path, PathBuf};

use ndda::{Model, choose, examples, forecast};
use ndda_io::read::{self, LoadedScene};

use crate::args::SceneArgs;
use crate::exit;
use crate::terminal::console::{complain, say};
use crate::terminal::events::Events;

/// The file of a scene; an example is as if it lay in the present folder.
pub fn file(args: &SceneArgs) -> PathBuf {
    let example = args.example.as_ref().map(|name| PathBuf::from(format!("{name}.ron")));
    example.or_else(|| args.scene.clone()).unwrap_or_default()
}

/// Reads, checks and builds a scene; says beforehand if that takes long.
///
/// # Errors
/// The exit code, after the reason has been printed: what is wrong with the scene, or which examples there are.
pub fn model(args: &SceneArgs, events: Events) -> Result<Model, u8> {
    let (loaded, folder) = (read(args, events)?, folder(args));
    warn_of_slow_build(&loaded, &folder);
    Model::new(loaded, &folder).map_err(|errors| events.refuse(&errors))
}

/// Reads and checks a scene; it is built only where its penalty or step is to be chosen.
///
/// # Errors
/// As [`model`].
pub fn scene(args: &SceneArgs, events: Events) -> Result<LoadedScene, u8> {
    choose::complete(read(args, events)?, &folder(args)).map_err(|errors| events.refuse(&errors))
}

/// Folder that the files of a scene are in.
fn folder(args: &SceneArgs) -> PathBuf {
    file(args).parent().filter(|_| args.example.is_none()).unwrap_or(Path::new(".")).to_path_buf()
}

/// The scene as it is written.
fn read(args: &SceneArgs, events: Events) -> Result<LoadedScene, u8> {
    let (file, refuse) = (file(args), |errors| events.refuse(&errors));
    let Some(name) = &args.example else { return read::load(&file, &args.overrides).map_err(refuse) };
    let (text, name) = (text(name, events)?, file.display().to_string());
    read::load_text(&name, text, &args.overrides, None).map_err(refuse)
}

/// Prints the warnings of a scene, if it has any.
pub fn warn(loaded: &LoadedScene, events: Events) {
    if !loaded.warnings.is_empty() {
        events.doubt(&loaded.errors(loaded.warnings.clone()));
    }
}

/// Says beforehand that building a scene takes long.
pub fn warn_of_slow_build(loaded: &LoadedScene, folder: &Path) {
    if let Some(text) = forecast::admit::slow_build(loaded, folder) {
        complain(&text);
    }
}

/// The text of an example.
fn text(name: &str, events: Events) -> Result<&'static str, u8> {
    if name.is_empty() || name == "list" {
        say(&examples::list());
        return Err(exit::DONE);
    }
    examples::text(name).map_err(|message| events.fail(exit::USAGE, &message))
}
