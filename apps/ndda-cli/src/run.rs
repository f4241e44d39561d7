//! `ndda run`: a scene from its text to its files.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use ndda_io::scene::Scene;
use ndda_io::summary::{Judgement, Status, Summary};
use ndda_io::{OutputFolder, WriteError, checkpoint, summary, tables};
use ndda_solver::{RunError, Settle, Settled, Simulation, StepError};
use serde::Serialize;

use crate::args::{HowArgs, RunArgs};
use crate::check::Ready;
use crate::checkpoint::{Earlier, Identity, Outputs};
use crate::console::{complain, say};
use crate::contacts::ContactTable;
use crate::events::{self, Events};
use crate::fields::FieldWriter;
use crate::monitor::Monitor;
use crate::progress::Progress;
use crate::recorder::{Recorder, held_blocks};
use crate::reference::{self, Comparison};
use crate::report::{self, Outcome};
use crate::run_log::RunLog;
use crate::{exit, input, interrupt, wiring};

/// How often a scene that settles says how far it is.
const SAY_SETTLING: Duration = Duration::from_secs(2);

/// Runs a scene and reports; the result is the exit code.
pub fn run(args: &RunArgs) -> u8 {
    in_pool(&args.how, |options| run_here(args, options))
}

/// Does `work` on as many threads as are asked for.
pub fn in_pool(how: &HowArgs, work: impl FnOnce(&Options) -> u8 + Send) -> u8 {
    let started = Instant::now();
    let events = Events::new(how.json, events::RUN);
    let threads = how.threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    // This thread is the first of them, if it is in no pool yet: a small scene is over before another has woken up.
    let pool = if rayon::current_thread_index().is_none() { pool.use_current_thread() } else { pool };
    let pool = match pool.build() {
        Ok(pool) => pool,
        Err(error) => {
            let message = format!("cannot start {threads} threads: {error}; use a smaller --threads");
            return events.fail(exit::RESOURCE, &message);
        }
    };
    // Everything runs inside the pool: a step handed in from outside would allocate.
    let threads = pool.current_num_threads();
    let quiet = how.quiet || how.json;
    pool.install(|| work(&Options { threads, strict: how.strict, quiet, events, started }))
}

/// How to run, whatever the scene.
pub struct Options {
    /// Threads.
    pub threads: usize,
    /// Whether a limit that is passed fails the run.
    pub strict: bool,
    /// No progress and no table.
    pub quiet: bool,
    /// What programs read.
    pub events: Events,
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
    let ready = match input::ready(&args.input, options.events) {
        Ok(ready) => ready,
        Err(code) => return code,
    };
    if !ready.loaded.warnings.is_empty() && (!options.quiet || options.events.are_read()) {
        options.events.doubt(&ready.loaded.errors(ready.loaded.warnings.clone()));
    }
    let file = input::file(&args.input);
    let name = scene_name(&file);
    let folder = args.out.clone().unwrap_or_else(|| PathBuf::from("out").join(&name));
    let folder = match OutputFolder::create(&folder, args.force) {
        Ok(folder) => folder,
        Err(error) => return options.events.fail(exit::INPUT_OUTPUT, &error.to_string()),
    };
    let file = std::path::absolute(&file).unwrap_or(file);
    let identity = Identity::new(name, ready.loaded.text.clone(), file, &ready.loaded.scene);
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
        // A number that is not finite is the fault of the run, not of the disk.
        Err(error @ WriteError::NotFinite { .. }) => options.events.fail(exit::STOPPED, &error.to_string()),
        Err(error) => options.events.fail(exit::INPUT_OUTPUT, &error.to_string()),
    }
}

#[derive(Serialize)]
struct Started<'a> {
    version: &'static str,
    scene: &'a str,
    title: &'a str,
    folder: &'a Path,
    threads: usize,
    step: u64,
    steps: u64,
    step_s: f64,
    blocks: usize,
    tets: usize,
    unknowns: usize,
}

