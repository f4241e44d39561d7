//! A run: a scene stepped to its end, shown to observers, recorded if asked to, and judged.

pub mod bolts;
pub mod contact_rows;
pub mod contacts;
mod error;
pub mod fields;
mod identity;
pub mod monitor;
pub mod motion;
mod on_ranks;
mod outputs;
mod pace;
pub mod recorder;
mod rest;
mod resume;
pub mod run_log;
pub mod schedule;
mod settling;
pub(crate) mod stage_log;
mod stages;
pub(crate) mod twin;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use ndda_io::read::LoadedScene;
use ndda_io::table::Table;
use ndda_io::{OutputFolder, WriteError, checkpoint};
use ndda_ranks::{Communicator, agree};
use ndda_solver::{Simulation, Sink, StartSnapshot};

use crate::Model;
use crate::judge::reference::Comparison;
use crate::judge::summary::{Ending, summarise};
use crate::judge::table;
use crate::places::name_of;
use crate::summary::{LabelWord, MonitorEnd, Status, Summary};
pub use error::RunError;
pub use identity::Identity;
use outputs::{Course, Earlier, Outputs};
pub use pace::Pace;
pub use rest::Resting;
pub use resume::{ResumeError, Resumed};
use run_log::RunLog;
use twin::Again;
pub use twin::Sensitivity;

