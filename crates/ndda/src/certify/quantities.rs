//! Certified quantities: the columns of histories, read at the instants that all runs have in common.

use std::ops::Range;

use ndda_io::table::Table;

use crate::numbers::split_unit;

/// Energies of a history that are certified [J].
const ENERGIES: [&str; 9] = [
    "kinetic_j",
    "strain_j",
    "contact_j",
    "load_j",
    "spring_j",
    "friction_work_j",
    "damping_work_j",
    "restitution_work_j",
    "radiated_j",
];
/// Column of time.
pub const TIME: &str = "time_s";
/// Energy that is there without a cause, numerical error.
const BALANCE: &str = "balance_j";
/// The name of the monitor of a block's centre is this and the name of the block.
pub const BLOCK: &str = "block ";
/// Instants nearer than this part of the last one are the same.
const SAME_TIME: f64 = 1e-9;
/// Rounding of a sum of n steps is taken as this times n ε of the largest value.
const ROUNDING: f64 = 8.0;

/// Kind of a quantity, which decides what unresolved vibration adds to its error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A displacement [m].
    Displacement,
    /// A velocity [m/s].
    Velocity,
    /// An energy or work [J].
    Energy,
    /// Another column of the history.
    Other,
}

/// A column that is certified.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Its name in the history.
    pub name: String,
    /// Number of its column.
    pub column: usize,
    /// Kind of the quantity.
    pub kind: Kind,
    /// Quantities of one group share their scale: the components of a vector, the energies.
    pub group: usize,
}

impl Quantity {
    /// Its unit; empty where the name of the column says none.
    pub fn unit(&self) -> &'static str {
        match self.kind {
            Kind::Displacement => "m",
            Kind::Velocity => "m/s",
            Kind::Energy => "J",
            Kind::Other => split_unit(&self.name).1,
        }
    }

    /// The block whose centre it belongs to, if it is one that is added for every block.
    pub fn block(&self) -> Option<&str> {
        let (monitor, _) = self.name.rsplit_once('.')?;
        monitor.strip_prefix(BLOCK)
    }
}

/// The quantities of a history: monitors and blocks, energies that are not zero throughout, and the columns whose names
/// begin with one of `of`.
pub fn quantities(history: &Table, of: &[String]) -> Vec<Quantity> {
    let mut groups: Vec<String> = Vec::new();
    let mut found = Vec::new();
    for (number, (name, column)) in history.names.iter().zip(&history.columns).enumerate() {
        let asked = of.iter().any(|wanted| name.starts_with(wanted.as_str()));
        let (kind, group) = match name.rsplit_once('.') {
            Some((monitor, quantity)) if quantity.starts_with("displacement_") => {
                (Kind::Displacement, format!("{monitor}.displacement"))
            }
            Some((monitor, quantity)) if quantity.starts_with("velocity_") => {
                (Kind::Velocity, format!("{monitor}.velocity"))
            }
            None if ENERGIES.contains(&name.as_str()) => {
                if !asked && column.iter().all(|value| *value == 0.0) {
                    continue;
                }
                (Kind::Energy, "energy".into())
            }
            _ if asked && name != TIME => (Kind::Other, vector(name)),
            _ => continue,
        };
        // Components of a vector stand side by side.
        let group = groups.iter().rposition(|known| *known == group).unwrap_or_else(|| {
            groups.push(group);
            groups.len() - 1
        });
        found.push(Quantity { name: name.clone(), column: number, kind, group });
    }
    found
}

/// Whether a quantity is asked for by the beginning of its name, or of that of its block.
pub fn named(quantity: &str, wanted: &str) -> bool {
    quantity.starts_with(wanted) || quantity.strip_prefix(BLOCK).is_some_and(|name| name.starts_with(wanted))
}

/// The vector that a column is a component of, or itself.
fn vector(name: &str) -> String {
    ["_x_", "_y_", "_z_"].iter().fold(name.to_string(), |name, axis| name.replace(axis, "_"))
}

/// Rows of each table at the instants that all tables have in common.
pub fn common_rows(tables: &[&Table]) -> Vec<Vec<usize>> {
    let times: Vec<&[f64]> = tables.iter().map(|table| table.column(TIME).unwrap_or_default()).collect();
    let mut rows = vec![Vec::new(); tables.len()];
    let Some((first, others)) = times.split_first() else { return rows };
    let near = SAME_TIME * first.last().copied().unwrap_or(0.0);
    'instants: for (i, &time_s) in first.iter().enumerate() {
        let mut here = vec![i];
        for other in others {
            let next = other.partition_point(|t| *t < time_s - near);
            match other.get(next) {
                Some(t) if (t - time_s).abs() <= near => here.push(next),
                _ => continue 'instants,
            }
        }
        rows.iter_mut().zip(here).for_each(|(rows, row)| rows.push(row));
    }
    rows
}

/// The values of a column at some rows; zeros where there is no such column.
pub fn values(table: &Table, name: &str, rows: &[usize]) -> Vec<f64> {
    at_rows(table.column(name), rows)
}

/// The same of a quantity.
pub fn values_of(table: &Table, quantity: &Quantity, rows: &[usize]) -> Vec<f64> {
    at_rows(table.column_near(quantity.column, &quantity.name), rows)
}

