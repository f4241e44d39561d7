//! Sink of a run: history, and comparison with the closed form.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use ndda_io::scene::Scene;
use ndda_io::table::Table;
use ndda_io::{History, WriteError};
use ndda_mesh::BlockId;
use ndda_solver::{Sample, Simulation, Sink, SinkError, View};
use serde::{Deserialize, Serialize};

use super::monitor::Monitor;
use super::motion::LargestMotions;
use super::schedule::Schedule;
use crate::judge::reference::{Comparison, Errors};

/// Keeps the history, as `history.csv` or in memory, and follows the errors against the closed form.
pub struct Recorder {
    history: Rows,
    schedule: Schedule,
    after_s: f64,
    comparison: Option<Comparison>,
    extras: Extras,
    row: Vec<f64>,
    /// Held blocks whose supports' forces are columns.
    held: Vec<BlockId>,
    /// Points whose motion is recorded.
    pub monitors: Vec<Monitor>,
    /// Errors at the last row.
    pub error_end: Option<Errors>,
    /// Largest errors since `after_s`.
    pub error_max: Option<Errors>,
    /// The largest displacement and speed of each block.
    pub motions: LargestMotions,
    /// The last row's energies.
    pub last: Sample,
    /// Seconds spent.
    pub spent_s: f64,
}

/// Columns that only some scenes have.
#[derive(Clone, Copy, Debug)]
pub struct Extras {
    /// The energy of removed blocks.
    stages: bool,
    /// Energy and work of bolts.
    bolts: bool,
    /// The error against a closed form.
    reference: bool,
}

impl Extras {
    /// Those of a scene.
    pub fn of(scene: &Scene) -> Self {
        Self {
            stages: !scene.stages.is_empty(),
            bolts: !scene.bolts.is_empty(),
            reference: scene.reference.is_some(),
        }
    }
}

/// Where rows go.
enum Rows {
    File(Box<History>),
    Memory(Table),
}

impl Rows {
    fn push(&mut self, values: &[f64]) -> Result<(), WriteError> {
        match self {
            Self::File(history) => history.push(values),
            Self::Memory(table) => {
                if let Some(column) = values.iter().position(|value| !value.is_finite()) {
                    let row = table.columns[0].len();
                    return Err(WriteError::not_finite(
                        Path::new("history"),
                        &table.names[column],
                        Some(row),
                    ));
                }
                table.columns.iter_mut().zip(values).for_each(|(column, value)| column.push(*value));
                Ok(())
            }
        }
    }
}

/// State of a [`Recorder`] in a checkpoint.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct SavedRecorder {
    rows: usize,
    error_end: Option<Errors>,
    error_max: Option<Errors>,
    motions: LargestMotions,
    last: Sample,
    spent_s: f64,
}

impl Recorder {
    /// Begins a history, in memory where there is no file, or goes on with a saved one.
    ///
    /// # Errors
    /// [`WriteError`] when the file cannot be written, two columns have one name, or the saved table is another one.
    pub fn new(
        file: Option<&Path>,
        monitors: Vec<Monitor>,
        comparison: Option<Comparison>,
        after_s: f64,
        schedule: Schedule,
        (held, extras): (Vec<(BlockId, String)>, Extras),
        saved: Option<SavedRecorder>,
    ) -> Result<Self, WriteError> {
        // A scene that does not come to rest is not compared with the closed form that it names.
        let extras = Extras { reference: comparison.is_some(), ..extras };
        let names = monitors.iter().map(|monitor| monitor.name.as_str());
        let columns = columns(names, &held, extras);
        let history = match (file, &saved) {
            (None, _) => {
                Rows::Memory(Table { columns: vec![Vec::new(); columns.len()], names: columns.clone() })
            }
            (Some(file), None) => Rows::File(Box::new(History::create(file, &columns)?)),
            (Some(file), Some(saved)) => Rows::File(Box::new(History::resume(file, &columns, saved.rows)?)),
        };
        let SavedRecorder { error_end, error_max, motions, last, spent_s, .. } = saved.unwrap_or_default();
        let row = Vec::with_capacity(columns.len());
        Ok(Self {
            history,
            schedule,
            after_s,
            comparison,
            extras,
            row,
            held: held.into_iter().map(|(block, _)| block).collect(),
            monitors,
            error_end,
            error_max,
            motions,
            last,
            spent_s,
        })
    }

    /// Its state for a checkpoint, all rows being on the disk.
    ///
    /// # Errors
    /// [`WriteError`] when they are not.
    pub fn save(&mut self) -> Result<SavedRecorder, WriteError> {
        let rows = match &mut self.history {
            Rows::File(history) => {
                history.sync()?;
                history.rows()
            }
            Rows::Memory(table) => table.columns[0].len(),
        };
        Ok(SavedRecorder {
            rows,
            error_end: self.error_end,
            error_max: self.error_max,
            motions: self.motions.clone(),
            last: self.last,
            spent_s: self.spent_s,
        })
    }

    /// Closes the file.
    ///
    /// # Errors
    /// [`WriteError`] when the last rows cannot be written.
    pub fn finish(&mut self) -> Result<(), WriteError> {
        match &mut self.history {
            Rows::File(history) => history.flush(),
            Rows::Memory(_) => Ok(()),
        }
    }

