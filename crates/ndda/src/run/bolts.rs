//! Sink of bolts: `bolts.csv` with a row for each piece of each bolt and frame, and lines for ParaView.

use std::ops::ControlFlow;
use std::time::Instant;

use ndda_io::{BoltLine, BoltSeries, History, OutputFolder, WriteError};
use ndda_solver::{BoltPiece, Simulation, Sink, SinkError, View};
use serde::{Deserialize, Serialize};

use crate::run::schedule::Schedule;

/// Columns of the table; bolts, their pieces and blocks are numbered from 0, and states are 0 elastic, 1 debonded, 2 yielding, 3 broken. The last is the
/// name of the bolt.
pub const COLUMNS: [&str; 11] = [
    "time_s",
    "bolt",
    "piece",
    "block",
    "from_m",
    "to_m",
    "axial_n",
    "utilisation",
    "slip_m",
    "state",
    "name",
];

/// How far the table and the lines had come.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SavedBolts {
    rows: usize,
    times_s: Vec<f64>,
}

/// Writes `bolts.csv`, and `bolts.pvd` with its lines.
pub struct BoltTable {
    table: History,
    lines: BoltSeries,
    schedule: Schedule,
    pieces: Vec<BoltPiece>,
    /// Seconds spent in this part of the run.
    pub spent_s: f64,
}

impl BoltTable {
    /// Begins a table, or goes on with a saved one.
    ///
    /// # Errors
    /// [`WriteError`] when a file cannot be written, or is another table.
    pub fn new(
        folder: &OutputFolder,
        schedule: Schedule,
        saved: Option<SavedBolts>,
    ) -> Result<Self, WriteError> {
        let columns = COLUMNS.map(String::from);
        let (table, times_s) = match saved {
            None => (History::create(&folder.bolts(), &columns)?, Vec::new()),
            Some(saved) => (History::resume(&folder.bolts(), &columns, saved.rows)?, saved.times_s),
        };
        let lines = BoltSeries::new(folder, times_s)?;
        Ok(Self { table, lines, schedule, pieces: Vec::new(), spent_s: 0.0 })
    }

    /// How far it is, all of it on the disk.
    ///
    /// # Errors
    /// [`WriteError`] when it is not.
    pub fn save(&mut self) -> Result<SavedBolts, WriteError> {
        self.table.sync()?;
        Ok(SavedBolts { rows: self.table.rows(), times_s: self.lines.times_s().to_vec() })
    }

    fn write(&mut self, simulation: &Simulation) -> Result<(), WriteError> {
        simulation.bolt_pieces(&mut self.pieces);
        let (time_s, origin_m) = (simulation.time_s(), simulation.blocks().origin_m);
        for piece in &self.pieces {
            let [from_m, to_m] = piece.along_m;
            let numbers = [
                time_s,
                piece.bolt as f64,
                piece.piece as f64,
                f64::from(piece.block),
                from_m,
                to_m,
                piece.axial_n,
                piece.utilisation,
                piece.slip_m,
                f64::from(piece.state as u8),
            ];
            let name = simulation.bolt(piece.bolt).map_or("", |(name, _)| name);
            self.table.push_with_text(&numbers, &[name])?;
        }
        let line = |piece: &BoltPiece| BoltLine {
            ends_m: piece.ends_m.map(|end| (end + origin_m).into()),
            bolt: piece.bolt,
            block: piece.block,
            axial_n: piece.axial_n,
            utilisation: piece.utilisation,
            slip_m: piece.slip_m,
            state: piece.state as u8,
        };
        let lines: Vec<BoltLine> = self.pieces.iter().map(line).collect();
        self.lines.push(time_s, &lines)
    }
}

impl Sink for BoltTable {
    fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
        if self.schedule.is_due(view.simulation.state().step) {
            let started = Instant::now();
            self.write(view.simulation)?;
            self.spent_s += started.elapsed().as_secs_f64();
        }
        Ok(ControlFlow::Continue(()))
    }
}
