//! Records of ground motion, from CSV files and those of the PEER data base, and what a scene does with them.

mod at2;
mod error;
mod process;

use std::path::Path;

pub use error::RecordError;
pub use process::resampled;

use crate::scene::{AccelerationUnit, Baseline, Record};
use crate::{csv_text, limited};

/// Spacings that differ by less than this part are even.
const EVEN: f64 = 1e-4;

/// A peak that falls below this part of itself is lost between rows that are further apart.
const KEPT: f64 = 0.95;

/// Most rows of a record that is brought to an even spacing.
pub const MOST_ROWS: usize = 10_000_000;

/// Speed of light [m/s]: no ground moves faster, and far above it squares of speeds are no numbers any more.
const LIGHT_M_S: f64 = 299_792_458.0;

/// Time [s] and acceleration.
type Rows = Vec<(f64, f64)>;

/// Columns of a CSV file.
const TIME: &str = "time_s";
const ACCELERATION: &str = "acceleration_m_s2";

/// A record as a scene wants it.
#[derive(Clone, Debug, PartialEq)]
pub struct Prepared {
    /// Time [s] and acceleration [m/s²].
    pub rows: Vec<(f64, f64)>,
    /// What it is and what was done with it, in words.
    pub told: String,
    /// The longest gap in the file.
    pub gap: Option<Gap>,
}

/// A time without rows, far longer than others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The row before it [s].
    pub from_s: f64,
    /// Time to the next row [s].
    pub length_s: f64,
    /// Median of the spacings of rows [s].
    pub usual_s: f64,
}

/// A spacing that is so many times the median is a gap.
const GAP: f64 = 10.0;

impl Gap {
    /// The longest gap between rows, if there is any.
    fn longest_in(rows: &[(f64, f64)]) -> Option<Self> {
        let mut spacings: Vec<(f64, f64)> =
            rows.windows(2).map(|pair| (pair[1].0 - pair[0].0, pair[0].0)).collect();
        spacings.sort_by(|a, b| a.0.total_cmp(&b.0));
        let usual_s = spacings.get(spacings.len() / 2)?.0;
        let (length_s, from_s) = *spacings.last()?;
        (length_s > GAP * usual_s).then_some(Self { from_s, length_s, usual_s })
    }
}

impl Prepared {
    /// Times [s] and accelerations [m/s²] of a CSV file, as they are.
    ///
    /// # Errors
    /// [`RecordError`] naming file and row.
    pub fn as_written(file: &Path) -> Result<Self, RecordError> {
        let rows =
            csv(file, &bytes_of(file)?, ACCELERATION, "give that name to the column of accelerations")?;
        let told = format!("{}: {} rows; peak {:.4} m/s²", file.display(), rows.len(), peak_m_s2(&rows));
        Ok(Self { gap: Gap::longest_in(&rows), rows, told })
    }

    /// Holds the speed that the record times `factor` brings, acceleration being linear between rows, against that of light.
    ///
    /// # Errors
    /// [`RecordError::Speed`] of the first row that is beyond it.
    pub fn check_speed(&self, file: &Path, factor: f64) -> Result<(), RecordError> {
        check_speed(file, &self.rows, factor)
    }
}

fn check_speed(file: &Path, rows: &[(f64, f64)], factor: f64) -> Result<(), RecordError> {
    let mut speed_m_s = 0.0;
    for pair in rows.windows(2) {
        let [(from_s, a), (to_s, b)] = [pair[0], pair[1]];
        speed_m_s += factor * (0.5 * a + 0.5 * b) * (to_s - from_s);
        // NaN, of a sum of infinite ones, is beyond the limit, too.
        if speed_m_s.is_nan() || speed_m_s.abs() > LIGHT_M_S {
            return Err(RecordError::Speed { file: file.to_path_buf(), time_s: to_s });
        }
    }
    Ok(())
}

