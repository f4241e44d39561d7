//! `ndda run`: a scene from its text to its files.

use std::path::{Path, PathBuf};
use std::time::Instant;

use ndda_io::{OutputFolder, WriteError, summary};
use ndda_solver::{RunError, Sink, StepError};

use crate::args::RunArgs;
use crate::check::{Ready, prepare};
use crate::console::{colour, complain, say};
use crate::progress::Progress;
use crate::recorder::{FieldWriter, Recorder};
use crate::reference::{self, Comparison};
use crate::report::{self, Outcome};
use crate::{exit, wiring};

/// Runs `ndda run`; returns the exit code.
pub fn run(args: &RunArgs) -> u8 {
    let threads = args.threads.map_or(0, usize::from);
    let pool = match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool,
        Err(error) => {
            complain(&format!("error: cannot start {threads} threads: {error}; use a smaller --threads"));
            return exit::RESOURCE;
        }
    };
    // Everything runs inside the pool: a step handed in from outside would allocate.
    pool.install(|| run_here(args, pool.current_num_threads()))
}

fn run_here(args: &RunArgs, threads: usize) -> u8 {
    let started = Instant::now();
    let ready = match prepare(&args.scene, &args.overrides) {
        Ok(ready) => ready,
        Err(errors) => {
            complain(&errors.render(colour()));
            return exit::BAD_INPUT;
        }
    };
    if !ready.loaded.warnings.is_empty() && !args.quiet {
        complain(&ready.loaded.errors(ready.loaded.warnings.clone()).render(colour()));
    }
    match run_ready(args, ready, threads, started) {
        Ok(code) => code,
        Err(error) => {
            complain(&format!("error: {error}"));
            exit::INPUT_OUTPUT
        }
    }
}

/// Name of a scene: its file without the ending.
fn scene_name(scene: &Path) -> String {
    scene.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy().into_owned())
}

fn run_ready(args: &RunArgs, ready: Ready, threads: usize, started: Instant) -> Result<u8, WriteError> {
    let Ready { loaded, mut simulation, monitors } = ready;
    let (scene, name) = (&loaded.scene, scene_name(&args.scene));
    let folder = args.out.clone().unwrap_or_else(|| PathBuf::from("out").join(&name));
    let folder = OutputFolder::create(&folder, args.force)?;
    let steps = wiring::steps(&scene.time);
    let comparison = Comparison::new(scene, &simulation, &monitors);
    let after_s = scene.reference.as_ref().map_or(0.0, |r| reference::kind(r).1);
    let rows = u64::from(scene.output.history_rows);
    let mut recorder = Recorder::new(&folder, monitors, comparison, after_s, steps, rows)?;
    let frames = u64::from(scene.output.frames);
    let mut fields =
        if frames > 0 { Some(FieldWriter::new(&folder, &simulation, steps, frames)?) } else { None };
    let mut progress = Progress::new(steps, args.quiet);
    let setup_s = started.elapsed().as_secs_f64();

    let mut sinks: Vec<&mut dyn Sink> = vec![&mut recorder, &mut progress];
    if let Some(fields) = &mut fields {
        sinks.push(fields);
    }
    let ended = ndda_solver::run(&mut simulation, steps, &mut sinks);
    progress.finish();
    recorder.finish()?;
    let stopped_by = match ended {
        Ok(()) => None,
        Err(error) => Some(numerical_stop(error)?),
    };

    let output_s = recorder.spent_s + fields.as_ref().map_or(0.0, |f| f.spent_s);
    let outcome = Outcome {
        scene,
        name: &name,
        stopped_by,
        wall_s: started.elapsed().as_secs_f64(),
        threads,
        stages: vec![("output".into(), output_s), ("setup".into(), setup_s)],
        warnings: loaded.warnings.iter().map(|w| w.message.clone()).collect(),
        strict: args.strict,
    };
    let summary = report::summarise(&simulation, &recorder, outcome);
    summary::write(&folder.summary(), &summary)?;
    if !args.quiet {
        say(&format!("{}results in {}", report::table(&summary), folder.path().display()));
    }
    for (name, _) in summary.verdicts.0.iter().filter(|(_, v)| v.verdict == summary::Judgement::Fail) {
        complain(&format!("warning: {name} is beyond its limit: do not use this result"));
    }
    Ok(match summary.status {
        summary::Status::Done => exit::DONE,
        summary::Status::Failed => exit::FAILED,
        summary::Status::Stopped | summary::Status::Interrupted => {
            if let Some(cause) = &summary.stopped_by {
                complain(&format!("error: stopped {cause}"));
            }
            exit::STOPPED
        }
    })
}

/// The cause of a numerical stop in words; errors of output are handed on.
fn numerical_stop(error: RunError) -> Result<String, WriteError> {
    match error {
        RunError::Step(step) => Ok(step.to_string()),
        RunError::Sink(sink) => match sink.downcast::<StepError>() {
            Ok(step) => Ok(step.to_string()),
            Err(other) => match other.downcast::<WriteError>() {
                Ok(write) => Err(*write),
                Err(unknown) => Ok(unknown.to_string()),
            },
        },
    }
}
