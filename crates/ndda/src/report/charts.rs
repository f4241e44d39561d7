//! Curves over time: the columns of the history, grouped by what they are.

use ndda_io::results::{BoltForces, Table};
use serde::Serialize;

use super::motion::Motion;
use crate::numbers::split_unit;

/// Rows of a history that a page holds; longer ones are thinned.
const MOST_ROWS: usize = 2000;
/// Monitors that have curves.
const MOST_MONITORS: usize = 12;
/// Blocks whose displacement has a curve.
const MOST_BLOCKS: usize = 6;
/// Bolts whose tension has a curve.
const MOST_BOLTS: usize = 6;
const TIME: &str = "time_s";

/// Curves of a page.
#[derive(Debug, Default, Serialize)]
pub struct Charts {
    time_s: Vec<f64>,
    /// The charts, in the order of the page.
    pub charts: Vec<Chart>,
    /// Notes on what is left out, for people.
    #[serde(skip)]
    pub notes: Vec<String>,
}

/// Curves over one pair of axes.
#[derive(Debug, PartialEq, Serialize)]
pub struct Chart {
    /// Title.
    pub title: String,
    unit: &'static str,
    is_log: bool,
    /// Its own times [s], where they are not those of the history.
    #[serde(skip_serializing_if = "Option::is_none")]
    time_s: Option<Vec<f64>>,
    curves: Vec<Curve>,
}

#[derive(Debug, PartialEq, Serialize)]
struct Curve {
    label: String,
    /// Values; what is not a number, or not above zero on a logarithmic axis, is a gap.
    values: Vec<f32>,
}

/// The chart that a column belongs to, and its name there.
struct Place {
    title: String,
    label: String,
    unit: &'static str,
    is_log: bool,
}

impl Charts {
    /// The curves of a history. Columns that are zero throughout are left out.
    pub fn new(history: &Table) -> Self {
        let Some(time) = history.names.iter().position(|name| name == TIME) else { return Self::default() };
        let rows = history.columns[time].len();
        let every = rows.div_ceil(MOST_ROWS).max(1);
        let kept: Vec<usize> = (0..rows).filter(|row| row % every == 0 || row + 1 == rows).collect();
        let mut notes = Vec::new();
        if every > 1 {
            notes.push(format!("Curves show one in {every} of the {rows} rows of history.csv."));
        }
        let mut monitors: Vec<&str> = Vec::new();
        let mut charts: Vec<Chart> = Vec::new();
        for (name, column) in history.names.iter().zip(&history.columns) {
            if let Some((monitor, _)) =
                name.rsplit_once('.').filter(|(monitor, _)| !monitors.contains(monitor))
            {
                monitors.push(monitor);
            }
            if name == TIME || monitors.len() > MOST_MONITORS || column.iter().all(|&value| value == 0.0) {
                continue;
            }
            let place = place(name);
            let value =
                |&row: &usize| if place.is_log && column[row] <= 0.0 { f32::NAN } else { column[row] as f32 };
            let curve = Curve { label: place.label, values: kept.iter().map(value).collect() };
            match charts.iter_mut().find(|chart| chart.title == place.title) {
                Some(chart) => chart.curves.push(curve),
                None => {
                    let Place { title, unit, is_log, .. } = place;
                    charts.push(Chart { title, unit, is_log, time_s: None, curves: vec![curve] });
                }
            }
        }
        if monitors.len() > MOST_MONITORS {
            notes.push(format!(
                "The first {MOST_MONITORS} monitors have curves; the others are in history.csv."
            ));
        }
        charts.sort_by_key(|chart| rank(&chart.title));
        Self { time_s: kept.iter().map(|&row| history.columns[time][row]).collect(), charts, notes }
    }
}

impl Charts {
    /// With the displacements of the blocks that went farthest, by the frames of a run.
    pub fn with_motion(mut self, motion: Option<&Motion>, block_names: &[&str]) -> Self {
        let Some(motion) = motion else { return self };
        let mut blocks = motion.displacements();
        let end = |curve: &[f32]| curve.iter().copied().fold(0.0, f32::max);
        blocks.sort_by(|a, b| end(&b.1).total_cmp(&end(&a.1)).then(a.0.cmp(&b.0)));
        let moved = blocks.into_iter().take(MOST_BLOCKS).filter(|(_, curve)| end(curve) > 0.0);
        let curves: Vec<Curve> = moved
            .map(|(block, values)| Curve {
                label: block_names.get(block).map_or_else(|| format!("block {block}"), ToString::to_string),
                values,
            })
            .collect();
        if !curves.is_empty() {
            let title = "Displacement of the blocks that went farthest".into();
            let time_s = Some(motion.times_s.clone());
            self.charts.insert(0, Chart { title, unit: "m", is_log: false, time_s, curves });
        }
        self
    }
}

impl Charts {
    /// With the tensions of the bolts that carry most, by the frames of a run.
    pub fn with_bolts(mut self, forces: &BoltForces) -> Self {
        let most = |curve: &[f64]| curve.iter().map(|force| force.abs()).fold(0.0, f64::max);
        let mut bolts: Vec<_> = forces.bolts.iter().filter(|(_, curve)| most(curve) > 0.0).collect();
        bolts.sort_by(|(_, a), (_, b)| most(b).total_cmp(&most(a)));
        let curve = |(name, curve): &(String, Vec<f64>)| Curve {
            label: name.clone(),
            values: curve.iter().map(|force_n| (1e-3 * force_n) as f32).collect(),
        };
        let curves: Vec<Curve> = bolts.into_iter().take(MOST_BOLTS).map(curve).collect();
        if !curves.is_empty() {
            let (title, time_s) =
                ("Tension of the bolts that carry most".into(), Some(forces.times_s.clone()));
            let place = self.charts.len().min(1);
            self.charts.insert(place, Chart { title, unit: "kN", is_log: false, time_s, curves });
        }
        self
    }
}