impl Record {
    /// Reads a record and does with it what the scene says; `folder` is that of the scene.
    ///
    /// # Errors
    /// [`RecordError`] naming file and row.
    pub fn prepared(&self, folder: &Path) -> Result<Prepared, RecordError> {
        let file = folder.join(&self.file);
        let (mut rows, named) = raw(&file, self.column.as_deref())?;
        let unit = self.unit.or(named).unwrap_or(AccelerationUnit::MetrePerSecondSquared);
        let factor = self.factor * unit.m_s2();
        rows.iter_mut().for_each(|row| row.1 *= factor);
        let mut told = format!("{}: {} rows to {:.6} s", file.display(), rows.len(), rows[rows.len() - 1].0);
        if self.unit.is_none() && named.is_none() {
            told += ", read in m/s², since neither the file nor the name of the column gives a unit: set `unit` to G, MetrePerSecondSquared or \
                     CentimetrePerSecondSquared (--unit g, m/s2 or cm/s2)";
        }
        if let Some(named) = named.filter(|named| *named != unit) {
            told += &format!(
                ", read in {} and not in {}, the unit that the file or its column names",
                unit.symbol(),
                named.symbol()
            );
        }
        self.processed(&file, rows, told)
    }

    /// Resamples, filters and corrects times [s] and accelerations [m/s²] of a file as the scene says; `told` says what they are.
    ///
    /// # Errors
    /// [`RecordError`] naming file and row.
    pub fn processed(
        &self,
        file: &Path,
        mut rows: Vec<(f64, f64)>,
        mut told: String,
    ) -> Result<Prepared, RecordError> {
        check_speed(file, &rows, 1.0)?;
        let gap = Gap::longest_in(&rows);
        let needed_s = self.filter_hz.and_then(|_| uneven(&rows));
        if let Some(spacing_s) = self.resample_s.or(needed_s) {
            let given = rows.len();
            let spacing = |rows| RecordError::Spacing { file: file.to_path_buf(), rows, given };
            let new = ((rows[given - 1].0 - rows[0].0) / spacing_s) as usize;
            if new > MOST_ROWS {
                return Err(spacing(new));
            }
            let given_m_s2 = peak_m_s2(&rows);
            rows = process::resampled(&rows, spacing_s);
            if rows.len() < 2 {
                return Err(spacing(rows.len()));
            }
            told += &format!(", brought to {} rows of {spacing_s} s", rows.len());
            if peak_m_s2(&rows) < KEPT * given_m_s2 {
                told += &format!(
                    ", between which the peak of {given_m_s2:.4} m/s² is lost: resample to a shorter step"
                );
            }
        }
        if let Some(corners) = self.filter_hz {
            let filter = |(slowest_hz, least_hz)| RecordError::Filter {
                file: file.to_path_buf(),
                slowest_hz,
                least_hz,
            };
            process::filtered(&mut rows, corners).map_err(filter)?;
            told += &format!(", filtered from {} to {} Hz", corners.0, corners.1);
            if corners.1 >= 0.5 / (rows[1].0 - rows[0].0) {
                told += " (the upper corner is beyond what the rows hold, and has no effect)";
            }
        }
        if self.baseline != Baseline::None {
            let (c1, c2) = process::corrected(&mut rows, self.baseline);
            told += &format!(", less a velocity of {c1:.4e} m/s² t + {c2:.4e} m/s³ t²");
        }
        told += &format!("; peak {:.4} m/s²", peak_m_s2(&rows));
        Ok(Prepared { rows, told, gap })
    }
}

/// The shortest spacing of rows [s]; none where all are even, to the digits that files have.
fn uneven(rows: &[(f64, f64)]) -> Option<f64> {
    let spacings = || rows.windows(2).map(|pair| pair[1].0 - pair[0].0);
    let (shortest_s, longest_s) = (spacings().fold(f64::INFINITY, f64::min), spacings().fold(0.0, f64::max));
    (longest_s > shortest_s * (1.0 + EVEN)).then_some(shortest_s)
}

