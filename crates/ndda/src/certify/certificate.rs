//! The certificate of a scene: each quantity with its error bar, and what it is the error of.

use std::path::Path;

use ndda_io::WriteError;
use ndda_io::table::Table;
use serde::{Deserialize, Serialize};

use super::chaos::Chaos;
use super::extrapolate::{
    Behaviour, Estimate, estimate, estimate_of_coarse, estimate_of_coarsest, root_mean_square,
};
use super::plan::{FINER, STIFFER};
use super::quantities::{
    Kind, Quantity, common_rows, last_fifth, quantities, rounding, scales, speed_beside, unresolved_energy_j,
    values_of,
};
use crate::documents::write_json;

/// The file of a certificate.
pub const FILE: &str = "certificate.json";
/// Schema of the file; it changes when a key does.
pub const SCHEMA: &str = "ndda.certificate/1";
/// The order in the size of elements on which a single finer mesh counts.
const MESH_ORDER: f64 = 1.0;
/// The largest order in the size of elements, that of linear tetrahedra.
const MOST_MESH_ORDER: f64 = 2.0;
/// The order in 1/k_n of the error of soft contact.
const PENALTY_ORDER: f64 = 1.0;

/// Everything that `certificate.json` says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// Its form.
    pub schema: String,
    /// Name of the scene.
    pub scene: String,
    /// Title of the scene.
    pub title: String,
    /// Which error is estimated, in words.
    pub estimates: String,
    /// The order in Δt of the scene's scheme.
    pub order_of_scheme: f64,
    /// The runs; the first three, of ever shorter steps, give the errors of the time step.
    pub runs: Vec<RunRecord>,
    /// Each quantity with its error bar.
    pub quantities: Vec<Certified>,
    /// The error of the last of the three runs against the scene's closed form; null where it has none.
    pub closed_form: Option<ClosedForm>,
    /// Reason why single trajectories mean nothing; null for a regular motion.
    pub chaos: Option<Chaos>,
    /// Energy of vibrations that none of the steps resolves [J]; 0 where the energy error falls with the step.
    pub unresolved_energy_j: f64,
    /// Remarks for the reader.
    pub remarks: Vec<String>,
    /// Wall time of all runs [s].
    pub wall_s: f64,
    /// Processor time of all runs [s]; null where the system does not tell.
    pub processor_s: Option<f64>,
}

/// A run of a certificate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunRecord {
    /// Its name, that of its folder in `cases`.
    pub name: String,
    /// Step [s].
    pub step_s: f64,
    /// Steps.
    pub steps: u64,
    /// The run's label.
    pub label: String,
    /// Wall time [s].
    pub wall_s: f64,
    /// Processor time [s]; null where the system does not tell.
    pub processor_s: Option<f64>,
    /// CRC-32 of its final state.
    pub state_crc32: String,
}

/// Errors against a closed form, relative.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClosedForm {
    /// Its name in the scene.
    pub kind: String,
    /// At the end.
    pub error_end: f64,
    /// The largest over time.
    pub error_max: f64,
}

/// A quantity and its error bar.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Certified {
    /// Its name, that of its column in `history.csv`.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its value at the end of the run of the shortest step; where the motion is chaotic, the mean of the runs.
    pub value: f64,
    /// The error bar of the value: the sum of `parts`.
    pub error: f64,
    /// The largest error bar over the instants that all runs have in common.
    pub largest_error: f64,
    /// How the results behave as the step falls.
    pub behaviour: Behaviour,
    /// The observed order in Δt; null where there is none.
    pub order: Option<f64>,
    /// Limit of the results; null where no order is observed.
    pub limit: Option<f64>,
    /// Value at the end of the run of the scene's own step.
    pub own_value: f64,
    /// Its error bar.
    pub own_error: f64,
    /// Contributions to the error bar.
    pub parts: Parts,
    /// The largest value of its kind in the run of the shortest step.
    pub scale: f64,
}

/// Contributions to an error bar.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parts {
    /// Of the time step.
    pub step: f64,
    /// Of the mesh; null where it was not asked for.
    pub mesh: Option<f64>,
    /// Of the penalty; null where it was not asked for.
    pub penalty: Option<f64>,
}