fn at_rows(column: Option<&[f64]>, rows: &[usize]) -> Vec<f64> {
    column.map_or_else(|| vec![0.0; rows.len()], |column| rows.iter().map(|&i| column[i]).collect())
}

/// The largest value of each group in a history.
pub fn scales(quantities: &[Quantity], history: &Table) -> Vec<f64> {
    let mut scales = vec![0.0f64; quantities.iter().map(|q| q.group + 1).max().unwrap_or(0)];
    for quantity in quantities {
        let column = history.column_near(quantity.column, &quantity.name).unwrap_or_default();
        scales[quantity.group] = column.iter().map(|v| v.abs()).fold(scales[quantity.group], f64::max);
    }
    scales
}

/// The largest speed of the monitor that a quantity belongs to [m/s].
pub fn speed_beside(quantity: &Quantity, all: &[Quantity], scales: &[f64]) -> f64 {
    let monitor = |quantity: &Quantity| quantity.name.rsplit_once('.').map(|(monitor, _)| monitor.to_owned());
    let is_beside = |other: &&Quantity| other.kind == Kind::Velocity && monitor(other) == monitor(quantity);
    all.iter().find(is_beside).map_or(0.0, |velocity| scales[velocity.group])
}

/// Differences below this say nothing about values of a size after a number of steps.
pub fn rounding(scale: f64, steps: u64) -> f64 {
    ROUNDING * f64::EPSILON * steps.max(1) as f64 * scale
}

/// Energy [J] that the scheme takes out of the motion, or puts into it, whatever the step: that of vibrations which none
/// of the steps resolves, and whose damping is therefore the same in all runs. Zero where it falls with the step.
pub fn unresolved_energy_j(coarse: &Table, fine: &Table) -> f64 {
    /// An energy error that falls less than to this part when the step is halved does not fall.
    const STAYS: f64 = 0.7;
    let largest = |table: &Table, name: &str| {
        table.column(name).unwrap_or_default().iter().map(|v| v.abs()).fold(0.0, f64::max)
    };
    let scale = ENERGIES.iter().map(|name| largest(fine, name)).fold(0.0, f64::max);
    let [before, after] = [coarse, fine].map(|table| largest(table, BALANCE));
    let steps = fine.column(TIME).map_or(0, <[f64]>::len) as u64;
    if after > STAYS * before && after > rounding(scale, steps) { after } else { 0.0 }
}

/// The last fifth of some rows.
pub fn last_fifth(rows: usize) -> Range<usize> {
    rows - rows.div_ceil(5)..rows
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(columns: &[(&str, &[f64])]) -> Table {
        Table {
            names: columns.iter().map(|(name, _)| name.to_string()).collect(),
            columns: columns.iter().map(|(_, values)| values.to_vec()).collect(),
        }
    }

    #[test]
    fn monitors_blocks_and_energies_are_certified_and_what_is_asked_for() {
        let history = table(&[
            (TIME, &[0.0, 1.0]),
            ("kinetic_j", &[0.0, 2.0]),
            ("spring_j", &[0.0, 0.0]),
            ("balance_j", &[0.0, 1e-3]),
            ("momentum_x_kg_m_s", &[0.0, 1.0]),
            ("block a.displacement_x_m", &[0.0, 1.0]),
            ("block a.displacement_y_m", &[0.0, -4.0]),
            ("block a.velocity_x_m_s", &[0.0, 1.0]),
        ]);
        let names = |of: &[String]| -> Vec<String> {
            quantities(&history, of).into_iter().map(|quantity| quantity.name).collect()
        };
        let always =
            ["kinetic_j", "block a.displacement_x_m", "block a.displacement_y_m", "block a.velocity_x_m_s"];
        assert_eq!(names(&[]), always);
        assert_eq!(names(&["momentum".into(), "spring".into()]).len(), 6);
        let found = quantities(&history, &[]);
        assert_eq!((found[1].block(), found[1].unit(), found[3].unit()), (Some("a"), "m", "m/s"));
        assert_eq!(scales(&found, &history)[found[1].group], 4.0);
    }

    #[test]
    fn runs_are_compared_at_the_instants_that_they_share() {
        let coarse = table(&[(TIME, &[0.0, 0.4, 1.0])]);
        let fine = table(&[(TIME, &[0.0, 0.2, 0.4 + 1e-13, 0.7, 1.0])]);
        assert_eq!(common_rows(&[&coarse, &fine]), [[0, 1, 2], [0, 2, 4]]);
        assert_eq!(common_rows(&[&coarse, &table(&[(TIME, &[0.0, 0.3])])]), [[0], [0]]);
    }

    #[test]
    fn energy_that_is_lost_at_every_step_is_unresolved() {
        let run =
            |lost: f64| table(&[(TIME, &[0.0, 1.0]), ("kinetic_j", &[10.0, 10.0]), (BALANCE, &[0.0, -lost])]);
        assert_eq!(unresolved_energy_j(&run(1e-3), &run(9e-4)), 9e-4);
        assert_eq!(unresolved_energy_j(&run(1e-3), &run(2.5e-4)), 0.0);
        assert_eq!(unresolved_energy_j(&run(1e-15), &run(1e-15)), 0.0);
    }
}