fn run_job(mut job: Job, options: &Options) -> Result<u8, WriteError> {
    let mut log = RunLog::open(&job.folder, options.started)?;
    log.begin(&job.identity, options.threads)?;
    for warning in &job.ready.loaded.warnings {
        log.line(&format!("warning: {}: {}", warning.path, warning.message))?;
    }
    let (steps, simulation) = (wiring::steps(&job.ready.loaded.scene.time), &job.ready.simulation);
    options.events.emit(
        "started",
        &Started {
            version: env!("CARGO_PKG_VERSION"),
            scene: &job.identity.name,
            title: &job.ready.loaded.scene.title,
            folder: job.folder.path(),
            threads: options.threads,
            step: simulation.state().step,
            steps,
            step_s: simulation.step_s(),
            blocks: simulation.blocks().len(),
            tets: simulation.blocks().tets.len(),
            unknowns: simulation.unknowns(),
        },
    );
    let settling = Instant::now();
    let asked_to_end = interrupt::watch();
    if let Err((code, message)) = settle(&mut job, &mut log, options, &asked_to_end)? {
        log.line(&message)?;
        return Ok(options.events.fail(code, &message));
    }
    log.line(&format!("from step {} of {steps}", job.ready.simulation.state().step))?;
    let setup = Setup { settled_s: settling.elapsed().as_secs_f64(), steps, asked_to_end };
    let summary = step_to_end(job, setup, options, &mut log)?;
    Ok(conclude(&summary, options))
}