/// Histories that quantities are certified from.
pub struct Histories {
    /// Of steps Δt, Δt/2 and Δt/4.
    pub steps: [Table; 3],
    /// Of ever finer meshes, by half; none, one or two.
    pub meshes: Vec<Table>,
    /// Of ever stiffer contact, by a factor of four; none, one or two.
    pub penalties: Vec<Table>,
    /// Of the disturbed twin.
    pub twin: Option<Table>,
}

/// Further input of the estimates.
pub struct Basis<'a> {
    /// Order of the scheme.
    pub order: f64,
    /// Steps of the run of the shortest step.
    pub steps: u64,
    /// The longest step [s].
    pub step_s: f64,
    /// Mass of the lightest block that moves [kg].
    pub least_mass_kg: f64,
    /// Beginnings of the names of more columns.
    pub of: &'a [String],
    /// Whether the motion is chaotic.
    pub is_chaotic: bool,
    /// Whether a table of a load or of a motion turns back within the shortest step.
    pub is_unseen: bool,
}

/// Each quantity of the histories with its error bar.
pub fn certify(histories: &Histories, basis: &Basis) -> Vec<Certified> {
    let [coarse, middle, fine] = &histories.steps;
    let rows = common_rows(&[coarse, middle, fine]);
    let wanted = quantities(fine, basis.of);
    let scales = scales(&wanted, fine);
    let lost_j = unresolved_energy_j(middle, fine);
    let one = |quantity: &Quantity| {
        let floor = rounding(scales[quantity.group], basis.steps);
        let tables = [coarse, middle, fine];
        let runs = [0, 1, 2].map(|k| values_of(tables[k], quantity, &rows[k]));
        let mut certified = of_steps(quantity, &runs, basis.order, floor);
        certified.scale = scales[quantity.group];
        certified.forgive();
        if basis.is_unseen && runs.iter().flatten().any(|value| value.abs() > floor) {
            certified.distrust(quantity.kind, speed_beside(quantity, &wanted, &scales), basis.step_s);
        }
        certified.add(unresolved(quantity.kind, lost_j, basis));
        let more = |tables: &[Table], part: fn([&[f64]; 3], usize, f64) -> f64| {
            refined(fine, tables, quantity, floor, part)
        };
        if !histories.meshes.is_empty() {
            let (end, most) = more(&histories.meshes, mesh_error);
            certified.parts.mesh = Some(end);
            certified.widen(end, most);
        }
        if !histories.penalties.is_empty() {
            let (end, most) = more(&histories.penalties, penalty_error);
            certified.parts.penalty = Some(end);
            certified.widen(end, most);
        }
        if basis.is_chaotic && certified.behaviour != Behaviour::Rounding {
            certified.scatter(&runs, quantity, histories.twin.as_ref());
        }
        certified
    };
    wanted.iter().map(one).collect()
}

/// The error of the time step, from three runs at the instants that they have in common.
fn of_steps(quantity: &Quantity, runs: &[Vec<f64>; 3], theory: f64, floor: f64) -> Certified {
    let rows = runs[0].len();
    let at = |row| estimate([0, 1, 2].map(|k: usize| runs[k][row]), theory, floor);
    let estimates: Vec<Estimate> = (0..rows).map(at).collect();
    let largest = |some: &[Estimate]| some.iter().map(|e| e.error).fold(0.0, f64::max);
    let last = estimates.last().copied().unwrap_or_else(|| estimate([0.0; 3], theory, floor));
    let value = |k: usize| runs[k].last().copied().unwrap_or(0.0);
    // The error of what swings vanishes at instants: the mean over the last fifth of the run counts for the end, too.
    let error = last.error.max(root_mean_square(&estimates[last_fifth(rows)]));
    let tends_to = last.limit.unwrap_or(value(2));
    Certified {
        name: quantity.name.clone(),
        unit: quantity.unit().into(),
        value: value(2),
        error,
        largest_error: largest(&estimates),
        behaviour: last.behaviour,
        order: last.order,
        limit: last.limit,
        own_value: value(0),
        own_error: (value(0) - tends_to).abs() + error,
        parts: Parts { step: error, mesh: None, penalty: None },
        scale: 0.0,
    }
}