const ENERGY: &str = "Energy";
const WORK: &str = "Work and balance";
const ERROR: &str = "Error against the closed form";
const MOMENTUM: &str = "Momentum";
const ANGULAR: &str = "Angular momentum";

/// Error and energies come first, then monitors, what is not known here, and momentum last.
fn rank(title: &str) -> usize {
    match title {
        ERROR => 0,
        ENERGY => 1,
        WORK => 2,
        MOMENTUM | ANGULAR => 5,
        _ if title.contains(": ") => 3,
        _ => 4,
    }
}

fn place(name: &str) -> Place {
    if name == "h" {
        return Place {
            title: "Contact stability number".into(),
            label: "h".into(),
            unit: "",
            is_log: false,
        };
    }
    let (words, unit) = split_unit(name);
    let (title, label) = match words.rsplit_once('.') {
        Some((monitor, component)) => {
            let (quantity, axis) = component.rsplit_once('_').unwrap_or((component, component));
            (format!("{monitor}: {}", quantity.replace('_', " ")), axis.to_string())
        }
        None => group(words, unit),
    };
    Place { title, label, unit, is_log: name.starts_with("reference_error") }
}

/// The chart of a column of the whole scene, and its label.
fn group(words: &str, unit: &str) -> (String, String) {
    let plain = words.replace('_', " ");
    if words.starts_with("reference_error") {
        return (ERROR.into(), plain);
    }
    if let Some(axis) = words.strip_prefix("momentum_") {
        return (MOMENTUM.into(), axis.into());
    }
    if let Some(axis) = words.strip_prefix("angular_") {
        return (ANGULAR.into(), axis.into());
    }
    match unit {
        "J" if words.ends_with("_work") || words == "balance" => (WORK.into(), plain),
        "J" => (ENERGY.into(), plain),
        _ => {
            let mut letters = plain.chars();
            let capital = letters.next().map(|first| first.to_uppercase().chain(letters).collect());
            (capital.unwrap_or_default(), plain)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(columns: &[(&str, Vec<f64>)]) -> Table {
        Table {
            names: columns.iter().map(|(name, _)| name.to_string()).collect(),
            columns: columns.iter().map(|(_, values)| values.clone()).collect(),
        }
    }

    #[test]
    fn columns_are_grouped_by_what_they_are_and_zeros_left_out() {
        let some = || vec![0.0, 1.0];
        let charts = Charts::new(&table(&[
            (TIME, some()),
            ("kinetic_j", some()),
            ("spring_j", vec![0.0, 0.0]),
            ("friction_work_j", some()),
            ("momentum_x_kg_m_s", some()),
            ("contact_pairs", some()),
            ("a.b.displacement_x_m", some()),
            ("a.b.displacement_z_m", some()),
            ("reference_error", some()),
        ]));
        let found: Vec<_> = charts
            .charts
            .iter()
            .map(|c| {
                (c.title.as_str(), c.unit, c.curves.iter().map(|l| l.label.as_str()).collect::<Vec<_>>())
            })
            .collect();
        let expected = [
            (ERROR, "", vec!["reference error"]),
            (ENERGY, "J", vec!["kinetic"]),
            (WORK, "J", vec!["friction work"]),
            ("a.b: displacement", "m", vec!["x", "z"]),
            ("Contact pairs", "", vec!["contact pairs"]),
            (MOMENTUM, "kg m/s", vec!["x"]),
        ];
        assert_eq!(found, expected);
        assert!(charts.charts[0].is_log && charts.charts[0].curves[0].values[0].is_nan());
        assert!(charts.notes.is_empty());
    }

    #[test]
    fn bolts_that_carry_most_have_curves() {
        let bolts = (0..9).map(|k| (format!("b{k}"), vec![f64::NAN, -1e3 * f64::from(k)])).collect();
        let forces = BoltForces { times_s: vec![0.0, 1.0], bolts };
        let charts = Charts::default().with_bolts(&forces);
        let curves = &charts.charts[0].curves;
        assert_eq!(
            curves.iter().map(|c| c.label.as_str()).collect::<Vec<_>>(),
            ["b8", "b7", "b6", "b5", "b4", "b3"]
        );
        assert!(curves[0].values[0].is_nan() && curves[0].values[1] == -8.0);
        assert!(Charts::default().with_bolts(&BoltForces::default()).charts.is_empty());
    }

    #[test]
    fn a_long_history_is_thinned_keeps_its_end_and_says_so() {
        let time: Vec<f64> = (0..5003).map(f64::from).collect();
        let charts = Charts::new(&table(&[(TIME, time.clone()), ("kinetic_j", time)]));
        assert_eq!(charts.time_s.last(), Some(&5002.0));
        assert!(
            charts.time_s.len() <= MOST_ROWS + 1 && charts.notes[0].contains("one in 3 "),
            "{:?}",
            charts.notes
        );
    }

    #[test]
    fn a_history_without_time_or_rows_gives_no_curves() {
        assert!(Charts::new(&table(&[("kinetic_j", vec![1.0])])).charts.is_empty());
        assert!(Charts::new(&table(&[(TIME, vec![]), ("kinetic_j", vec![])])).charts.is_empty());
        assert!(Charts::new(&Table::default()).charts.is_empty());
    }
}
