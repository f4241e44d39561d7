//! `ndda run`: a scene from its text to its files.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use ndda_io::{OutputFolder, WriteError, checkpoint, summary};
use ndda_solver::{RunError, Settle, StepError};

use crate::args::{HowArgs, RunArgs};
use crate::check::Ready;
use crate::checkpoint::{Earlier, Identity, Outputs};
use crate::console::{colour, complain, say};
use crate::progress::Progress;
use crate::recorder::{FieldWriter, Recorder};
use crate::reference::{self, Comparison};
use crate::report::{self, Outcome};
use crate::{exit, input, interrupt, wiring};

/// Runs a scene and reports; the result is the exit code.
pub fn run(args: &RunArgs) -> u8 {
    in_pool(&args.how, |options| run_here(args, options))
}

/// Does `work` on as many threads as are asked for.
pub fn in_pool(how: &HowArgs, work: impl FnOnce(&Options) -> u8 + Send) -> u8 {
    let started = Instant::now();
    let threads = how.threads.map_or(0, usize::from);
    let pool = match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool,
        Err(error) => {
            complain(&format!("error: cannot start {threads} threads: {error}; use a smaller --threads"));
            return exit::RESOURCE;
        }
    };
    // Everything runs inside the pool: a step handed in from outside would allocate.
    let threads = pool.current_num_threads();
    pool.install(|| work(&Options { threads, strict: how.strict, quiet: how.quiet, started }))
}

/// How to run, whatever the scene.
pub struct Options {
    /// Threads.
    pub threads: usize,
    /// Whether a limit that is passed fails the run.
    pub strict: bool,
    /// No progress and no table.
    pub quiet: bool,
    /// When this process began.
    pub started: Instant,
}

/// A run that begins or goes on.
pub struct Job {
    /// The scene and its simulation.
    pub ready: Ready,
    /// The closed form, bound to the blocks as they were at the start.
    pub comparison: Option<Comparison>,
    /// Which scene it is.
    pub identity: Identity,
    /// Where results go.
    pub folder: OutputFolder,
    /// Where it goes on from.
    pub earlier: Option<Earlier>,
}

fn run_here(args: &RunArgs, options: &Options) -> u8 {
    let ready = match input::ready(&args.input) {
        Ok(ready) => ready,
        Err(code) => return code,
    };
    if !ready.loaded.warnings.is_empty() && !options.quiet {
        complain(&ready.loaded.errors(ready.loaded.warnings.clone()).render(colour()));
    }
    let file = input::file(&args.input);
    let name = scene_name(&file);
    let folder = args.out.clone().unwrap_or_else(|| PathBuf::from("out").join(&name));
    let folder = match OutputFolder::create(&folder, args.force) {
        Ok(folder) => folder,
        Err(error) => {
            complain(&format!("error: {error}"));
            return exit::INPUT_OUTPUT;
        }
    };
    let file = std::path::absolute(&file).unwrap_or(file);
    let identity = Identity { name, text: ready.loaded.text.clone(), file };
    let comparison = ready.comparison();
    execute(Job { ready, comparison, identity, folder, earlier: None }, options)
}

fn scene_name(scene: &Path) -> String {
    scene.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy().into_owned())
}

/// Runs to the end and reports; the result is the exit code.
pub fn execute(job: Job, options: &Options) -> u8 {
    match run_job(job, options) {
        Ok(code) => code,
        Err(error) => {
            complain(&format!("error: {error}"));
            exit::INPUT_OUTPUT
        }
    }
}

