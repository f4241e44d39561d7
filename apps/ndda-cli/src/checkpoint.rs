//! When a checkpoint is written, and what is in it.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use ndda_io::outside_files::{self, OutsideFile};
use ndda_io::scene::Scene;
use ndda_io::{OutputFolder, WriteError, checkpoint};
use ndda_solver::{Sink, SinkError, Snapshot, View};
use serde::{Deserialize, Serialize};

use crate::contacts::ContactTable;
use crate::fields::{FieldWriter, SavedFields};
use crate::progress::Progress;
use crate::recorder::{Recorder, SavedRecorder};

/// Which scene a run is of.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Identity {
    /// Name of the run.
    pub name: String,
    /// The scene's text, overrides included.
    pub text: String,
    /// The scene's file, from the root of the file system: its meshes are beside it.
    pub file: PathBuf,
    /// The files that the scene names, as they were when the run began.
    pub outside: Vec<OutsideFile>,
}

impl Identity {
    /// Of a scene that is read from `file`, by its text and the files that it names.
    pub fn new(name: String, text: String, file: PathBuf, scene: &Scene) -> Self {
        let outside = outside_files::of_scene(scene, folder_of(&file));
        Self { name, text, file, outside }
    }

    /// Folder of the scene.
    pub fn folder(&self) -> &Path {
        folder_of(&self.file)
    }

    /// CRC-32 of the scene's text.
    pub fn crc32(&self) -> u32 {
        checkpoint::fingerprint(&self.text)
    }
}

fn folder_of(file: &Path) -> &Path {
    file.parent().unwrap_or(Path::new("."))
}

/// Everything that `ndda resume` needs.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SavedRun {
    /// The scene.
    pub identity: Identity,
    /// State and books.
    pub snapshot: Snapshot,
    /// How far the outputs had come.
    pub earlier: Earlier,
}

/// What the outputs of a run that goes on have to know.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Earlier {
    /// The history.
    pub recorder: SavedRecorder,
    /// The fields.
    pub fields: Option<SavedFields>,
    /// Rows of the contacts.
    pub contacts: Option<usize>,
    /// Seconds of wall clock spent, all parts of the run together.
    pub wall_s: f64,
}

/// All that watches a run, with a checkpoint from time to time.
pub struct Outputs<'a> {
    /// History.
    pub recorder: Recorder,
    /// Fields, where they are wanted.
    pub fields: Option<FieldWriter>,
    /// Contacts, where they are wanted.
    pub contacts: Option<ContactTable>,
    /// Progress.
    pub progress: Progress,
    /// The scene.
    pub identity: Identity,
    /// Where results go.
    pub folder: &'a OutputFolder,
    /// The last step.
    pub steps: u64,
    /// Between checkpoints; none between start and end if zero.
    pub every: Duration,
    /// When the last one was written.
    pub last: Instant,
    /// When this part of the run began.
    pub started: Instant,
    /// Seconds that earlier parts took.
    pub earlier_s: f64,
    /// Seconds spent on checkpoints.
    pub spent_s: f64,
    /// Raised when somebody asks the run to end.
    pub asked_to_end: Arc<AtomicBool>,
}

impl Outputs<'_> {
    /// Closes the tables, and waits until fields are on the disk.
    ///
    /// # Errors
    /// [`WriteError`] when one of them cannot be written.
    pub fn flush(&mut self) -> Result<(), WriteError> {
        self.recorder.finish()?;
        if let Some(fields) = &mut self.fields {
            fields.save()?;
        }
        match &mut self.contacts {
            Some(contacts) => contacts.save().map(drop),
            None => Ok(()),
        }
    }

    /// Seconds spent on output.
    pub fn output_s(&self) -> f64 {
        let fields_s = self.fields.as_ref().map_or(0.0, |fields| fields.spent_s);
        let contacts_s = self.contacts.as_ref().map_or(0.0, |contacts| contacts.spent_s);
        self.recorder.spent_s + fields_s + contacts_s + self.spent_s
    }

    fn is_due(&self, step: u64) -> bool {
        let passed = !self.every.is_zero() && self.last.elapsed() >= self.every;
        step == 0 || step >= self.steps || passed
    }

    fn write(&mut self, view: &View) -> Result<(), WriteError> {
        let started = Instant::now();
        let saved = SavedRun {
            identity: self.identity.clone(),
            snapshot: view.simulation.snapshot(),
            earlier: Earlier {
                recorder: self.recorder.save()?,
                fields: self.fields.as_mut().map(FieldWriter::save).transpose()?,
                contacts: self.contacts.as_mut().map(ContactTable::save).transpose()?,
                wall_s: self.earlier_s + self.started.elapsed().as_secs_f64(),
            },
        };
        checkpoint::write(self.folder, &saved)?;
        self.last = Instant::now();
        self.spent_s += started.elapsed().as_secs_f64();
        Ok(())
    }
}

impl Sink for Outputs<'_> {
    fn wants_sample(&self, step: u64) -> bool {
        self.recorder.wants_sample(step)
    }

    fn wants_contacts(&self, step: u64) -> bool {
        let of_fields = self.fields.as_ref().is_some_and(|fields| fields.wants_contacts(step));
        of_fields || self.contacts.as_ref().is_some_and(|contacts| contacts.wants_contacts(step))
    }

    fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
        let mut flow = self.recorder.step_done(view)?;
        if let Some(fields) = &mut self.fields {
            flow = both(flow, fields.step_done(view)?);
        }
        if let Some(contacts) = &mut self.contacts {
            flow = both(flow, contacts.step_done(view)?);
        }
        flow = both(flow, self.progress.step_done(view)?);
        let asked = self.asked_to_end.load(Ordering::Relaxed);
        // Last, so that it knows of all rows and frames.
        if asked || self.is_due(view.simulation.state().step) {
            self.write(view)?;
        }
        Ok(if asked { ControlFlow::Break(()) } else { flow })
    }
}

fn both(a: ControlFlow<()>, b: ControlFlow<()>) -> ControlFlow<()> {
    if a.is_break() { a } else { b }
}
