//! `fork PART run SCENE FOLDER [KEY=VALUE …]` and `fork PART resume FOLDER`.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

use ndda::{Model, Run};
use ndda_io::{OutputFolder, read};

fn main() -> ExitCode {
    run().map_or_else(
        |error| {
            eprintln!("{error}");
            ExitCode::FAILURE
        },
        |()| ExitCode::SUCCESS,
    )
}

fn run() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let part = words.first().map_or("", String::as_str);
    let choices = fork::choices(part).ok_or_else(|| format!("`{part}` is none of {:?}", fork::PARTS))?;
    let run = match words.get(1..) {
        Some([verb, scene, folder, set @ ..]) if verb == "run" => {
            let file = Path::new(scene);
            let loaded = read::load(file, set)?;
            let model = Model::with(loaded, file.parent().unwrap_or(Path::new(".")), choices)?;
            Run::new(model).record(OutputFolder::create(Path::new(folder), true)?, file.into())?
        }
        Some([verb, folder]) if verb == "resume" => Run::resume_with(Path::new(folder), choices)?.run,
        _ => return Err("fork PART run SCENE FOLDER [KEY=VALUE …], or fork PART resume FOLDER".into()),
    };
    let summary = run.finish(&mut [])?.summary;
    println!("{:?}: {} steps, state {}", summary.status, summary.steps, summary.state_crc32);
    Ok(())
}
