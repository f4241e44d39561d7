//! Sink of contacts: what each pair of touching blocks does to each other, a row per pair and time.

use std::ops::ControlFlow;
use std::time::Instant;

use ndda_contact::FacetContact;
use ndda_io::{History, OutputFolder, WriteError};
use ndda_solver::{Sink, SinkError, View};

use crate::run::contact_rows::{COLUMNS, contact_rows};
use crate::run::schedule::Schedule;

/// Writes `contacts.csv`.
pub struct ContactTable {
    table: History,
    schedule: Schedule,
    facets: Vec<FacetContact>,
    /// Seconds spent in this part of the run.
    pub spent_s: f64,
}

impl ContactTable {
    /// Begins a table, or goes on after so many rows of it.
    ///
    /// # Errors
    /// [`WriteError`] when the file cannot be written, or is another table.
    pub fn new(folder: &OutputFolder, schedule: Schedule, saved: Option<usize>) -> Result<Self, WriteError> {
        let columns = COLUMNS.map(String::from);
        let table = match saved {
            None => History::create(&folder.contacts(), &columns)?,
            Some(saved) => History::resume(&folder.contacts(), &columns, saved)?,
        };
        Ok(Self { table, schedule, facets: Vec::new(), spent_s: 0.0 })
    }

    /// Rows so far, all of them on the disk.
    ///
    /// # Errors
    /// [`WriteError`] when they are not.
    pub fn save(&mut self) -> Result<usize, WriteError> {
        self.table.sync()?;
        Ok(self.table.rows())
    }
}

impl Sink for ContactTable {
    fn wants_contacts(&self, step: u64) -> bool {
        self.schedule.is_due(step)
    }

    fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
        let simulation = &*view.simulation;
        if !self.schedule.is_due(simulation.state().step) {
            return Ok(ControlFlow::Continue(()));
        }
        let started = Instant::now();
        for row in contact_rows(simulation, &mut self.facets) {
            self.table.push(&row)?;
        }
        self.spent_s += started.elapsed().as_secs_f64();
        Ok(ControlFlow::Continue(()))
    }
}
