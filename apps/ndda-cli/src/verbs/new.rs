//! `ndda new`: a commented scene to begin with.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

use ndda::templates::{TEMPLATES, Template};
use ndda_io::read::suggest;
use serde::Serialize;

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
            true => events.emit("finished", &Text { exit_code: exit::DONE, text: template.scene }),
            false => say(template.scene.trim_end()),
        }
        return exit::DONE;
    }
    let scene = args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.ron")));
    match write(template, &scene, args.force) {
        Ok(()) => {
            events.emit("finished", &Finished { exit_code: exit::DONE, scene: &scene });
            if !args.json {
                say(&format!("{} is written; next: ndda run {}", scene.display(), scene.display()));
            }
            exit::DONE
        }
        Err(reason) => events.fail(exit::INPUT_OUTPUT, &reason),
    }
}

#[derive(Serialize)]
struct Listed {
    exit_code: u8,
    templates: &'static [Template],
}

#[derive(Serialize)]
struct Text {
    exit_code: u8,
    text: &'static str,
}

#[derive(Serialize)]
struct Finished<'a> {
    exit_code: u8,
    scene: &'a Path,
}

fn list(events: Events) -> u8 {
    events.emit("finished", &Listed { exit_code: exit::DONE, templates: &TEMPLATES });
    if !events.are_read() {
        let lines: Vec<String> = TEMPLATES.iter().map(|t| format!("{:8} {}", t.name, t.about)).collect();
        say(&lines.join("\n"));
    }
    exit::DONE
}

/// The scene, and beside it the files that it refers to.
fn write(template: &Template, scene: &Path, force: bool) -> Result<(), String> {
    let folder = scene.parent().unwrap_or(Path::new(""));
    let beside = template.files.iter().map(|(name, content)| (folder.join(name), *content));
    let files: Vec<(PathBuf, &str)> = beside.chain([(scene.to_path_buf(), template.scene)]).collect();
    if let Some((there, _)) = files.iter().find(|(file, _)| !force && file.exists()) {
        return Err(format!(
            "{} is there already; --force replaces it, --out names another",
            there.display()
        ));
    }
    for (file, content) in files {
        let mut options = OpenOptions::new();
        let opened = options.write(true).create(true).create_new(!force).truncate(true).open(&file);
        opened
            .and_then(|mut opened| opened.write_all(content.as_bytes()))
            .map_err(|error| format!("{} cannot be written: {error}", file.display()))?;
    }
    Ok(())
}