/// Brings the scene to rest, if it asks for that and has not been; exit code and message where that comes to nothing.
fn settle(
    job: &mut Job,
    log: &mut RunLog,
    options: &Options,
    asked_to_end: &AtomicBool,
) -> Result<Result<(), (u8, String)>, WriteError> {
    let (Some(settle), None) = (&job.ready.loaded.scene.settle, &job.earlier) else { return Ok(Ok(())) };
    let settle = Settle { tolerance: settle.tolerance, most_steps: settle.most_steps };
    let mut said = Instant::now();
    let mut watch = |settled: &Settled| {
        if !options.quiet && said.elapsed() >= SAY_SETTLING {
            said = Instant::now();
            let Settled { steps, speed_ratio, .. } = settled;
            let until = settle.tolerance;
            complain(&format!(
                "settling: {steps} steps, speed {speed_ratio:.1e} of the largest, until {until:e}"
            ));
        }
        if asked_to_end.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    match job.ready.simulation.settle_watched(&settle, &mut watch) {
        Ok(_) if asked_to_end.load(Ordering::Relaxed) => {
            Ok(Err((exit::INTERRUPTED, "interrupted while the scene settled: run it again".into())))
        }
        Ok(settled) => {
            let text = format!("settled in {} steps", settled.steps);
            log.line(&text)?;
            if !options.quiet {
                complain(&text);
            }
            Ok(Ok(()))
        }
        Err(error) => Ok(Err((exit::STOPPED, format!("stopped {}", stop(&error))))),
    }
}

/// What went before the first step, and how many there are to be.
struct Setup {
    /// Settling, whose steps are in the stages of steps [s].
    settled_s: f64,
    steps: u64,
    /// Raised when somebody asks the run to end.
    asked_to_end: Arc<AtomicBool>,
}

/// Runs, and writes all that there is to be known.
fn step_to_end(job: Job, setup: Setup, options: &Options, log: &mut RunLog) -> Result<Summary, WriteError> {
    let Job { ready: Ready { loaded, mut simulation, monitors }, comparison, identity, folder, earlier } =
        job;
    let (scene, Setup { settled_s, steps, asked_to_end }) = (&loaded.scene, setup);
    let (name, goes_on) = (identity.name.clone(), earlier.is_some());
    let earlier_s = earlier.as_ref().map_or(0.0, |earlier| earlier.wall_s);
    let points = (monitors, comparison);
    let mut outputs =
        outputs(scene, &simulation, points, (identity, &folder, earlier), (steps, asked_to_end), options)?;
    let setup_s = options.started.elapsed().as_secs_f64() - settled_s;
    let ended = if goes_on {
        ndda_solver::resume(&mut simulation, steps, &mut [&mut outputs])
    } else {
        ndda_solver::run(&mut simulation, steps, &mut [&mut outputs])
    };
    outputs.progress.finish();
    let stopped_by = ended.map_or_else(|error| numerical_stop(error).map(Some), |()| Ok(None))?;
    outputs.flush()?;
    let output_s = outputs.output_s();
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
    let summary = report::summarise(&simulation, &outputs.recorder, outcome);
    write_results(&folder, scene, &summary, log)?;
    if !options.quiet {
        say(&format!("{}results in {}", report::table(&summary), folder.path().display()));
    }
    Ok(summary)
}

/// Writes what is written at the end only.
fn write_results(
    folder: &OutputFolder,
    scene: &Scene,
    summary: &Summary,
    log: &mut RunLog,
) -> Result<(), WriteError> {
    let has_ended = matches!(summary.status, Status::Done | Status::Failed);
    #[cfg(feature = "parquet")]
    if has_ended {
        tables::write_parquet(folder, &scene.output)?;
    }
    summary::write(&folder.summary(), summary)?;
    if has_ended {
        tables::remove_csv(folder, &scene.output)?;
    }
    log.line("ended")?;
    log.block(&report::table(summary))
}

/// All that watches a run.
fn outputs<'a>(
    scene: &Scene,
    simulation: &Simulation,
    (monitors, comparison): (Vec<Monitor>, Option<Comparison>),
    (identity, folder, earlier): (Identity, &'a OutputFolder, Option<Earlier>),
    (steps, asked_to_end): (u64, Arc<AtomicBool>),
    options: &Options,
) -> Result<Outputs<'a>, WriteError> {
    let earlier_s = earlier.as_ref().map_or(0.0, |earlier| earlier.wall_s);
    let (saved_recorder, saved_fields, saved_contacts) =
        earlier.map_or((None, None, None), |e| (Some(e.recorder), e.fields, e.contacts));
    let after_s = scene.reference.as_ref().map_or(0.0, |r| reference::kind(r).1);
    let rows = (steps, u64::from(scene.output.history_rows));
    let held = if scene.output.reactions { held_blocks(simulation) } else { Vec::new() };
    let contacts = || ContactTable::new(folder, rows, saved_contacts);
    let fields = || FieldWriter::new(folder, simulation, scene, steps, saved_fields);
    Ok(Outputs {
        recorder: Recorder::new(folder, monitors, comparison, after_s, rows, held, saved_recorder)?,
        fields: (scene.output.frames > 0).then(fields).transpose()?,
        contacts: scene.output.contacts.then(contacts).transpose()?,
        progress: Progress::new(simulation.state().step, steps, options),
        identity,
        folder,
        steps,
        every: Duration::from_secs_f64(scene.output.checkpoint_wall_s),
        last: Instant::now(),
        started: options.started,
        earlier_s,
        spent_s: 0.0,
        asked_to_end,
    })
}

#[derive(Serialize)]
struct Finished<'a> {
    exit_code: u8,
    summary: &'a Summary,
}

/// Says what is beyond its limit, and gives the exit code.
fn conclude(summary: &Summary, options: &Options) -> u8 {
    for (name, _) in summary.verdicts.0.iter().filter(|(_, v)| v.verdict == Judgement::Fail) {
        options.events.warn(&format!("{name} is beyond its limit: do not use this result"));
    }
    let exit_code = match summary.status {
        Status::Done => exit::DONE,
        Status::Failed => exit::FAILED,
        Status::Interrupted => {
            complain(&format!("interrupted at t = {} s: `ndda resume` goes on from here", summary.end_s));
            exit::INTERRUPTED
        }
        Status::Stopped => {
            if let Some(cause) = &summary.stopped_by {
                complain(&format!("error: stopped {cause}"));
            }
            exit::STOPPED
        }
    };
    options.events.emit("finished", &Finished { exit_code, summary });
    exit_code
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
                Ok(write) if matches!(*write, WriteError::NotFinite { .. }) => Ok(write.to_string()),
                Ok(write) => Err(*write),
                Err(unknown) => Ok(unknown.to_string()),
            },
        },
    }
}