/// Rows of a file by its ending, and the unit that it names.
fn raw(file: &Path, column: Option<&str>) -> Result<(Rows, Option<AccelerationUnit>), RecordError> {
    let bytes = bytes_of(file)?;
    if file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("at2")) {
        if column.is_some() {
            let fault = "an .at2 file has no columns: leave `column` out".to_string();
            return Err(RecordError::Table { file: file.to_path_buf(), fault });
        }
        return at2::parse(file, &String::from_utf8_lossy(&bytes));
    }
    let cure = "set `column` (--column) to the one that holds accelerations";
    let column = column.unwrap_or(ACCELERATION);
    Ok((csv(file, &bytes, column, cure)?, AccelerationUnit::named_by(column)))
}

fn bytes_of(file: &Path) -> Result<Vec<u8>, RecordError> {
    limited::file(file).map_err(|source| RecordError::Unreadable { file: file.to_path_buf(), source })
}

/// The column `time_s` and another one of a CSV file; `cure` says what to do where that other one is missing.
fn csv(file: &Path, bytes: &[u8], column: &str, cure: &str) -> Result<Vec<(f64, f64)>, RecordError> {
    let table = |fault| RecordError::Table { file: file.to_path_buf(), fault };
    let broken = |error| table(csv_text::in_words(&error));
    let mut reader = csv_text::reader(bytes);
    let header = reader.headers().map_err(&broken)?.clone();
    if let Some(fault) = csv_text::fault_of_header(&header) {
        return Err(table(fault));
    }
    if header.is_empty() {
        return Err(table(format!(
            "it is empty: name the columns `{TIME}` and `{column}` in its first line, and write a row for each time"
        )));
    }
    let place = |name: &str| {
        let known = header.iter().collect::<Vec<_>>().join(", ");
        let found = header.iter().position(|column| column == name);
        let cure = if name == TIME { csv_text::time_cure(&header, TIME) } else { format!(": {cure}") };
        found.ok_or_else(|| table(format!("there is no column `{name}`; the first line names {known}{cure}")))
    };
    let places = [place(TIME)?, place(column)?];
    let mut rows: Vec<(f64, f64)> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(broken)?;
        let line = record.position().map_or(0, csv::Position::line);
        let wrong = |reason| RecordError::Line { file: file.to_path_buf(), line, reason };
        let [time_s, acceleration] = places.map(|i| record[i].parse::<f64>());
        let (Ok(time_s), Ok(acceleration_m_s2)) = (time_s, acceleration) else {
            return Err(table(format!("line {line} has no number in column `{TIME}` or `{column}`")));
        };
        if !(time_s.is_finite() && acceleration_m_s2.is_finite()) {
            return Err(wrong("has a value that is not a number"));
        }
        match rows.last() {
            None if time_s < 0.0 => {
                return Err(wrong("is before the start of the run: begin at 0 s or later"));
            }
            Some(last) if time_s <= last.0 => {
                return Err(wrong("is not later than the line before: sort the rows by time_s"));
            }
            _ => rows.push((time_s, acceleration_m_s2)),
        }
    }
    if rows.len() < 2 {
        let has = if rows.is_empty() { "no row" } else { "one row" };
        return Err(table(format!("it has {has} of numbers: give two at least")));
    }
    Ok(rows)
}

