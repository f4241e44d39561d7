//! What each rank does of a run.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use ndda::judge::table;
use ndda::run::{Pace, ResumeError, Resumed};
use ndda::summary::{Status, Summary};
use ndda::{Model, Run, RunError, places};
use ndda_io::{OutputFolder, WriteError};
use ndda_ranks::{Communicator, RanksError};
use ndda_solver::{Sink, SinkError, View};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use crate::args::{HowArgs, ResumeArgs, RunArgs};

/// The run reached its end, but a criterion was not met.
const FAILED: u8 = 1;
/// The scene or a mesh is not usable.
const BAD_INPUT: u8 = 3;
/// Files could not be written.
const INPUT_OUTPUT: u8 = 5;
/// Threads or memory could not be had.
pub const RESOURCE: u8 = 6;
/// Somebody asked the run to end; it can be resumed.
const INTERRUPTED: u8 = 130;

/// How often the first rank says how far a run is.
const SAY: Duration = Duration::from_secs(10);

/// Why a rank cannot go on.
pub struct Failure {
    /// Exit code.
    pub code: u8,
    /// What is wrong and what to change.
    pub message: String,
}

impl Failure {
    fn of(code: u8, error: &dyn std::fmt::Display) -> Self {
        Self { code, message: format!("error: {error}") }
    }
}

impl From<RanksError> for Failure {
    fn from(error: RanksError) -> Self {
        Self::of(crate::STOPPED, &error)
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        // A number that is not finite is the fault of the run, not of the disk.
        let code = if matches!(error, WriteError::NotFinite { .. }) { crate::STOPPED } else { INPUT_OUTPUT };
        Self::of(code, &error)
    }
}

/// A verb of `ndda` that needs one process.
pub fn refuse(words: &[String]) -> Failure {
    let verb = words.first().map_or("", String::as_str);
    Failure::of(
        crate::USAGE,
        &format!(
            "ndda-mpi runs and resumes scenes, and cannot `{verb}`: use `ndda {}` on one process",
            words.join(" ")
        ),
    )
}

/// `ndda-mpi run`.
pub fn run(args: &RunArgs, ranks: &Arc<dyn Communicator>) -> Result<u8, Failure> {
    let started = Instant::now();
    let unusable =
        |errors: ndda_io::diagnostic::SceneErrors| Failure { code: BAD_INPUT, message: errors.render(false) };
    let model = Model::open(&args.scene, &args.overrides).map_err(unusable)?;
    if ranks.rank() == 0 && !args.how.quiet && !model.loaded.warnings.is_empty() {
        eprintln!("{}", model.loaded.errors(model.loaded.warnings.clone()).render(false).trim_end());
    }
    let folder = places::folder_for(args.out.as_deref(), &args.scene, "");
    let mut run = Run::new(model).started(started);
    // Nothing is replaced before all ranks are ready.
    run = run.on_ranks(ranks)?;
    if ranks.rank() == 0 {
        let file = std::path::absolute(&args.scene).unwrap_or_else(|_| args.scene.clone());
        run = run.record(OutputFolder::create(&folder, args.force)?, file)?;
    }
    finish(run, &folder, &args.how, ranks)
}

/// `ndda-mpi resume`.
pub fn resume(args: &ResumeArgs, ranks: &Arc<dyn Communicator>) -> Result<u8, Failure> {
    let Resumed { run, warnings } = match Run::resume_on_ranks(&args.folder, ranks) {
        Ok(resumed) => resumed,
        Err(error @ ResumeError::HasEnded(_)) => {
            say(ranks, &args.how, &error.told(args.how.sensitivity));
            return Ok(crate::DONE);
        }
        Err(ResumeError::Ranks(error)) => return Err(error.into()),
        Err(ResumeError::Write(error)) => return Err(error.into()),
        Err(error) => return Err(Failure::of(BAD_INPUT, &error)),
    };
    warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
    let (step, steps) = (run.model().simulation.state().step, run.model().steps());
    say(
        ranks,
        &args.how,
        &match run.settling_steps() {
            Some(settled) => format!("going on with settling after {settled} steps"),
            None => format!("going on from step {step} of {steps}"),
        },
    );
    finish(run, &args.folder, &args.how, ranks)
}

fn say(ranks: &Arc<dyn Communicator>, how: &HowArgs, text: &str) {
    if ranks.rank() == 0 && !how.quiet {
        println!("{}", text.trim_end());
    }
}

/// Runs to the end; the first rank reports.
fn finish(run: Run, folder: &Path, how: &HowArgs, ranks: &Arc<dyn Communicator>) -> Result<u8, Failure> {
    let speaks = ranks.rank() == 0 && !how.quiet;
    let tell = move |text: &str| {
        if speaks {
            eprintln!("{text}");
        }
    };
    let (step, steps) = (run.model().simulation.state().step, run.model().steps());
    let threads = rayon::current_num_threads();
    say(ranks, how, &format!("{} on {} ranks with {threads} threads each", run.name(), ranks.size()));
    let run = how.sensitivity.into_iter().fold(run, Run::sensitivity);
    let run = run.strict(how.strict).stop_when(asked_to_end()).tell(tell);
    let mut progress = Progress { first: step, steps, started: Instant::now(), said: Instant::now(), speaks };
    let outcome = run.finish_watched(&mut [&mut progress], &mut |resting| tell(&resting.to_string()));
    match outcome {
        Ok(outcome) => Ok(conclude(&outcome.summary, folder.to_path_buf(), how, ranks)),
        Err(RunError::Settling(error)) => Err(Failure::of(crate::STOPPED, &RunError::Settling(error))),
        Err(error @ RunError::InterruptedWhileSettling) => {
            say(ranks, how, &format!("{error}; to go on: ndda-mpi resume {}", folder.display()));
            Ok(INTERRUPTED)
        }
        Err(RunError::Write(error)) => Err(error.into()),
    }
}

/// A flag that is raised when somebody asks the program to end; a second signal ends it at once.
fn asked_to_end() -> Arc<AtomicBool> {
    let asked = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        let twice = flag::register_conditional_shutdown(signal, i32::from(INTERRUPTED), asked.clone());
        let _ = twice.and_then(|_| flag::register(signal, asked.clone()));
    }
    asked
}

/// What the first rank prints, and the exit code.
fn conclude(summary: &Summary, folder: PathBuf, how: &HowArgs, ranks: &Arc<dyn Communicator>) -> u8 {
    let folder = folder.display();
    say(ranks, how, &format!("{}results in {folder}", table::ending(summary)));
    match summary.status {
        Status::Done => crate::DONE,
        Status::Failed => FAILED,
        Status::Interrupted => {
            say(ranks, how, &format!("interrupted; to go on: ndda-mpi resume {folder}"));
            INTERRUPTED
        }
        Status::Stopped => {
            if let (0, Some(cause)) = (ranks.rank(), &summary.stopped_by) {
                eprintln!("error: stopped {cause}");
            }
            crate::STOPPED
        }
    }
}

/// Says now and then how far the run is.
struct Progress {
    first: u64,
    steps: u64,
    started: Instant,
    said: Instant,
    speaks: bool,
}

impl Sink for Progress {
    fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
        if self.speaks && self.said.elapsed() >= SAY {
            self.said = Instant::now();
            let pace = Pace::of(view, self.first..self.steps, self.started);
            eprintln!("step {} of {}  {pace}", pace.step, pace.steps);
        }
        Ok(ControlFlow::Continue(()))
    }
}
