//! Tables over time that turn back within a step, which sees their mean only.

use super::{FactorRow, Hold, MotionRow, Scene};

/// Rows of a table: times [s], and values of which one or three change.
pub(crate) struct Rows {
    pub(crate) times_s: Vec<f64>,
    pub(crate) values: Vec<[f64; 3]>,
}

/// Where a table turns back, and within how many seconds.
#[derive(Clone, Debug, PartialEq)]
pub struct Turning {
    /// The table in the scene.
    pub path: String,
    /// From the row before it leaves to the row after it has come back [s].
    pub within_s: f64,
}

impl Rows {
    pub(crate) fn of_factor(rows: &[FactorRow]) -> Self {
        Self {
            times_s: rows.iter().map(|row| row.time_s).collect(),
            values: rows.iter().map(|row| [row.factor, 0.0, 0.0]).collect(),
        }
    }

    pub(crate) fn of_motion(rows: &[MotionRow]) -> Self {
        Self {
            times_s: rows.iter().map(|row| row.time_s).collect(),
            values: rows.iter().map(|row| row.displacement_m).collect(),
        }
    }

    /// The first row at which the table turns back within less than a step, and the time that this takes [s]. Rows between which nothing changes belong to the turn.
    pub(crate) fn turns_within(&self, step_s: f64) -> Option<(usize, f64)> {
        let way =
            |i: usize| -> [f64; 3] { std::array::from_fn(|k| self.values[i + 1][k] - self.values[i][k]) };
        let along = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
        let mut before: Option<usize> = None;
        for i in (0..self.values.len().saturating_sub(1)).filter(|&i| way(i) != [0.0; 3]) {
            if let Some(last) = before {
                let within_s = self.times_s[i + 1] - self.times_s[last];
                if within_s < step_s && along(&way(last), &way(i)) < 0.0 {
                    return Some((i, within_s));
                }
            }
            before = Some(i);
        }
        None
    }
}

impl Scene {
    /// The first table of a load or of a motion that turns back within less than `step_s`.
    pub fn turns_within(&self, step_s: f64) -> Option<Turning> {
        let factors =
            |list: &str, i: usize, rows: &[FactorRow]| (format!("{list}[{i}].factor"), Rows::of_factor(rows));
        let forces = self.forces.iter().enumerate().map(|(i, load)| factors("forces", i, &load.factor));
        let tractions =
            self.tractions.iter().enumerate().map(|(i, load)| factors("tractions", i, &load.factor));
        let water = self.water.iter().enumerate().map(|(i, load)| factors("water", i, &load.factor));
        let motions = self.supports.iter().enumerate().filter_map(|(i, support)| match &support.hold {
            Hold::Motion(rows) => Some((format!("supports[{i}].hold"), Rows::of_motion(rows))),
            _ => None,
        });
        let mut tables = forces.chain(tractions).chain(water).chain(motions);
        tables.find_map(|(path, rows)| {
            let (_, within_s) = rows.turns_within(step_s)?;
            Some(Turning { path, within_s })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factor(rows: &[(f64, f64)]) -> Rows {
        let rows: Vec<FactorRow> =
            rows.iter().map(|&(time_s, factor)| FactorRow { time_s, factor }).collect();
        Rows::of_factor(&rows)
    }

    #[test]
    fn a_blow_turns_back_within_a_step_also_where_it_lasts_a_while() {
        let blow = factor(&[(1.0, 0.0), (1.5, 1.0), (2.0, 0.0)]);
        assert_eq!(blow.turns_within(1.1), Some((1, 1.0)));
        assert_eq!(blow.turns_within(1.0), None);
        let lasting = factor(&[(1.0, 0.0), (1.5, 1.0), (2.0, 1.0), (2.5, 0.0)]);
        assert_eq!(lasting.turns_within(2.0), Some((2, 1.5)));
        assert_eq!(lasting.turns_within(1.0), None);
    }

    #[test]
    fn a_table_that_rises_in_one_step_does_not_turn_back() {
        assert_eq!(factor(&[(0.0, 0.0), (0.1, 1.0), (0.2, 2.0)]).turns_within(1.0), None);
        assert_eq!(factor(&[]).turns_within(1.0), None);
    }
}
