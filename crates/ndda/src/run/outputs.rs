//! Everything that is written while a run goes on: history, fields, log, and a checkpoint after each period of `checkpoint_wall_s`.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use ndda_io::scene::Scene;
use ndda_io::table::Table;
use ndda_io::{OutputFolder, WriteError, checkpoint};
use ndda_solver::{Settling, Simulation, Sink, SinkError, Snapshot, StepError, View};
use serde::{Deserialize, Serialize};

use super::bolts::{BoltTable, SavedBolts};
use super::contacts::ContactTable;
use super::fields::{FieldWriter, SavedFields};
use super::identity::Identity;
use super::monitor::Monitor;
use super::motion::BlockTable;
use super::recorder::{Extras, Recorder, SavedRecorder, held_blocks};
use super::schedule::Schedule;
use super::stage_log::{self, StageLog};
use crate::judge::reference::{self, Comparison};

/// Everything that `ndda resume` needs.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SavedRun<S = Snapshot, W = Settling> {
    /// The scene.
    pub identity: Identity,
    /// State and ledger.
    pub snapshot: S,
    /// How far the outputs had come; they have not begun where the scene is still on its way to rest.
    pub earlier: Earlier,
    /// The way to rest, before time begins.
    pub settling: Option<W>,
}

/// State of the outputs of a run that is resumed.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Earlier {
    /// The history.
    pub recorder: SavedRecorder,
    /// The fields.
    pub fields: Option<SavedFields>,
    /// Rows of the contacts.
    pub contacts: Option<usize>,
    /// Rows of the motion of blocks.
    pub blocks: Option<usize>,
    /// Where it was in its stages.
    pub stages: StageLog,
    /// Bolts.
    pub bolts: Option<SavedBolts>,
    /// Seconds of wall clock spent, all parts of the run together.
    pub wall_s: f64,
}

/// All that watches a run: its records, observers, and a checkpoint from time to time.
pub struct Outputs<'a, 'b> {
    /// History.
    pub recorder: Recorder,
    /// Where the run is in its stages.
    pub stages: StageLog,
    /// Names of the stages, and the last step of each, that before the first included.
    stage_names: Vec<String>,
    stage_ends: Vec<u64>,
    files: Option<Files>,
    observers: &'a mut [&'b mut dyn Sink],
    /// The last step.
    steps: u64,
    /// When this part of the run began.
    started: Instant,
    /// Raised when somebody asks the run to end.
    stop: Arc<AtomicBool>,
    /// Whether there are checkpoints.
    checkpoints: bool,
}

/// Files of a recorded run besides its history.
struct Files {
    fields: Option<FieldWriter>,
    contacts: Option<ContactTable>,
    blocks: Option<BlockTable>,
    bolts: Option<BoltTable>,
    identity: Identity,
    folder: OutputFolder,
    /// Between checkpoints; none between start and end if zero.
    every: Duration,
    /// When the last one was written.
    last: Instant,
    /// Seconds that earlier parts took.
    earlier_s: f64,
    /// Seconds spent on checkpoints.
    spent_s: f64,
}

/// How long a run is, when it began and what ends it early.
pub struct Course {
    /// The last step.
    pub steps: u64,
    /// When this part of the run began.
    pub started: Instant,
    /// Raised when somebody asks the run to end.
    pub stop: Arc<AtomicBool>,
    /// Whether checkpoints are written.
    pub checkpoints: bool,
}

/// Where a run is recorded.
pub type Place = (Identity, OutputFolder);

