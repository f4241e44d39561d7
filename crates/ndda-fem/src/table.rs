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
}
