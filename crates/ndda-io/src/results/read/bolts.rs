//! The largest tension of each bolt over time, from `bolts.csv`.

use std::path::Path;

use crate::results::table::TableError;

/// The largest tensions of bolts, frame by frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoltForces {
    /// Times of the frames \[s\].
    pub times_s: Vec<f64>,
    /// Name of each bolt, and the largest tension of its pieces in each frame \[N\], the sign kept; not a number where it is not there.
    pub bolts: Vec<(String, Vec<f64>)>,
}

impl BoltForces {
    /// Reads `bolts.csv`.
    ///
    /// # Errors
    /// [`TableError`] when it cannot be read, lacks a column, or has a cell that is no number.
    pub fn read(path: &Path) -> Result<Self, TableError> {
        read(path).map_err(|reason| TableError::Unreadable { file: path.to_path_buf(), reason })
    }
}

/// A table has more bolts than this only where it is damaged.
const MOST_BOLTS: f64 = 1e7;

fn read(path: &Path) -> Result<BoltForces, String> {
    let in_words = |error: csv::Error| crate::csv_text::in_words(&error);
    let mut reader = csv::Reader::from_path(path).map_err(in_words)?;
    let header = reader.headers().map_err(in_words)?.clone();
    let column = |name: &str| {
        let found = header.iter().position(|column| column == name);
        found.ok_or_else(|| format!("it has no column `{name}`"))
    };
    let columns = [column("time_s")?, column("bolt")?, column("piece")?, column("axial_n")?];
    let name = column("name")?;
    let mut forces = BoltForces::default();
    let mut last = None;
    for (row, record) in reader.records().enumerate() {
        let record = record.map_err(in_words)?;
        let mut numbers = [0.0; 4];
        for (number, column) in numbers.iter_mut().zip(columns) {
            let cell = &record[column];
            let no_number =
                || format!("row {}: `{cell}` in column `{}` is not a number", row + 1, &header[column]);
            *number = cell.parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(no_number)?;
        }
        let [time_s, bolt, piece, axial_n] = numbers;
        if !(0.0..MOST_BOLTS).contains(&bolt) {
            return Err(format!("row {}: there is no bolt {bolt}", row + 1));
        }
        // Frames follow each other, also those of the same time.
        if last.is_none_or(|(before_s, at)| before_s != time_s || at >= (bolt, piece)) {
            forces.times_s.push(time_s);
        }
        last = Some((time_s, (bolt, piece)));
        forces.take(bolt as usize, &record[name], axial_n);
    }
    let frames = forces.times_s.len();
    forces.bolts.iter_mut().for_each(|(_, curve)| curve.resize(frames, f64::NAN));
    Ok(forces)
}

impl BoltForces {
    /// Takes in the tension of a piece in the last frame so far.
    fn take(&mut self, bolt: usize, name: &str, axial_n: f64) {
        if self.bolts.len() <= bolt {
            self.bolts.resize(bolt + 1, (String::new(), Vec::new()));
        }
        let (known, curve) = &mut self.bolts[bolt];
        if known.is_empty() {
            known.push_str(name);
        }
        curve.resize(self.times_s.len(), f64::NAN);
        if let Some(largest) =
            curve.last_mut().filter(|largest| largest.is_nan() || largest.abs() < axial_n.abs())
        {
            *largest = axial_n;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<BoltForces, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bolts.csv");
        std::fs::write(&path, text).unwrap();
        BoltForces::read(&path).map_err(|error| error.to_string())
    }

    #[test]
    fn the_largest_tension_of_each_bolt_is_found_frame_by_frame() {
        let forces = of("time_s,bolt,piece,axial_n,name\n\
             0,0,0,1,a\n0,0,1,-3,a\n\
             0.5,0,0,2,a\n0.5,1,0,5,\"b, c\"\n\
             0.5,0,0,4,a\n0.5,0,1,1,a\n0.5,1,0,-6,\"b, c\"\n")
        .unwrap();
        assert_eq!(forces.times_s, [0.0, 0.5, 0.5]);
        assert_eq!(forces.bolts[0], ("a".to_string(), vec![-3.0, 2.0, 4.0]));
        let (name, curve) = &forces.bolts[1];
        assert!(name == "b, c" && curve[0].is_nan() && curve[1..] == [5.0, -6.0]);
        assert_eq!(of("time_s,bolt,piece,axial_n,name\n").unwrap(), BoltForces::default());
    }

    #[test]
    fn damaged_tables_are_errors_with_file_and_place() {
        let header = "time_s,bolt,piece,axial_n,name\n";
        for (text, told) in [
            ("time_s,bolt\n".to_string(), "no column `piece`"),
            (format!("{header}0,0,0,x,a\n"), "row 1: `x` in column `axial_n`"),
            (format!("{header}0,0,0,1,a\n0,-1,0,1,a\n"), "row 2: there is no bolt -1"),
            (format!("{header}0,1e300,0,1,a\n"), "there is no bolt"),
            (format!("{header}0,0\n"), "line 2 has 2 values"),
        ] {
            let error = of(&text).unwrap_err();
            assert!(error.contains("bolts.csv") && error.contains(told), "{error}");
        }
    }
}