impl Certified {
    /// Adds to the error of the time step.
    fn add(&mut self, more: f64) {
        self.parts.step += more;
        self.widen(more, more);
    }

    /// Adds to the error at the end, and to the largest.
    fn widen(&mut self, end: f64, most: f64) {
        self.error += end;
        self.own_error += end;
        self.largest_error += most;
    }

    /// Mean and scatter of the runs, the twin among them: twice the standard deviation.
    fn scatter(&mut self, runs: &[Vec<f64>; 3], quantity: &Quantity, twin: Option<&Table>) {
        let twin = twin.and_then(|table| table.column_near(quantity.column, &quantity.name)?.last().copied());
        let ends: Vec<f64> = runs.iter().filter_map(|run| run.last().copied()).chain(twin).collect();
        let count = ends.len().max(2) as f64;
        let mean = ends.iter().sum::<f64>() / ends.len().max(1) as f64;
        let deviation = (ends.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (count - 1.0)).sqrt();
        // Before runs part, a quantity may still converge.
        if 2.0 * deviation <= self.error && self.behaviour != Behaviour::Spreads {
            return;
        }
        self.value = mean;
        self.error = 2.0 * deviation;
        self.largest_error = self.largest_error.max(self.error);
        self.own_error = (self.own_value - mean).abs() + self.error;
        (self.behaviour, self.order, self.limit) = (Behaviour::Chaotic, None, None);
        self.parts = Parts { step: self.error, mesh: None, penalty: None };
    }
}

/// Error that vibrations of the energy E that no step resolves may add: E to an energy, √(2E/m) to a velocity, and that over the
/// longest step, which is longer than their periods, to a displacement.
fn unresolved(kind: Kind, lost_j: f64, basis: &Basis) -> f64 {
    if basis.least_mass_kg <= 0.0 {
        return 0.0;
    }
    let speed_m_s = (2.0 * lost_j / basis.least_mass_kg).sqrt();
    match kind {
        Kind::Energy => lost_j,
        Kind::Velocity => speed_m_s,
        Kind::Displacement => speed_m_s * basis.step_s,
        Kind::Other => 0.0,
    }
}

/// Error at the end and largest error of the run `fine`, by runs that are finer still.
fn refined(
    fine: &Table,
    finer: &[Table],
    quantity: &Quantity,
    floor: f64,
    part: fn([&[f64]; 3], usize, f64) -> f64,
) -> (f64, f64) {
    let second = finer.get(1).unwrap_or(&finer[0]);
    let tables = [fine, &finer[0], second];
    let rows = common_rows(&tables);
    let columns: Vec<Vec<f64>> =
        tables.iter().zip(&rows).map(|(t, rows)| values_of(t, quantity, rows)).collect();
    let errors = (0..rows[0].len()).map(|row| {
        let at: Vec<&[f64]> = columns.iter().map(|column| &column[row..=row]).collect();
        part([at[0], at[1], at[2]], finer.len(), floor)
    });
    let errors: Vec<f64> = errors.collect();
    (errors.last().copied().unwrap_or(0.0), errors.iter().copied().fold(0.0, f64::max))
}

/// Error of the mesh, by one or two finer ones.
fn mesh_error([own, first, second]: [&[f64]; 3], meshes: usize, floor: f64) -> f64 {
    match meshes {
        1 => estimate_of_coarse(own[0], first[0], FINER, MESH_ORDER),
        _ => estimate_of_coarsest([own[0], first[0], second[0]], FINER, MOST_MESH_ORDER, floor),
    }
}

/// Error of the penalty, by one or two stiffer ones.
fn penalty_error([own, first, second]: [&[f64]; 3], penalties: usize, floor: f64) -> f64 {
    match penalties {
        1 => estimate_of_coarse(own[0], first[0], STIFFER, PENALTY_ORDER),
        _ => estimate_of_coarsest([own[0], first[0], second[0]], STIFFER, PENALTY_ORDER, floor),
    }
}