fn peak_m_s2(rows: &[(f64, f64)]) -> f64 {
    rows.iter().map(|row| row.1.abs()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<Vec<(f64, f64)>, String> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("quake.csv");
        std::fs::write(&file, text).unwrap();
        Prepared::as_written(&file).map(|record| record.rows).map_err(|error| error.to_string())
    }

    #[test]
    fn a_record_is_read_with_comments_and_spaces() {
        let text = "# Somewhere, 1 January\ntime_s, acceleration_m_s2\n0, 0.5\n0.01, -1e-1\n";
        assert_eq!(read_text(text), Ok(vec![(0.0, 0.5), (0.01, -0.1)]));
    }

    #[test]
    fn a_column_is_read_in_the_unit_that_its_name_ends_in_unless_the_scene_gives_one() {
        let folder = tempfile::tempdir().unwrap();
        let first_m_s2 = |column: &str, more: &str| {
            std::fs::write(folder.path().join("quake.csv"), format!("time_s,{column}\n0,1\n0.01,2\n"))
                .unwrap();
            let text = format!("(file: \"quake.csv\", column: Some(\"{column}\"){more})");
            let record: Record = ron::from_str(&text).unwrap();
            record.prepared(folder.path()).unwrap().rows[0].1
        };
        for (column, one_m_s2) in
            [("a_g", 9.80665), ("ns_cm_s2", 0.01), ("EW_GAL", 0.01), ("acceleration_m_s2", 1.0), ("acc", 1.0)]
        {
            assert_eq!(first_m_s2(column, ""), one_m_s2, "{column}");
        }
        assert_eq!(first_m_s2("a_g", ", unit: Some(MetrePerSecondSquared)"), 1.0);
    }

    #[test]
    fn a_gap_between_even_rows_is_found_and_uneven_rows_are_none() {
        let even = |count: i32| (0..count).map(|i| (f64::from(i) * 0.01, 0.0));
        let rows: Vec<_> = even(10).chain([(0.5, 0.0), (0.51, 0.0)]).collect();
        let Gap { from_s, length_s, usual_s } = Gap::longest_in(&rows).unwrap();
        assert!(
            (from_s - 0.09).abs() < 1e-12
                && (length_s - 0.41).abs() < 1e-12
                && (usual_s - 0.01).abs() < 1e-12
        );
        assert_eq!(Gap::longest_in(&[(0.0, 0.0), (1.0, 1.0), (4.0, 0.0), (4.5, 1.0)]), None);
        assert_eq!(Gap::longest_in(&even(10).collect::<Vec<_>>()), None);
        assert_eq!(Gap::longest_in(&[(0.0, 1.0)]), None);
    }

    #[test]
    fn what_is_no_record_is_refused_with_its_line() {
        for (text, word) in [
            ("time_s,acceleration_m_s2\n0,1\n0,2\n", "line 3 is not later"),
            ("# from a logger\ntime_s,acceleration_m_s2\n-1,1\n0,2\n", "line 3 is before"),
            ("time_ms,acceleration_m_s2\n0,1\n10,2\n", "give times in seconds in a column `time_s`"),
            ("time_s,acceleration_m_s2\n0,1\n", "one row of numbers"),
            ("", "is empty"),
            ("time_s,acceleration_m_s2\n0,NaN\n1,1\n", "line 2 has a value"),
            ("time_s,acceleration_m_s2\n0,x\n", "line"),
            ("t,a\n0,1\n1,1\n", "time_s"),
        ] {
            let message = read_text(text).unwrap_err();
            assert!(message.contains(word), "{text:?}: {message}");
        }
        assert!(Prepared::as_written(Path::new("no/such.csv")).is_err());
    }

    #[test]
    fn a_record_that_no_ground_can_follow_is_refused_with_its_time() {
        let check = |rows: &[(f64, f64)], factor| {
            check_speed(Path::new("quake.csv"), rows, factor).map_err(|error| error.to_string())
        };
        assert_eq!(check(&[(0.0, 9.8), (1.0, -9.8), (2.0, 3.0)], 1.0), Ok(()));
        for (rows, factor) in [
            ([(0.0, 0.0), (0.01, 1.0), (0.02, 1e308)], 1.0),
            ([(0.0, 0.0), (0.01, 1.0), (0.02, -1e200)], 1.0),
            ([(0.0, 0.0), (0.01, 0.0), (0.02, 1.0)], 1e300),
            ([(0.0, 0.0), (0.01, 0.0), (0.02, 1e308)], 1e308),
        ] {
            let message = check(&rows, factor).unwrap_err();
            assert!(message.contains("quake.csv: the ground would move faster than light from"), "{message}");
        }
    }
}
