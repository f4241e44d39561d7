//! `ndda mesh`: the blocks of a scene or of a mesh file, counted, measured and drawn without running anything.

use std::path::Path;

use ndda::build::{self, CutRock, Meshes};
use ndda::mesh_files::MeshFiles;
use ndda::mesh_input::{self, Repair};
use ndda::mesh_report::{self, MeshReport};
use ndda::{forecast, places};
use ndda_io::diagnostic::SceneErrors;
use ndda_io::read::load;
use ndda_io::scene::Scene;
use ndda_mesh::BlockSet;
use serde_json::json;

use crate::args::{Fix, MeshArgs};
use crate::terminal::console::say;
use crate::terminal::events::{self, Events};
use crate::{exit, input};

/// Blocks before they are checked.
struct Input {
    /// Kept for files in other formats only.
    meshes: Meshes,
    scene: Option<Scene>,
    rock: Vec<CutRock>,
    fixes: Vec<String>,
}

/// Why there are no blocks to measure.
enum Refused {
    /// Errors of the scene.
    Scene(Box<SceneErrors>),
    /// An exit code and what is wrong with the mesh file or the command line.
    Message(u8, String),
}

impl From<SceneErrors> for Refused {
    fn from(errors: SceneErrors) -> Self {
        Self::Scene(Box::new(errors))
    }
}

/// Input that cannot be used.
fn bad_input(message: impl Into<String>) -> Refused {
    Refused::Message(exit::BAD_INPUT, message.into())
}

/// Runs `ndda mesh`; returns the exit code.
pub fn mesh(args: &MeshArgs) -> u8 {
    let events = Events::new(args.json, events::MESH);
    let input = if is_scene(&args.input) { from_scene(args) } else { from_file(args) };
    let mut input = match input {
        Ok(input) => input,
        Err(Refused::Scene(errors)) => return events.refuse(&errors),
        Err(Refused::Message(code, message)) => return events.fail(code, &message),
    };
    let mut measured = MeshReport::new(&input.meshes);
    measured.rock = input.rock.iter().map(|rock| rock.report.clone()).collect();
    measured.fixes.clone_from(&input.fixes);
    let meshes = std::mem::take(&mut input.meshes);
    if !args.also.is_empty() {
        input.meshes.clone_from(&meshes);
    }
    match BlockSet::new(meshes) {
        Ok(blocks) => {
            input.scene.iter().for_each(|scene| measured.of_scene(scene, &blocks));
            finish(args, events, &measured, &input, &blocks)
        }
        Err(error) => {
            events.emit("measured", &json!({"report": measured}));
            if !args.json {
                say(&measured.to_string());
            }
            events.fail(exit::BAD_INPUT, &mesh_report::refusal(&args.input, &error))
        }
    }
}

fn is_scene(path: &Path) -> bool {
    path.extension().is_none_or(|ending| ending.eq_ignore_ascii_case("ron"))
}

fn from_scene(args: &MeshArgs) -> Result<Input, Refused> {
    if !args.fix.is_empty() {
        return Err(bad_input("--fix is for mesh files: correct a scene where it is written"));
    }
    let loaded = load(&args.input, &args.overrides)?;
    let folder = args.input.parent().unwrap_or(Path::new("."));
    input::warn_of_slow_build(&loaded, folder);
    forecast::admit::admit(&loaded, folder).map_err(|refused| loaded.errors(vec![refused]))?;
    let (meshes, rock) = build::meshes(&loaded.scene, folder).map_err(|faults| {
        let diagnostics = faults.into_iter().map(|f| loaded.diagnose(&f.path, f.message)).collect();
        loaded.errors(diagnostics)
    })?;
    Ok(Input { meshes, scene: Some(loaded.scene), rock, fixes: Vec::new() })
}

fn from_file(args: &MeshArgs) -> Result<Input, Refused> {
    if !args.overrides.is_empty() {
        return Err(bad_input("--set changes scenes, and this is a mesh file: leave it out"));
    }
    forecast::admit::admit_file(&args.input).map_err(|message| Refused::Message(exit::RESOURCE, message))?;
    let repairs = args.fix.iter().map(|fix| match fix {
        Fix::Orient => Repair::Orient,
        Fix::Merge => Repair::Merge(args.within),
    });
    let (meshes, fixes) = mesh_input::read(&args.input, &repairs.collect::<Vec<_>>()).map_err(bad_input)?;
    Ok(Input { meshes, scene: None, rock: Vec::new(), fixes })
}

fn finish(args: &MeshArgs, events: Events, measured: &MeshReport, input: &Input, blocks: &BlockSet) -> u8 {
    let folder = places::folder_for(args.out.as_deref(), &args.input, "_mesh");
    let written = MeshFiles {
        input: &args.input,
        also: &args.also,
        measured,
        meshes: &input.meshes,
        rock: &input.rock,
    };
    match written.write(&folder, args.force, blocks) {
        Ok(files) => {
            events.emit("measured", &json!({"report": measured}));
            events.emit("finished", &json!({"exit_code": exit::DONE, "folder": folder}));
            if !args.json {
                say(&format!("{}: no errors in the blocks\n{measured}{files}", args.input.display()));
            }
            exit::DONE
        }
        Err(error) => events.fail(exit::INPUT_OUTPUT, &error.to_string()),
    }
}