impl Certificate {
    /// Writes `certificate.json`; returns its text.
    ///
    /// # Errors
    /// [`WriteError`] when it cannot be written, or a number is not finite.
    pub fn write(&self, folder: &Path) -> Result<String, WriteError> {
        let path = folder.join(FILE);
        for quantity in &self.quantities {
            let numbers = [quantity.value, quantity.error, quantity.largest_error, quantity.own_error];
            if !numbers.iter().all(|number| number.is_finite()) {
                let reason = format!("{} is not finite", quantity.name);
                return Err(WriteError::Encode { path, reason });
            }
        }
        write_json(&path, self)
    }

    /// Reads the certificate in a folder; none where there is none, or it has another form.
    pub fn read(folder: &Path) -> Option<Self> {
        let text = std::fs::read_to_string(folder.join(FILE)).ok()?;
        serde_json::from_str(&text).ok().filter(|found: &Self| found.schema == SCHEMA)
    }

    /// A quantity by its name.
    pub fn quantity(&self, name: &str) -> Option<&Certified> {
        self.quantities.iter().find(|quantity| quantity.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::super::quantities::TIME;
    use super::*;

    /// x = t² + error, with kinetic energy.
    fn run(error: f64) -> Table {
        let times: Vec<f64> = (0..=10).map(|k| f64::from(k) / 10.0).collect();
        let x = times.iter().map(|t| t * t + error * t).collect();
        let names = [TIME, "m.displacement_x_m"].map(String::from).to_vec();
        Table { names, columns: vec![times, x] }
    }

    fn basis(is_chaotic: bool) -> Basis<'static> {
        let (order, steps, step_s, least_mass_kg) = (2.0, 40, 0.1, 1.0);
        Basis { order, steps, step_s, least_mass_kg, of: &[], is_chaotic, is_unseen: false }
    }

    fn histories(errors: [f64; 3]) -> Histories {
        Histories { steps: errors.map(run), meshes: Vec::new(), penalties: Vec::new(), twin: None }
    }

    #[test]
    fn the_bar_of_the_last_run_holds_its_error_and_that_of_the_first_its_own() {
        let certified = &certify(&histories([1.6e-2, 4e-3, 1e-3]), &basis(false))[0];
        assert_eq!(certified.behaviour, Behaviour::Converges);
        assert!((certified.limit.unwrap() - 1.0).abs() < 1e-12, "{certified:?}");
        assert!((1e-3..3e-3).contains(&certified.error), "{certified:?}");
        assert!((1.6e-2..2e-2).contains(&certified.own_error), "{certified:?}");
        assert_eq!(certified.parts.step, certified.error);
    }

    #[test]
    fn mesh_and_penalty_add_their_own_parts() {
        let mut all = histories([1.6e-3, 4e-4, 1e-4]);
        // Own mesh: error 0.2 above that of the step, half of it with half the cells.
        all.meshes = vec![run(1e-4 - 0.1)];
        all.penalties = vec![run(1e-4 - 0.03), run(1e-4 - 0.0375)];
        let certified = &certify(&all, &basis(false))[0];
        let parts = certified.parts;
        assert!((0.2..0.5).contains(&parts.mesh.unwrap()), "{parts:?}");
        assert!((0.04..0.09).contains(&parts.penalty.unwrap()), "{parts:?}");
        let sum = parts.step + parts.mesh.unwrap() + parts.penalty.unwrap();
        assert!((certified.error - sum).abs() < 1e-12);
    }

    #[test]
    fn a_chaotic_motion_has_mean_and_scatter() {
        let mut all = histories([0.3, -0.2, 0.1]);
        all.twin = Some(run(-0.4));
        let certified = &certify(&all, &basis(true))[0];
        assert_eq!((certified.behaviour, certified.order), (Behaviour::Chaotic, None));
        assert!((certified.value - 0.95).abs() < 1e-12 && certified.error > 0.3, "{certified:?}");
    }
}
