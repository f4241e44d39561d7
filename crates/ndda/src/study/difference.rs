//! How far two runs are apart: displacements of monitors over time.

use std::ops::Range;

use ndda_io::table::Table;

/// A difference of two motions over the largest displacement of the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// At the end of the first.
    pub end: f64,
    /// The largest over time.
    pub max: f64,
}

/// Why two histories cannot be compared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DifferenceError {
    /// A column is missing.
    #[error("the history has no column `{0}`: name a monitor of the scene, or add one")]
    NoColumn(String),
    /// Too few rows.
    #[error("the history has fewer than two rows: raise output.history_rows")]
    TooShort,
    /// No block moves.
    #[error("no monitor moves in the reference run: name monitors that move")]
    NothingMoves,
}

/// The motion of one monitor along one axis.
struct Track<'a> {
    place_m: &'a [f64],
    velocity_m_s: &'a [f64],
}

/// Compares the displacement of `monitors` in `run` with that in `reference`, between whose rows cubic Hermite
/// interpolation reads: displacement and velocity are both in a history.
///
/// # Errors
/// [`DifferenceError`] when monitors are missing or nothing moves.
pub fn difference(
    run: &Table,
    reference: &Table,
    monitors: &[String],
) -> Result<Difference, DifferenceError> {
    let (times, reference_times) = (column(run, "time_s")?, column(reference, "time_s")?);
    if times.is_empty() || reference_times.len() < 2 {
        return Err(DifferenceError::TooShort);
    }
    let mut size_m = 0.0f64;
    let (mut end_m, mut max_m) = (0.0f64, 0.0f64);
    for monitor in monitors {
        let (own, other) = (tracks(run, monitor)?, tracks(reference, monitor)?);
        size_m = (0..reference_times.len())
            .map(|i| norm(other.each_ref().map(|t| t.place_m[i])))
            .fold(size_m, f64::max);
        let mut last_m = 0.0;
        // Ends are rounded to whole steps; beyond the reference there is nothing to compare with.
        for (i, &time_s) in times.iter().enumerate() {
            let Some(rows) = around(reference_times, time_s) else { break };
            let apart = [0, 1, 2].map(|k| own[k].place_m[i] - other[k].at(reference_times, &rows, time_s));
            last_m = norm(apart);
            max_m = max_m.max(last_m);
        }
        end_m = end_m.max(last_m);
    }
    if size_m == 0.0 {
        return Err(DifferenceError::NothingMoves);
    }
    Ok(Difference { end: end_m / size_m, max: max_m / size_m })
}

fn column<'a>(table: &'a Table, name: &str) -> Result<&'a [f64], DifferenceError> {
    table.column(name).ok_or_else(|| DifferenceError::NoColumn(name.into()))
}

fn tracks<'a>(table: &'a Table, monitor: &str) -> Result<[Track<'a>; 3], DifferenceError> {
    let track = |axis| {
        let place_m = column(table, &format!("{monitor}.displacement_{axis}_m"))?;
        let velocity_m_s = column(table, &format!("{monitor}.velocity_{axis}_m_s"))?;
        Ok(Track { place_m, velocity_m_s })
    };
    Ok([track("x")?, track("y")?, track("z")?])
}

fn norm(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The two rows around a time; a little rounding beyond the last row is allowed.
fn around(times: &[f64], time_s: f64) -> Option<Range<usize>> {
    let last = times.len() - 1;
    if time_s > times[last] * (1.0 + 1e-9) {
        return None;
    }
    let after = times.partition_point(|t| *t <= time_s).clamp(1, last);
    Some(after - 1..after)
}

impl Track<'_> {
    /// Cubic Hermite interpolation between two rows.
    fn at(&self, times: &[f64], rows: &Range<usize>, time_s: f64) -> f64 {
        let (a, b) = (rows.start, rows.end);
        let length_s = times[b] - times[a];
        let x = (time_s - times[a]) / length_s;
        let y = 1.0 - x;
        let places = self.place_m[a] * y * y * (1.0 + 2.0 * x) + self.place_m[b] * x * x * (1.0 + 2.0 * y);
        places + length_s * x * y * (self.velocity_m_s[a] * y - self.velocity_m_s[b] * x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x = t³ + extra, y = 2 − t, z = 0 with its velocity, at the given times.
    fn motion(times: &[f64], extra: f64) -> Table {
        let each = |value: fn(f64) -> f64| times.iter().map(|t| value(*t)).collect::<Vec<_>>();
        let zeros = vec![0.0; times.len()];
        let names = ["time_s", "m.displacement_x_m", "m.displacement_y_m", "m.displacement_z_m"];
        let velocities = ["m.velocity_x_m_s", "m.velocity_y_m_s", "m.velocity_z_m_s"];
        let x = times.iter().map(|t| t * t * t + extra).collect();
        let places = vec![times.to_vec(), x, each(|t| 2.0 - t), zeros.clone()];
        let speeds = vec![each(|t| 3.0 * t * t), each(|_| -1.0), zeros];
        Table {
            names: names.iter().chain(&velocities).map(|name| name.to_string()).collect(),
            columns: places.into_iter().chain(speeds).collect(),
        }
    }

    #[test]
    fn a_cubic_motion_is_read_exactly_between_rows() {
        let reference = motion(&[0.0, 0.7, 1.0, 2.0], 0.0);
        let run = motion(&[0.0, 0.1, 0.9, 1.3, 2.0], 0.0);
        let apart = difference(&run, &reference, &["m".into()]).unwrap();
        assert!(apart.max < 1e-15, "{apart:?}");
    }

    #[test]
    fn an_offset_is_relative_to_the_largest_motion_of_the_reference() {
        // The largest displacement is (8, 0, 0) at t = 2.
        let reference = motion(&[0.0, 1.0, 2.0], 0.0);
        let run = motion(&[0.0, 0.5, 1.9, 2.5], 0.04);
        let apart = difference(&run, &reference, &["m".into()]).unwrap();
        assert!((apart.max - 0.005).abs() < 1e-15 && (apart.end - 0.005).abs() < 1e-15, "{apart:?}");
    }

    #[test]
    fn what_cannot_be_compared_is_said() {
        let table = motion(&[0.0, 1.0], 0.0);
        let refused = |name: &str, other: &Table| difference(&table, other, &[name.into()]).unwrap_err();
        assert!(refused("nobody", &table).to_string().contains("nobody.displacement_x_m"));
        let mut still = table.clone();
        still.columns[1..].iter_mut().flatten().for_each(|x| *x = 0.0);
        assert_eq!(refused("m", &still), DifferenceError::NothingMoves);
        assert_eq!(refused("m", &motion(&[0.0], 0.0)), DifferenceError::TooShort);
    }
}