impl<'a, 'b> Outputs<'a, 'b> {
    /// The outputs that a scene requests, in memory where there is no place; they go on from where they were before.
    ///
    /// # Errors
    /// [`WriteError`] when a file cannot be written.
    pub fn new(
        (scene, simulation): (&Scene, &Simulation),
        (monitors, comparison): (Vec<Monitor>, Option<Comparison>),
        (place, earlier): (Option<Place>, Option<Earlier>),
        observers: &'a mut [&'b mut dyn Sink],
        Course { steps, started, stop, checkpoints }: Course,
    ) -> Result<Self, WriteError> {
        let after_s = scene.reference.as_ref().map_or(0.0, |r| reference::kind(r).1);
        let stage_ends = stage_log::ends(scene);
        let schedule = |count: u32| Schedule { steps, count: u64::from(count), ends: stage_ends.clone() };
        let rows = schedule(scene.output.history_rows);
        let held = match scene.output.reactions {
            true if scene.stages.is_empty() => held_blocks(simulation),
            true => stage_log::held_blocks(scene, simulation),
            false => Vec::new(),
        };
        let (mut saved, mut files, mut history, mut stage_log) = (None, None, None, StageLog::default());
        let mut goes_on = None;
        if let Some(earlier) = earlier {
            saved = Some(earlier.recorder);
            stage_log = earlier.stages;
            goes_on = Some((earlier.fields, earlier.contacts, earlier.blocks, earlier.bolts, earlier.wall_s));
        }
        if let Some((identity, folder)) = place {
            history = Some(folder.history());
            let (saved_fields, saved_contacts, saved_blocks, saved_bolts, earlier_s) =
                goes_on.unwrap_or_default();
            let frames = schedule(scene.output.frames);
            let fields = || FieldWriter::new(&folder, simulation, scene, frames.clone(), saved_fields);
            let contacts = || ContactTable::new(&folder, rows.clone(), saved_contacts);
            let blocks = || BlockTable::new(&folder, frames.clone(), saved_blocks);
            let bolts = || BoltTable::new(&folder, frames.clone(), saved_bolts);
            files = Some(Files {
                fields: (scene.output.frames > 0).then(fields).transpose()?,
                contacts: scene.output.contacts.then(contacts).transpose()?,
                blocks: scene.output.blocks.then(blocks).transpose()?,
                bolts: (simulation.bolt_count() > 0).then(bolts).transpose()?,
                every: Duration::from_secs_f64(scene.output.checkpoint_wall_s),
                last: Instant::now(),
                earlier_s,
                spent_s: 0.0,
                identity,
                folder,
            });
        }
        let recorder = Recorder::new(
            history.as_deref(),
            monitors,
            comparison,
            after_s,
            rows,
            (held, Extras::of(scene)),
            saved,
        )?;
        let stage_names = scene.stages.iter().map(|stage| stage.name.clone()).collect();
        let stages = stage_log;
        Ok(Self {
            recorder,
            stages,
            stage_names,
            stage_ends,
            files,
            observers,
            steps,
            started,
            stop,
            checkpoints,
        })
    }

    /// Closes the tables, and waits until fields are on the disk.
    ///
    /// # Errors
    /// [`WriteError`] when one of them cannot be written.
    pub fn flush(&mut self) -> Result<(), WriteError> {
        self.recorder.finish()?;
        let Some(files) = &mut self.files else { return Ok(()) };
        if let Some(fields) = &mut files.fields {
            fields.save()?;
        }
        if let Some(contacts) = &mut files.contacts {
            contacts.save()?;
        }
        if let Some(bolts) = &mut files.bolts {
            bolts.save()?;
        }
        files.blocks.as_mut().map_or(Ok(()), |blocks| blocks.save().map(drop))
    }

    /// Seconds spent on output.
    pub fn output_s(&self) -> f64 {
        self.recorder.spent_s + self.files.as_ref().map_or(0.0, Files::spent_s)
    }

    /// The folder of a recorded run, and the history of another.
    pub fn end(self) -> (Option<OutputFolder>, Option<Table>) {
        (self.files.map(|files| files.folder), self.recorder.table())
    }

    fn is_due(&self, step: u64) -> bool {
        let passed = self.files.as_ref().is_some_and(|f| !f.every.is_zero() && f.last.elapsed() >= f.every);
        step == 0 || step >= self.steps || passed
    }

    /// Writes a checkpoint now.
    ///
    /// # Errors
    /// [`WriteError`] when it cannot be written.
    pub fn checkpoint(&mut self, simulation: &Simulation) -> Result<(), WriteError> {
        self.write_checkpoint(simulation, None)
    }

    /// Writes a checkpoint, and another one that is kept by the name of a stage that ends.
    fn write_checkpoint(&mut self, simulation: &Simulation, stage: Option<&str>) -> Result<(), WriteError> {
        let Some(files) = self.files.as_mut().filter(|_| self.checkpoints) else { return Ok(()) };
        let started = Instant::now();
        let saved = SavedRun {
            identity: files.identity.clone(),
            snapshot: simulation.snapshot_view(),
            earlier: Earlier {
                recorder: self.recorder.save()?,
                fields: files.fields.as_mut().map(FieldWriter::save).transpose()?,
                contacts: files.contacts.as_mut().map(ContactTable::save).transpose()?,
                blocks: files.blocks.as_mut().map(BlockTable::save).transpose()?,
                stages: self.stages.clone(),
                bolts: files.bolts.as_mut().map(BoltTable::save).transpose()?,
                wall_s: files.earlier_s + self.started.elapsed().as_secs_f64(),
            },
            settling: None::<Settling>,
        };
        files.folder.write_checkpoint(&saved)?;
        if let Some(stage) = stage {
            checkpoint::write_file(&files.folder.stage_checkpoint(stage), &saved)?;
        }
        files.last = Instant::now();
        files.spent_s += started.elapsed().as_secs_f64();
        Ok(())
    }

    /// The stage that ends with a step, counted from 1.
    fn ending_stage(&self, step: u64) -> Option<usize> {
        let at = self.stages.at;
        (at > 0 && self.stage_ends.get(at) == Some(&step)).then_some(at)
    }
}

