//! Prescribed motions over time.

use ndda_mesh::Vec3;

use crate::table::interpolated;

/// A displacement over time.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// Time [s], ascending, and displacement [m]: linear between rows, constant before the first and after the last.
    Rows(Vec<(f64, Vec3)>),
    /// A record of accelerations, integrated to velocity and displacement.
    Record(Record),
    /// Several at once, which add up.
    Sum(Vec<Motion>),
}

impl Motion {
    /// Displacement at a time [m].
    pub fn displacement(&self, time_s: f64) -> Vec3 {
        match self {
            Self::Rows(rows) => interpolated(rows, time_s).unwrap_or_else(Vec3::zeros),
            Self::Record(record) => record.displacement(time_s),
            Self::Sum(parts) => parts.iter().map(|part| part.displacement(time_s)).sum(),
        }
    }

    /// Velocity just after a time [m/s].
    pub fn velocity(&self, time_s: f64) -> Vec3 {
        match self {
            Self::Rows(rows) => {
                let next = rows.partition_point(|row| row.0 <= time_s);
                match (next.checked_sub(1).and_then(|i| rows.get(i)), rows.get(next)) {
                    (Some(&(t0, u0)), Some(&(t1, u1))) => (u1 - u0) / (t1 - t0),
                    _ => Vec3::zeros(),
                }
            }
            Self::Record(record) => record.velocity(time_s),
            Self::Sum(parts) => parts.iter().map(|part| part.velocity(time_s)).sum(),
        }
    }

    /// Largest distance of a velocity of a row between two times from all those on the straight way between the velocities at both ends [m/s]: what comes and
    /// goes in between.
    pub fn unresolved_m_s(&self, from_s: f64, to_s: f64) -> f64 {
        match self {
            Self::Rows(rows) => {
                let inside = within(rows, |row| row.0, from_s, to_s);
                let Some(last) = inside.last() else { return 0.0 };
                self.farthest_velocity(from_s, last.0, inside.iter().map(|row| row.0))
            }
            Self::Record(record) => {
                let inside = within(&record.rows, |row| row[0], from_s, to_s);
                self.farthest_velocity(from_s, to_s, inside.iter().map(|row| row[0]))
            }
            Self::Sum(parts) => parts.iter().map(|part| part.unresolved_m_s(from_s, to_s)).sum(),
        }
    }

    /// Largest distance of the velocities at some times from the straight way between the velocities at two times [m/s].
    fn farthest_velocity(&self, from_s: f64, to_s: f64, times_s: impl Iterator<Item = f64>) -> f64 {
        let (start, end) = (self.velocity(from_s), self.velocity(to_s));
        let way = end - start;
        let off = |v: Vec3| {
            let along = way.dot(&(v - start)) / way.norm_squared().max(f64::MIN_POSITIVE);
            (v - start - along.clamp(0.0, 1.0) * way).norm()
        };
        times_s.fold(0.0, |most, time_s| most.max(off(self.velocity(time_s))))
    }

    /// Accelerations of all its records together at each of their rows [m/s²]; rows of displacements have none.
    pub fn accelerations(&self) -> Vec<Vec3> {
        let records = self.records();
        let mut times_s: Vec<f64> =
            records.iter().flat_map(|record| record.rows.iter().map(|row| row[0])).collect();
        times_s.sort_by(f64::total_cmp);
        times_s.dedup();
        times_s.iter().map(|time_s| records.iter().map(|record| record.acceleration(*time_s)).sum()).collect()
    }

    /// Its records, those within sums included.
    fn records(&self) -> Vec<&Record> {
        match self {
            Self::Rows(_) => Vec::new(),
            Self::Record(record) => vec![record],
            Self::Sum(parts) => parts.iter().flat_map(Self::records).collect(),
        }
    }

    /// Times of the first and the last row [s], and how many rows there are; none without rows.
    pub fn extent(&self) -> Option<(f64, f64, usize)> {
        let of = |first: Option<f64>, last: Option<f64>, rows| Some((first?, last?, rows));
        match self {
            Self::Rows(rows) => of(rows.first().map(|row| row.0), rows.last().map(|row| row.0), rows.len()),
            Self::Record(Record { rows, .. }) => {
                of(rows.first().map(|row| row[0]), rows.last().map(|row| row[0]), rows.len())
            }
            Self::Sum(parts) => {
                parts.iter().filter_map(Self::extent).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1), a.2 + b.2))
            }
        }
    }

    /// Whether anything ever moves, or moves along a direction.
    pub fn moves(&self, along: Option<&Vec3>) -> bool {
        let part = |v: &Vec3| along.map_or(v.norm(), |n| v.dot(n).abs()) > 0.0;
        match self {
            Self::Rows(rows) => rows.iter().any(|row| part(&row.1)),
            Self::Record(record) => part(&record.direction),
            Self::Sum(parts) => parts.iter().any(|part| part.moves(along)),
        }
    }
}

/// The rows between two times, which are ascending.
fn within<T>(rows: &[T], time_s: impl Fn(&T) -> f64, from_s: f64, to_s: f64) -> &[T] {
    let first = rows.partition_point(|row| time_s(row) <= from_s);
    let end = rows.partition_point(|row| time_s(row) < to_s);
    &rows[first..end.max(first)]
}

/// A motion along one direction whose acceleration is linear between the rows of a record and zero outside of it.
///
/// Integrated exactly from rest: velocity is quadratic, displacement cubic between rows. After the record it goes on at
/// the velocity that the record ends with.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Displacement per metre of the record.
    pub direction: Vec3,
    /// Time [s], acceleration [m/s²], velocity [m/s], displacement [m].
    rows: Vec<[f64; 4]>,
}

