//! `ndda new`: a commented scene to begin with.

use std::path::{Path, PathBuf};

use ndda::templates::TEMPLATES;
use ndda_io::read::suggest;
use serde_json::json;

use crate::args::NewArgs;
use crate::exit;
use crate::terminal::console::say;
use crate::terminal::events::{self, Events};

/// Writes a template; returns the exit code.
pub fn new(args: &NewArgs) -> u8 {
    let events = Events::new(args.json, events::NEW);
    if args.list {
        return list(events);
    }
    let name = args.template.as_deref().unwrap_or(TEMPLATES[0].name);
    let Some(template) = TEMPLATES.iter().find(|template| template.name == name) else {
        let names = TEMPLATES.map(|template| template.name);
        return events
            .fail(exit::USAGE, &format!("there is no template `{name}`: {}", suggest(name, &names)));
    };
    if args.out.as_deref() == Some(Path::new("-")) {
        match args.json {
            true => events.emit("finished", &json!({"exit_code": exit::DONE, "text": template.scene})),
            false => say(template.scene.trim_end()),
        }
        return exit::DONE;
    }
    let scene = args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.ron")));
    match template.write(&scene, args.force) {
        Ok(()) => {
            events.emit("finished", &json!({"exit_code": exit::DONE, "scene": scene}));
            if !args.json {
                let scene = scene.display();
                say(&format!("{scene} is written; next: ndda {} {scene}", template.verb));
            }
            exit::DONE
        }
        Err(reason) => events.fail(exit::INPUT_OUTPUT, &reason),
    }
}

fn list(events: Events) -> u8 {
    events.emit("finished", &json!({"exit_code": exit::DONE, "templates": TEMPLATES}));
    if !events.are_read() {
        let lines: Vec<String> = TEMPLATES.iter().map(|t| format!("{:8} {}", t.name, t.about)).collect();
        say(&lines.join("\n"));
    }
    exit::DONE
}