fn run_job(job: Job, options: &Options) -> Result<u8, WriteError> {
    let Job { ready: Ready { loaded, mut simulation, monitors }, comparison, identity, folder, earlier } =
        job;
    let scene = &loaded.scene;
    if let (Some(settle), None) = (&scene.settle, &earlier) {
        let settle = Settle { tolerance: settle.tolerance, most_steps: settle.most_steps };
        match simulation.settle(&settle) {
            Ok(settled) if !options.quiet => complain(&format!("settled in {} steps", settled.steps)),
            Ok(_) => {}
            Err(error) => {
                complain(&format!("error: stopped {}", stop(&error)));
                return Ok(exit::STOPPED);
            }
        }
    }
    let (steps, name) = (wiring::steps(&scene.time), identity.name.clone());
    let after_s = scene.reference.as_ref().map_or(0.0, |r| reference::kind(r).1);
    let (rows, frames) = (u64::from(scene.output.history_rows), u64::from(scene.output.frames));
    let goes_on = earlier.is_some();
    let earlier_s = earlier.as_ref().map_or(0.0, |earlier| earlier.wall_s);
    let (saved_recorder, saved_fields) = earlier.map_or((None, None), |e| (Some(e.recorder), e.fields));
    let recorder = Recorder::new(&folder, monitors, comparison, after_s, (steps, rows), saved_recorder)?;
    let fields = || FieldWriter::new(&folder, &simulation, (steps, frames), saved_fields);
    let mut outputs = Outputs {
        recorder,
        fields: if frames > 0 { Some(fields()?) } else { None },
        progress: Progress::new(simulation.state().step, steps, options.quiet),
        identity,
        folder: &folder,
        steps,
        every: Duration::from_secs_f64(scene.output.checkpoint_wall_s),
        last: Instant::now(),
        started: options.started,
        earlier_s,
        spent_s: 0.0,
        asked_to_end: interrupt::watch(),
    };
    let setup_s = options.started.elapsed().as_secs_f64();
    let ended = if goes_on {
        ndda_solver::resume(&mut simulation, steps, &mut [&mut outputs])
    } else {
        ndda_solver::run(&mut simulation, steps, &mut [&mut outputs])
    };
    outputs.progress.finish();
    outputs.recorder.finish()?;
    let stopped_by = match ended {
        Ok(()) => None,
        Err(error) => Some(numerical_stop(error)?),
    };
    let Outputs { recorder, fields, spent_s, .. } = outputs;
    let output_s = recorder.spent_s + fields.as_ref().map_or(0.0, |f| f.spent_s) + spent_s;
    let outcome = Outcome {
        scene,
        name: &name,
        stopped_by,
        interrupted: simulation.state().step < steps,
        wall_s: earlier_s + options.started.elapsed().as_secs_f64(),
        threads: options.threads,
        stages: vec![("output".into(), output_s), ("setup".into(), setup_s)],
        warnings: loaded.warnings.iter().map(|w| w.message.clone()).collect(),
        strict: options.strict,
        state_crc32: checkpoint::fingerprint(simulation.state()),
    };
    let summary = report::summarise(&simulation, &recorder, outcome);
    summary::write(&folder.summary(), &summary)?;
    if !options.quiet {
        say(&format!("{}results in {}", report::table(&summary), folder.path().display()));
    }
    Ok(conclude(&summary))
}

/// Says what is beyond its limit, and gives the exit code.
fn conclude(summary: &summary::Summary) -> u8 {
    for (name, _) in summary.verdicts.0.iter().filter(|(_, v)| v.verdict == summary::Judgement::Fail) {
        complain(&format!("warning: {name} is beyond its limit: do not use this result"));
    }
    match summary.status {
        summary::Status::Done => exit::DONE,
        summary::Status::Failed => exit::FAILED,
        summary::Status::Interrupted => {
            complain(&format!("interrupted at t = {} s: `ndda resume` goes on from here", summary.end_s));
            exit::INTERRUPTED
        }
        summary::Status::Stopped => {
            if let Some(cause) = &summary.stopped_by {
                complain(&format!("error: stopped {cause}"));
            }
            exit::STOPPED
        }
    }
}

/// A numerical stop in words, after its code.
fn stop(error: &StepError) -> String {
    format!("[{}] {error}", error.code())
}

/// The cause of a numerical stop in words; errors of output are handed on.
fn numerical_stop(error: RunError) -> Result<String, WriteError> {
    match error {
        RunError::Step(step) => Ok(stop(&step)),
        RunError::Sink(sink) => match sink.downcast::<StepError>() {
            Ok(step) => Ok(stop(&step)),
            Err(other) => match other.downcast::<WriteError>() {
                Ok(write) => Err(*write),
                Err(unknown) => Ok(unknown.to_string()),
            },
        },
    }
}
