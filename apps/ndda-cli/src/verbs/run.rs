//! `ndda run`: a scene from its text to its files.

use std::path::Path;
use std::time::Instant;

use ndda::judge::table;
use ndda::run::{Resting, Sensitivity};
use ndda::summary::{LabelWord, Status, Summary};
use ndda::{Run, RunError, places};
use ndda_io::{OutputFolder, WriteError};
use serde::Serialize;

use crate::args::{HowArgs, RunArgs};
use crate::terminal::console::{complain, complain_unless, is_coloured, say};
use crate::terminal::events::{self, Events};
use crate::terminal::interrupt;
use crate::terminal::progress::Progress;
use crate::{exit, input};

/// Runs a scene and reports; the result is the exit code.
pub fn run(args: &RunArgs) -> u8 {
    in_pool(&args.how, |options| run_here(args, options))
}

/// Does `work` on as many threads as are requested.
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
    let quiet = how.quiet || how.json;
    let (strict, verbose) = (how.strict, how.verbose);
    pool.install(|| work(&Options { strict, sensitivity: how.sensitivity, quiet, verbose, events, started }))
}

/// How to run, whatever the scene.
pub struct Options {
    /// Whether a limit that is passed fails the run.
    pub strict: bool,
    /// When a twin shows whether the motion is sensitive, where that is said.
    pub sensitivity: Option<Sensitivity>,
    /// No progress and no result.
    pub quiet: bool,
    /// All tables at the end.
    pub verbose: bool,
    /// Event stream for other programs.
    pub events: Events,
    /// When this process began.
    pub started: Instant,
}

fn run_here(args: &RunArgs, options: &Options) -> u8 {
    let model = match input::model(&args.input, options.events) {
        Ok(model) => model,
        Err(code) => return code,
    };
    if !options.quiet || options.events.are_read() {
        input::warn(&model.loaded, options.events);
    }
    let file = input::file(&args.input);
    let folder = places::folder_for(args.out.as_deref(), &file, "");
    let file = std::path::absolute(&file).unwrap_or(file);
    let run = Run::new(model).started(options.started);
    let recorded = OutputFolder::create(&folder, args.force)
        .and_then(|folder| Ok((folder.path().to_path_buf(), run.record(folder, file)?)));
    match recorded {
        Ok((folder, run)) => execute(run, &folder, options),
        Err(error) => options.events.fail(exit::of_write(&error), &error.to_string()),
    }
}

/// Runs to the end and reports; the result is the exit code.
pub fn execute(run: Run, folder: &Path, options: &Options) -> u8 {
    let run = options.sensitivity.into_iter().fold(run, Run::sensitivity).strict(options.strict);
    let run = run.stop_when(interrupt::watch()).tell(complain_unless(options.quiet));
    let (steps, simulation) = (run.model().steps(), &run.model().simulation);
    // Steps of settling are none of the run.
    let first = run.settling_steps().map_or(simulation.state().step, |_| 0);
    options.events.emit(
        "started",
        &serde_json::json!({
            "version": env!("CARGO_PKG_VERSION"),
            "scene": run.name(),
            "title": run.model().loaded.scene.title,
            "folder": folder,
            "threads": rayon::current_num_threads(),
            "step": first,
            "steps": steps,
            "step_s": simulation.step_s(),
            "blocks": simulation.blocks().len(),
            "tets": simulation.blocks().tets.len(),
            "unknowns": simulation.unknowns(),
        }),
    );
    let mut progress = Progress::new(first, steps, options.quiet, options.events);
    let tell = complain_unless(options.quiet);
    let mut to_rest = |resting: &Resting| tell(&resting.to_string());
    let outcome = run.finish_watched(&mut [&mut progress], &mut to_rest);
    progress.finish();
    match outcome {
        Ok(outcome) => {
            if !options.quiet {
                say_result(&outcome.summary, folder, options.verbose);
            }
            conclude(&outcome.summary, folder, options)
        }
        Err(error) => {
            let code = match &error {
                RunError::Settling(_) => exit::STOPPED,
                RunError::InterruptedWhileSettling => exit::INTERRUPTED,
                // A number that is not finite is the fault of the run, not of the disk.
                RunError::Write(WriteError::NotFinite { .. }) => exit::STOPPED,
                RunError::Write(_) => exit::INPUT_OUTPUT,
            };
            let code = options.events.fail(code, &error.to_string());
            if !options.quiet && folder.join(OutputFolder::SUMMARY).exists() {
                let goes_on = if code == exit::INTERRUPTED { "resume" } else { "picture" };
                say(&format!("results in {0}; next: ndda {goes_on} {0}", folder.display()));
            }
            code
        }
    }
}

/// Prints the result of a run for a person.
fn say_result(summary: &Summary, folder: &Path, verbose: bool) {
    if verbose {
        say(&table::text(summary));
    }
    let folder = folder.display();
    let next = if cfg!(feature = "report") { format!("; next: ndda view {folder}") } else { String::new() };
    say(&format!("{}results in {folder}{next}", paint(&table::ending(summary), summary.label.word)));
}

/// The label in colour on a terminal: green, yellow or red.
fn paint(text: &str, word: LabelWord) -> String {
    let colour = match word {
        LabelWord::Accurate => 32,
        LabelWord::Sensitive | LabelWord::Inaccurate => 33,
        LabelWord::Stopped => 31,
    };
    match text.strip_prefix(word.as_str()) {
        Some(rest) if is_coloured() => format!("\x1b[1;{colour}m{}\x1b[0m{rest}", word.as_str()),
        _ => text.to_string(),
    }
}

#[derive(Serialize)]
struct Finished<'a> {
    exit_code: u8,
    summary: &'a Summary,
}

/// Says how a run ended that did not reach its end, and gives the exit code.
fn conclude(summary: &Summary, folder: &Path, options: &Options) -> u8 {
    let exit_code = match summary.status {
        Status::Done => exit::DONE,
        Status::Failed => exit::FAILED,
        Status::Interrupted => {
            let end_s = ndda_solver::shown_time_s(summary.end_s);
            complain(&format!("interrupted at t = {end_s} s; to go on: ndda resume {}", folder.display()));
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
