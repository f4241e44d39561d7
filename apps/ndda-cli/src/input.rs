//! The scene that a verb works on: a file, or an example.

use std::path::{Path, PathBuf};

use ndda_io::read;

use crate::args::SceneArgs;
use crate::check::{Ready, prepare, prepare_loaded};
use crate::console::say;
use crate::events::Events;
use crate::{examples, exit};

/// The file of a scene; an example is as if it lay in the present folder.
pub fn file(args: &SceneArgs) -> PathBuf {
    let example = args.example.as_ref().map(|name| PathBuf::from(format!("{name}.ron")));
    example.or_else(|| args.scene.clone()).unwrap_or_default()
}

/// Reads, checks and builds a scene.
///
/// # Errors
/// The exit code, after the reason has been printed: what is wrong with the scene, or which examples there are.
pub fn ready(args: &SceneArgs, events: Events) -> Result<Ready, u8> {
    let file = file(args);
    let ready = match &args.example {
        None => prepare(&file, &args.overrides),
        Some(name) => {
            let loaded =
                read::load_text(&file.display().to_string(), text(name, events)?, &args.overrides, None);
            loaded.and_then(|loaded| prepare_loaded(loaded, Path::new(".")))
        }
    };
    ready.map_err(|errors| events.refuse(&errors))
}

/// The text of an example.
fn text(name: &str, events: Events) -> Result<&'static str, u8> {
    if name.is_empty() {
        say(&examples::list());
        return Err(exit::DONE);
    }
    examples::find(name).ok_or_else(|| {
        let names: Vec<&str> = examples::EXAMPLES.iter().map(|(name, _)| *name).collect();
        events.fail(exit::USAGE, &format!("there is no example `{name}`: {}", read::suggest(name, &names)))
    })
}