impl Record {
    /// From times [s], ascending, and accelerations along `direction` [m/s²].
    pub fn new(direction: Vec3, accelerations: &[(f64, f64)]) -> Self {
        let mut rows: Vec<[f64; 4]> = Vec::with_capacity(accelerations.len());
        for &(t, a) in accelerations {
            let (v, u) = match rows.last() {
                None => (0.0, 0.0),
                Some(&row) => after(&row, a, t - row[0], t - row[0]),
            };
            rows.push([t, a, v, u]);
        }
        Self { direction, rows }
    }

    /// Displacement at a time [m].
    pub fn displacement(&self, time_s: f64) -> Vec3 {
        self.along(time_s).1 * self.direction
    }

    /// Velocity at a time [m/s].
    pub fn velocity(&self, time_s: f64) -> Vec3 {
        self.along(time_s).0 * self.direction
    }

    /// Acceleration at a time [m/s²].
    fn acceleration(&self, time_s: f64) -> Vec3 {
        let next = self.rows.partition_point(|row| row[0] < time_s);
        let along = match (next.checked_sub(1).and_then(|i| self.rows.get(i)), self.rows.get(next)) {
            (_, Some(row)) if row[0] == time_s => row[1],
            (Some(last), Some(row)) => last[1] + (row[1] - last[1]) * (time_s - last[0]) / (row[0] - last[0]),
            _ => 0.0,
        };
        along * self.direction
    }

    /// Velocity and displacement along the direction.
    fn along(&self, time_s: f64) -> (f64, f64) {
        let next = self.rows.partition_point(|row| row[0] <= time_s);
        let Some(&row) = next.checked_sub(1).and_then(|i| self.rows.get(i)) else { return (0.0, 0.0) };
        let tau = time_s - row[0];
        match self.rows.get(next) {
            Some(&[t, a, ..]) => after(&row, a, t - row[0], tau),
            None => (row[2], row[3] + row[2] * tau),
        }
    }
}

/// Velocity and displacement τ after a row, the acceleration going to `a` over h:
/// v + a₀ τ + (a − a₀) τ²/2h and u + v τ + a₀ τ²/2 + (a − a₀) τ³/6h.
fn after(&[_, a0, v, u]: &[f64; 4], a: f64, h: f64, tau: f64) -> (f64, f64) {
    let jerk = (a - a0) / h;
    let velocity = v + tau * (a0 + 0.5 * tau * jerk);
    (velocity, u + tau * (v + tau * (0.5 * a0 + tau * jerk / 6.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_linear_between_and_constant_outside() {
        let motion = Motion::Rows(vec![(1.0, Vec3::zeros()), (3.0, Vec3::x())]);
        assert_eq!(motion.displacement(0.0), Vec3::zeros());
        assert_eq!(motion.displacement(2.0), 0.5 * Vec3::x());
        assert_eq!(motion.displacement(9.0), Vec3::x());
    }

    #[test]
    fn a_velocity_that_comes_and_goes_between_two_times_is_found() {
        let rows = vec![(1.0, Vec3::zeros()), (2.0, Vec3::x()), (3.0, Vec3::zeros()), (9.0, Vec3::zeros())];
        let there_and_back = Motion::Rows(rows);
        assert_eq!(there_and_back.unresolved_m_s(0.5, 4.0), 1.0);
        // A start, a turn and a stop are seen from both ends.
        for (from, to) in [(0.5, 1.5), (1.5, 2.5), (2.5, 4.0), (4.0, 99.0)] {
            assert_eq!(there_and_back.unresolved_m_s(from, to), 0.0, "{from} to {to}");
        }
        // Up to 1 m/s in a second, and down again in another.
        let rows = [(0.0, 1.0), (1.0, 1.0), (1.0 + 1e-9, -1.0), (2.0, -1.0)];
        let record = Motion::Record(Record::new(Vec3::y(), &rows));
        assert!((record.unresolved_m_s(-1.0, 2.0) - 1.0).abs() < 1e-8);
        assert!(record.unresolved_m_s(0.2, 0.9) < 1e-15);
    }

    #[test]
    fn accelerations_of_records_add_up_at_the_rows_of_each() {
        let one = Record::new(Vec3::x(), &[(0.0, 1.0), (1.0, 3.0)]);
        let other = Record::new(2.0 * Vec3::z(), &[(0.5, 5.0), (2.0, 8.0)]);
        let both = Motion::Sum(vec![Motion::Record(one), Motion::Sum(vec![Motion::Record(other)])]);
        let at_rows = [(1.0, 0.0), (2.0, 10.0), (3.0, 12.0), (0.0, 16.0)].map(|(x, z)| Vec3::new(x, 0.0, z));
        assert_eq!(both.accelerations(), at_rows);
        assert!(Motion::Rows(vec![(0.0, Vec3::x())]).accelerations().is_empty());
    }

    #[test]
    fn a_linear_acceleration_gives_a_cubic_and_the_record_is_left_at_its_last_velocity() {
        // a = 6 t: v = 3 t², u = t³.
        let record = Record::new(Vec3::z(), &[(0.0, 0.0), (0.3, 1.8), (1.0, 6.0)]);
        for t in [0.0f64, 0.1, 0.3, 0.7, 1.0] {
            assert!((record.displacement(t).z - t.powi(3)).abs() < 1e-15, "{t}");
        }
        assert!((record.displacement(2.0).z - (1.0 + 3.0)).abs() < 1e-15);
        assert_eq!(record.displacement(-1.0), Vec3::zeros());
    }
}