impl Files {
    fn spent_s(&self) -> f64 {
        let fields_s = self.fields.as_ref().map_or(0.0, |fields| fields.spent_s);
        let contacts_s = self.contacts.as_ref().map_or(0.0, |contacts| contacts.spent_s);
        let blocks_s = self.blocks.as_ref().map_or(0.0, |blocks| blocks.spent_s);
        let bolts_s = self.bolts.as_ref().map_or(0.0, |bolts| bolts.spent_s);
        fields_s + contacts_s + blocks_s + bolts_s + self.spent_s
    }

    fn wants_contacts(&self, step: u64) -> bool {
        let of_fields = self.fields.as_ref().is_some_and(|fields| fields.wants_contacts(step));
        of_fields || self.contacts.as_ref().is_some_and(|contacts| contacts.wants_contacts(step))
    }
}

impl Sink for Outputs<'_, '_> {
    fn wants_sample(&self, step: u64) -> bool {
        self.recorder.wants_sample(step) || self.observers.iter().any(|sink| sink.wants_sample(step))
    }

    fn wants_contacts(&self, step: u64) -> bool {
        let of_files = self.files.as_ref().is_some_and(|files| files.wants_contacts(step));
        of_files || self.observers.iter().any(|sink| sink.wants_contacts(step))
    }

    fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
        let step = view.simulation.state().step;
        // A sample that only an observer wanted is no row of the history.
        let mut ends = false;
        if self.recorder.wants_sample(step) || step >= self.steps {
            ends |= self.recorder.step_done(view)?.is_break();
        }
        if let Some(Files { fields, contacts, blocks, bolts, .. }) = &mut self.files {
            if let Some(fields) = fields {
                ends |= fields.step_done(view)?.is_break();
            }
            if let Some(contacts) = contacts {
                ends |= contacts.step_done(view)?.is_break();
            }
            if let Some(blocks) = blocks {
                ends |= blocks.step_done(view)?.is_break();
            }
            if let Some(bolts) = bolts {
                ends |= bolts.step_done(view)?.is_break();
            }
        }
        for observer in self.observers.iter_mut() {
            ends |= observer.step_done(view)?.is_break();
        }
        let asked = view.simulation.agree(self.stop.load(Ordering::Relaxed)).map_err(StepError::from)?;
        self.stop.fetch_or(asked, Ordering::Relaxed);
        ends |= asked;
        let ending = self.ending_stage(step).map(|at| self.stage_names[at - 1].clone());
        if let Some(name) = &ending {
            self.stages.end(name, view, &self.recorder);
        }
        // Last, so that it knows of all rows and frames.
        if ends || ending.is_some() || self.is_due(step) {
            self.write_checkpoint(view.simulation, ending.as_deref())?;
        }
        Ok(if ends { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }
}