    /// The history, where it was kept in memory.
    pub fn table(self) -> Option<Table> {
        match self.history {
            Rows::Memory(table) => Some(table),
            Rows::File(_) => None,
        }
    }

    fn compare(&mut self, simulation: &Simulation) -> Option<Errors> {
        let errors = self.comparison.as_ref()?.errors(simulation, &self.monitors)?;
        self.error_end = Some(errors);
        if simulation.time_s() >= self.after_s {
            let larger = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| a.max(b)).or(a).or(b);
            let old = self.error_max.unwrap_or_default();
            self.error_max = Some(Errors {
                plain: old.plain.max(errors.plain),
                stick_stage: larger(old.stick_stage, errors.stick_stage),
                place: larger(old.place, errors.place),
            });
        }
        Some(errors)
    }
}

/// Blocks that supports hold, and their names.
pub fn held_blocks(simulation: &Simulation) -> Vec<(BlockId, String)> {
    let blocks = simulation.blocks();
    let held = blocks.ids().filter(|&block| !simulation.shape(block).is_free());
    held.map(|block| (block, blocks.names[block.index()].clone())).collect()
}

/// Columns of the history, with those of stages, monitors, held blocks and the comparison.
pub fn columns<'a>(
    monitors: impl Iterator<Item = &'a str>,
    held: &[(BlockId, String)],
    extras: Extras,
) -> Vec<String> {
    let fixed = [
        "time_s",
        "kinetic_j",
        "strain_j",
        "contact_j",
        "load_j",
        "spring_j",
        "friction_work_j",
        "motion_work_j",
        "load_work_j",
        "damping_work_j",
        "restitution_work_j",
        "radiated_j",
        "balance_j",
        "momentum_x_kg_m_s",
        "momentum_y_kg_m_s",
        "momentum_z_kg_m_s",
        "angular_x_kg_m2_s",
        "angular_y_kg_m2_s",
        "angular_z_kg_m2_s",
        "contact_pairs",
        "penetration_ratio",
        "h",
    ];
    let mut columns: Vec<String> = fixed.map(String::from).to_vec();
    columns.extend(extras.stages.then(|| "removed_j".to_string()));
    for monitor in monitors {
        for (quantity, unit) in [("displacement", "m"), ("velocity", "m_s")] {
            columns.extend(["x", "y", "z"].map(|axis| format!("{monitor}.{quantity}_{axis}_{unit}")));
        }
    }
    for (_, name) in held {
        columns.extend(["x", "y", "z"].map(|axis| format!("{name}.reaction_{axis}_n")));
    }
    if extras.bolts {
        columns.extend(["bolt_j", "bolt_work_j"].map(String::from));
    }
    if extras.reference {
        columns.push("reference_error".into());
    }
    columns
}

impl Sink for Recorder {
    fn wants_sample(&self, step: u64) -> bool {
        self.schedule.is_due(step)
    }

    fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError> {
        let Some(sample) = view.sample else { return Ok(ControlFlow::Continue(())) };
        let started = Instant::now();
        let simulation = &*view.simulation;
        self.last = *sample;
        self.motions.watch(simulation);
        self.row.clear();
        self.row.extend([
            sample.time_s,
            sample.kinetic_j,
            sample.strain_j,
            sample.contact_j,
            sample.load_j,
            sample.spring_j,
            sample.friction_work_j,
            sample.motion_work_j,
            sample.load_work_j,
            sample.damping_work_j,
            sample.restitution_work_j,
            sample.radiated_j,
            sample.balance_j,
        ]);
        let angular = simulation.angular_momentum_of_scene(sample);
        self.row.extend(sample.momentum.iter().chain(angular.iter()));
        let contact = &view.report.contact;
        self.row.extend([contact.contact_pairs as f64, contact.max_penetration_ratio, view.report.h]);
        self.row.extend(self.extras.stages.then_some(sample.removed_j));
        for monitor in &self.monitors {
            self.row.extend(monitor.displacement(simulation).iter());
            self.row.extend(monitor.velocity(simulation).iter());
        }
        for &block in &self.held {
            let reaction = simulation.reaction_n(block);
            self.row.extend(reaction.iter());
        }
        if self.extras.bolts {
            self.row.extend([sample.bolt_j, sample.bolt_work_j]);
        }
        let errors = self.compare(simulation);
        if self.comparison.is_some() {
            self.row.push(errors.unwrap_or_default().plain);
        }
        self.history.push(&self.row)?;
        self.spent_s += started.elapsed().as_secs_f64();
        Ok(ControlFlow::Continue(()))
    }
}

#[cfg(test)]
mod tests {
    use crate::run::schedule::{events, is_due};

    #[test]
    fn events_are_evenly_spaced_and_never_more_than_asked_for() {
        let due = |steps, count| (0..=steps).filter(|&s| is_due(s, steps, count)).collect::<Vec<_>>();
        assert_eq!(due(10, 2), [0, 5, 10]);
        assert_eq!(due(3, 100), [0, 1, 2, 3]);
        assert_eq!(due(7, 0), [0, 7]);
        assert_eq!(due(1000, 7).len(), 8);
        for (steps, count) in [(10, 2), (3, 100), (7, 0), (1000, 7), (1, 1)] {
            assert_eq!(due(steps, count).len() as u64, events(steps, count), "{steps} {count}");
        }
    }
}
