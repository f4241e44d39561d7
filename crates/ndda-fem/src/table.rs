//! Values over time, linear between rows and constant outside.

use std::ops::{Add, Mul, Sub};

/// Linear between rows, constant before the first and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Time [s], ascending, and value.
    pub rows: Vec<(f64, f64)>,
}

impl Table {
    /// The value at a time [s].
    pub fn at(&self, time_s: f64) -> f64 {
        interpolated(&self.rows, time_s).unwrap_or(0.0)
    }

    /// Mean of the value between two times, `from_s` before `to_s`, and how far its integral overshoots.
    pub fn between(&self, from_s: f64, to_s: f64) -> Between {
        let first = self.rows.partition_point(|row| row.0 <= from_s);
        let last = self.rows.partition_point(|row| row.0 < to_s);
        if last <= first {
            return Between { mean: self.at(0.5 * (from_s + to_s)), beyond_s: 0.0 };
        }
        let (mut before, mut sum) = ((from_s, self.at(from_s)), 0.0);
        let (mut most, mut least) = (0.0f64, 0.0f64);
        for &row in self.rows[first..last].iter().chain(&[(to_s, self.at(to_s))]) {
            // The integral turns where the value changes sign.
            let turn = if before.1 * row.1 < 0.0 { before.1 / (before.1 - row.1) } else { 0.0 };
            let at_turn = sum + 0.5 * before.1 * turn * (row.0 - before.0);
            sum += 0.5 * (before.1 + row.1) * (row.0 - before.0);
            (most, least) = (most.max(at_turn).max(sum), least.min(at_turn).min(sum));
            before = row;
        }
        let beyond_s = (most - sum.max(0.0)).max(sum.min(0.0) - least);
        Between { mean: sum / (to_s - from_s), beyond_s }
    }
}

/// Behaviour of a table between two times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    /// Its mean, exact.
    pub mean: f64,
    /// How far the integral from the first time on leaves the interval between 0 and its final value [s, times the unit of the table]: what comes and goes
    /// in between, which the mean does not show.
    pub beyond_s: f64,
}

/// The value of a table of (time [s], value) at a time; none without rows.
pub(crate) fn interpolated<T>(rows: &[(f64, T)], time_s: f64) -> Option<T>
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T>,
{
    let after = rows.partition_point(|row| row.0 <= time_s);
    if after == 0 {
        return rows.first().map(|row| row.1);
    }
    let (t0, y0) = rows[after - 1];
    Some(match rows.get(after) {
        Some(&(t1, y1)) => y0 + (y1 - y0) * ((time_s - t0) / (t1 - t0)),
        None => y0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_linear_between_rows_and_constant_outside() {
        let table = Table { rows: vec![(1.0, 2.0), (3.0, 6.0)] };
        assert_eq!([0.0, 1.0, 2.0, 3.0, 9.0].map(|t| table.at(t)), [2.0, 2.0, 4.0, 6.0, 6.0]);
        assert_eq!(Table { rows: Vec::new() }.at(1.0), 0.0);
    }

    #[test]
    fn the_mean_between_two_times_is_exact_wherever_the_rows_are() {
        let table = Table { rows: vec![(1.0, 0.0), (2.0, 4.0), (3.0, -4.0), (4.0, 0.0)] };
        for (from, to, mean, beyond) in [
            (0.0, 0.5, 0.0, 0.0),
            (1.25, 1.75, 2.0, 0.0),
            (0.0, 2.0, 1.0, 0.0),
            (0.0, 4.0, 0.0, 3.0),
            (2.5, 9.0, -3.0 / 6.5, 0.0),
            (0.0, 3.0, 2.0 / 3.0, 1.0),
        ] {
            let found = table.between(from, to);
            assert!((found.mean - mean).abs() < 1e-15, "{from} to {to}: {found:?}");
            assert!((found.beyond_s - beyond).abs() < 1e-15, "{from} to {to}: {found:?}");
        }
        assert_eq!(Table { rows: Vec::new() }.between(0.0, 1.0), Between { mean: 0.0, beyond_s: 0.0 });
    }
}
