//! A number over time.

/// Linear between rows, constant before the first and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Time [s], ascending, and value.
    pub rows: Vec<(f64, f64)>,
}

impl Table {
    /// The value at a time [s].
    pub fn at(&self, time_s: f64) -> f64 {
        let after = self.rows.partition_point(|row| row.0 <= time_s);
        let Some(&(t0, y0)) = after.checked_sub(1).and_then(|before| self.rows.get(before)) else {
            return self.rows.first().map_or(0.0, |row| row.1);
        };
        match self.rows.get(after) {
            Some(&(t1, y1)) => y0 + (y1 - y0) * ((time_s - t0) / (t1 - t0)),
            None => y0,
        }
    }
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