/// Ends a loop when somebody has raised the flag.
pub(crate) fn unless_stopped(stop: &AtomicBool) -> ControlFlow<()> {
    if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// Ends a loop on all ranks when somebody has raised the flag of one of them, or when ranks cannot go on; all flags are raised then.
pub(crate) fn unless_ended(ranks: &dyn Communicator, stop: &AtomicBool) -> ControlFlow<()> {
    if matches!(agree(ranks, stop.load(Ordering::Relaxed)), Ok(false)) {
        return ControlFlow::Continue(());
    }
    stop.store(true, Ordering::Relaxed);
    ControlFlow::Break(())
}

/// A run that is about to begin, or to go on.
pub struct Run {
    model: Model,
    /// The closed form, bound to the blocks as they were at the start.
    comparison: Option<Comparison>,
    name: String,
    recording: Option<Recording>,
    strict: bool,
    sensitivity: Sensitivity,
    /// The simulation as it was built, from which a twin begins; taken late in a run that is new.
    built: Option<StartSnapshot>,
    /// How far it had come before, where it goes on.
    earlier: Option<Earlier>,
    tell: Box<dyn Fn(&str) + Send>,
    on_the_way: Option<settling::OnTheWay>,
    started: Instant,
    stop: Arc<AtomicBool>,
}

/// Where a run is recorded.
struct Recording {
    identity: Identity,
    folder: OutputFolder,
    log: RunLog,
}

/// Outcome of a run.
pub struct Outcome {
    /// Energies, momenta, verdicts, the label, and where blocks and monitors ended.
    pub summary: Summary,
    /// The history, where the run was not recorded in a folder.
    pub history: Option<Table>,
    /// The simulation at its end.
    pub simulation: Simulation,
}

impl Outcome {
    /// Displacement [m] and velocity [m/s] of a monitor at the end; `None` if the scene has no monitor of this name.
    pub fn monitor(&self, name: &str) -> Option<&MonitorEnd> {
        self.summary.monitors.0.iter().find(|(known, _)| known == name).map(|(_, end)| end)
    }
}

impl Run {
    /// A run that writes no files: its history is kept in memory.
    pub fn new(model: Model) -> Self {
        let comparison = model.comparison();
        let name = name_of(Path::new(&model.loaded.file));
        let (started, stop) = (Instant::now(), Arc::default());
        let (recording, strict, sensitivity, built, earlier) =
            (None, false, Sensitivity::default(), None, None);
        let tell = Box::new(|_: &str| {});
        let on_the_way = None;
        Self {
            model,
            comparison,
            name,
            recording,
            strict,
            sensitivity,
            built,
            earlier,
            tell,
            on_the_way,
            started,
            stop,
        }
    }

    /// Records the run in a folder: history, fields, contacts, checkpoints, log and summary, as the scene's `output` asks.
    /// `scene_file` is where the scene was read, beside the files that it names.
    ///
    /// # Errors
    /// [`WriteError`] when files cannot be made there, or another run writes to the folder.
    pub fn record(mut self, folder: OutputFolder, scene_file: PathBuf) -> Result<Self, WriteError> {
        self.name = name_of(&scene_file);
        let loaded = &self.model.loaded;
        let mut identity = Identity::new(self.name.clone(), loaded.text.clone(), scene_file, &loaded.scene);
        identity.sensitivity = self.sensitivity;
        self.record_as(identity, folder)
    }

    fn record_as(mut self, identity: Identity, folder: OutputFolder) -> Result<Self, WriteError> {
        let mut log = RunLog::open(&folder, self.started)?;
        log.begin(&identity, rayon::current_num_threads())?;
        for warning in &self.model.loaded.warnings {
            log.line(&format!("warning: {}: {}", warning.path, warning.message))?;
        }
        self.recording = Some(Recording { identity, folder, log });
        Ok(self)
    }

    /// Whether a limit that is passed makes the run's status `failed`.
    pub fn strict(mut self, strict: bool) -> Self {
        self.strict = strict;
        self
    }

    /// When a twin of the run shows whether its motion is sensitive; a run that goes on has what it began with.
    pub fn sensitivity(mut self, sensitivity: Sensitivity) -> Self {
        self.sensitivity = sensitivity;
        self.recording.iter_mut().for_each(|recording| recording.identity.sensitivity = sensitivity);
        self
    }

    /// Tells somebody of a twin that is about to begin, which takes as long as the run.
    pub fn tell(mut self, tell: impl Fn(&str) + Send + 'static) -> Self {
        self.tell = Box::new(tell);
        self
    }

    /// Counts the time of the run from here, so that reading and building the scene are in it.
    pub fn started(mut self, started: Instant) -> Self {
        self.started = started;
        self
    }

    /// Ends the run after the step at which `stop` is raised, with a checkpoint and a summary.
    pub fn stop_when(mut self, stop: Arc<AtomicBool>) -> Self {
        self.stop = stop;
        self
    }

    /// The scene and its simulation.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Name of the run: that of the scene's file without its ending.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Runs to the end and judges; each observer is shown the start and every step.
    ///
    /// # Errors
    /// [`RunError`]. A numerical stop after the first step is no error: the summary names its cause.
    pub fn finish(self, observers: &mut [&mut dyn Sink]) -> Result<Outcome, RunError> {
        self.finish_watched(observers, &mut |_| {})
    }

    /// As [`finish`](Self::finish); `settling` is shown every two seconds how far a scene has settled that begins with that.
    ///
    /// # Errors
    /// As [`finish`](Self::finish).
    pub fn finish_watched(
        mut self,
        observers: &mut [&mut dyn Sink],
        settling: &mut dyn FnMut(&Resting),
    ) -> Result<Outcome, RunError> {
        let began = Instant::now();
        let settles = self.recording.is_some() && self.model.loaded.scene.settle.is_some();
        if (self.sensitivity != Sensitivity::Never || settles) && self.built.is_none() {
            self.built = Some(self.model.simulation.start_snapshot());
        }
        let earlier_s = self.on_the_way.as_ref().map_or(0.0, |way| way.wall_s);
        if let Err(error) = self.settle(settling) {
            self.log_line(&error.to_string())?;
            return Err(error);
        }
        if self.sensitivity == Sensitivity::Never {
            self.built = None;
        }
        let steps = self.model.steps();
        self.log_line(&format!("from step {} of {steps}", self.model.simulation.state().step))?;
        self.step_to_end(steps, earlier_s + began.elapsed().as_secs_f64(), observers)
    }

    fn log_line(&mut self, text: &str) -> Result<(), WriteError> {
        self.recording.as_mut().map_or(Ok(()), |recording| recording.log.line(text))
    }

    fn goes_on(&self) -> bool {
        self.earlier.is_some()
    }

    /// Steps, and writes all that there is to be known.
    fn step_to_end(
        self,
        steps: u64,
        settled_s: f64,
        observers: &mut [&mut dyn Sink],
    ) -> Result<Outcome, RunError> {
        let Self {
            model: Model { loaded, mut simulation, monitors, folder: beside, .. },
            comparison,
            name,
            recording,
            earlier,
            ..
        } = self;
        let (scene, started) = (&loaded.scene, self.started);
        let (mut log, place) = match recording {
            Some(Recording { identity, folder, log }) => (Some(log), Some((identity, folder))),
            None => (None, None),
        };
        let (earlier_s, goes_on) = (earlier.as_ref().map_or(0.0, |e| e.wall_s), earlier.is_some());
        let course = Course { steps, started, stop: self.stop.clone(), checkpoints: true };
        let mut outputs =
            Outputs::new((scene, &simulation), (monitors, comparison), (place, earlier), observers, course)?;
        let setup_s = started.elapsed().as_secs_f64() - settled_s;
        let ended = if scene.stages.is_empty() {
            let go = if goes_on { ndda_solver::resume } else { ndda_solver::run };
            go(&mut simulation, steps, &mut [&mut outputs])
        } else {
            let through =
                stages::Course { loaded: &loaded, folder: &beside, stop: &self.stop, tell: &*self.tell };
            through.run(&mut simulation, &mut outputs, goes_on)
        };
        let stopped_by = ended.map_or_else(|error| error::numerical_stop(error).map(Some), |()| Ok(None))?;
        outputs.flush()?;
        if stopped_by.is_none() && simulation.unsampled_s() > 0.0 {
            // Of a run that was interrupted between two rows, what it has come to is judged, too.
            simulation.sample().ok();
        }
        let ending = Ending {
            scene,
            name: &name,
            chosen: loaded.chosen.clone(),
            stopped_by,
            interrupted: simulation.state().step < steps,
            wall_s: earlier_s + started.elapsed().as_secs_f64(),
            threads: rayon::current_num_threads(),
            stages: vec![("output".into(), outputs.output_s()), ("setup".into(), setup_s)],
            warnings: loaded.warnings.iter().map(|w| w.message.clone()).collect(),
            strict: self.strict,
            state_crc32: checkpoint::fingerprint(simulation.state()),
        };
        let mut summary = summarise(&simulation, &outputs.recorder, ending);
        summary.stages = std::mem::take(&mut outputs.stages.rows);
        let (folder, history) = outputs.end();
        let (built, stop) = (self.built, self.stop);
        let twins = match is_whole(&summary) {
            true => twin::twins(self.sensitivity, &simulation),
            false => Vec::new(),
        };
        if let Some(again) = again(&loaded, &beside, built.as_ref(), &stop).filter(|_| !twins.is_empty()) {
            (self.tell)(&twin::told(&twins, &simulation));
            twin::judge(&mut summary, &mut simulation, (&again, &twins), (&stop, self.strict));
        }
        if let (Some(folder), Some(log)) = (folder, &mut log) {
            write_results(&folder, &loaded.scene.output, &summary, log)?;
        }
        Ok(Outcome { summary, history, simulation })
    }
}

/// How the scene can be run again; not at all where its start was not kept.
fn again<'a>(
    loaded: &'a LoadedScene,
    folder: &'a Path,
    built: Option<&'a StartSnapshot>,
    stop: &'a Arc<AtomicBool>,
) -> Option<Again<'a>> {
    if !loaded.scene.stages.is_empty() {
        return Some(Again::ThroughStages { loaded, folder, stop });
    }
    let settle = loaded.scene.settle.map(crate::build::settle);
    built.map(|start| Again::FromStart { start, settle })
}

/// Whether an accurate run has come to its end.
fn is_whole(summary: &Summary) -> bool {
    summary.label.word == LabelWord::Accurate && matches!(summary.status, Status::Done | Status::Failed)
}

/// Writes what is written at the end only.
fn write_results(
    folder: &OutputFolder,
    output: &ndda_io::scene::Output,
    summary: &Summary,
    log: &mut RunLog,
) -> Result<(), WriteError> {
    let has_ended = matches!(summary.status, Status::Done | Status::Failed);
    #[cfg(feature = "parquet")]
    if has_ended {
        folder.write_parquet(output)?;
    }
    summary.write(&folder.summary())?;
    if has_ended {
        folder.remove_csv(output)?;
    }
    log.line("ended")?;
    log.block(&(table::text(summary) + &table::ending(summary)))?;
    match &summary.stopped_by {
        Some(cause) => log.line(&format!("stopped: {cause}")),
        None => Ok(()),
    }
}
