//! Tables of measured or generated joints as CSV: orientations, and discs of a discrete fracture network.
//!
//! The first line names the columns, in any order; `set` may be left out, other columns are not read, and lines that begin with `#` are
//! comments.

use std::path::{Path, PathBuf};

use crate::{csv_text, limited};

/// Why a table of joints cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum JointTableError {
    /// The file cannot be read, or is no table.
    #[error("{}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The problem.
        reason: String,
    },
    /// A column is missing.
    #[error("{}: there is no column {column}; the first line names the columns, {columns} (set may be left out)", path.display())]
    NoColumn {
        /// The file.
        path: PathBuf,
        /// The column.
        column: &'static str,
        /// All columns.
        columns: &'static str,
    },
    /// A value out of its range.
    #[error("{}, line {line}, column {place}: {column} is `{value}`: write {advice}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// Line of the file, the first being 1.
        line: u64,
        /// Column of the table, the first being 1.
        place: usize,
        /// Its name.
        column: &'static str,
        /// The cell's text.
        value: String,
        /// The range that is allowed.
        advice: &'static str,
    },
    /// Several lines that cannot be used.
    #[error("{}", in_lines(.0))]
    Several(Vec<JointTableError>),
    /// There is no joint.
    #[error("{} has no joints: write a line for each below the names of the columns", .0.display())]
    Empty(PathBuf),
}

fn in_lines(errors: &[JointTableError]) -> String {
    errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// A plane of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneRow {
    /// Dip, 0 to 90 [°].
    pub dip_deg: f64,
    /// Dip direction [°].
    pub dip_direction_deg: f64,
    /// Its set, if the table names one.
    pub set: Option<String>,
}

/// A disc of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscRow {
    /// Its plane.
    pub plane: PlaneRow,
    /// Centre [m].
    pub center_m: [f64; 3],
    /// Radius [m].
    pub radius_m: f64,
}

/// Columns of planes.
const OF_PLANES: &str = "dip_deg,dip_direction_deg,set";
/// Columns of discs.
const OF_DISCS: &str = "dip_deg,dip_direction_deg,x_m,y_m,z_m,radius_m,set";
/// Most lines whose mistakes are told at once.
const MOST_TOLD: usize = 20;
/// Numbers beyond it have products that overflow.
const HUGE: f64 = 1e50;

impl PlaneRow {
    /// Reads planes.
    ///
    /// # Errors
    /// [`JointTableError`] with the place of what cannot be used.
    pub fn read_all(path: &Path) -> Result<Vec<Self>, JointTableError> {
        read(path, OF_PLANES, |_| Ok(()), |plane, ()| plane)
    }
}

impl DiscRow {
    /// Reads discs, in the order of the file.
    ///
    /// # Errors
    /// [`JointTableError`] with the place of what cannot be used.
    pub fn read_all(path: &Path) -> Result<Vec<Self>, JointTableError> {
        let advice = "a coordinate in metres, from -1e50 to 1e50";
        let places = |row: &Row| {
            let at = |column| row.number(column, [-HUGE, HUGE], advice);
            let radius_m =
                row.number("radius_m", [1.0 / HUGE, HUGE], "a length in metres, above 0 and at most 1e50")?;
            Ok(([at("x_m")?, at("y_m")?, at("z_m")?], radius_m))
        };
        read(path, OF_DISCS, places, |plane, (center_m, radius_m)| Self { plane, center_m, radius_m })
    }
}

/// A line of a table.
struct Row<'a> {
    path: &'a Path,
    header: &'a csv::StringRecord,
    cells: csv::StringRecord,
    columns: &'static str,
}

impl Row<'_> {
    fn place(&self, column: &'static str) -> Result<usize, JointTableError> {
        let missing =
            || JointTableError::NoColumn { path: self.path.to_path_buf(), column, columns: self.columns };
        position(self.header, column).ok_or_else(missing)
    }

    fn number(
        &self,
        column: &'static str,
        [least, most]: [f64; 2],
        advice: &'static str,
    ) -> Result<f64, JointTableError> {
        let place = self.place(column)?;
        let value = self.cells.get(place).unwrap_or("");
        let number = value.parse().ok().filter(|number: &f64| (least..=most).contains(number));
        number.ok_or_else(|| JointTableError::Value {
            path: self.path.to_path_buf(),
            line: self.cells.position().map_or(0, csv::Position::line),
            place: place + 1,
            column,
            value: value.into(),
            advice,
        })
    }

    fn plane(&self) -> Result<PlaneRow, JointTableError> {
        let set = position(self.header, "set").and_then(|place| self.cells.get(place));
        Ok(PlaneRow {
            dip_deg: self.number("dip_deg", [0.0, 90.0], "an angle from 0 to 90")?,
            dip_direction_deg: self.number(
                "dip_direction_deg",
                [-360.0, 360.0],
                "an angle from -360 to 360",
            )?,
            set: set.filter(|set| !set.is_empty()).map(String::from),
        })
    }
}

fn position(header: &csv::StringRecord, column: &str) -> Option<usize> {
    header.iter().position(|known| known == column)
}

/// A column that is left out by a slip of its name would be taken for one that is not read.
fn misspelt_set(header: &csv::StringRecord) -> Option<String> {
    let meant = |name: &&str| {
        *name != "set" && ["set", "sets", "joint_set", "jointset"].contains(&name.to_lowercase().as_str())
    };
    let name = header.iter().find(meant).filter(|_| position(header, "set").is_none())?;
    Some(format!("its first line names the column `{name}`: write `set` for the names of joint sets"))
}

fn read<P, T>(
    path: &Path,
    columns: &'static str,
    more: impl Fn(&Row) -> Result<P, JointTableError>,
    row: impl Fn(PlaneRow, P) -> T,
) -> Result<Vec<T>, JointTableError> {
    let unreadable = |reason: String| JointTableError::Unreadable { path: path.to_path_buf(), reason };
    let bytes = limited::file(path).map_err(|error| unreadable(error.to_string()))?;
    let mut reader = csv_text::reader(&bytes);
    let words = |error: csv::Error| unreadable(csv_text::in_words(&error));
    let header = reader.headers().map_err(words)?.clone();
    if let Some(fault) = csv_text::fault_of_header(&header).or_else(|| misspelt_set(&header)) {
        return Err(unreadable(fault));
    }
    // A table without lines below its header is told which column it lacks, too.
    for column in columns.split(',').filter(|column| *column != "set") {
        if position(&header, column).is_none() {
            return Err(JointTableError::NoColumn { path: path.to_path_buf(), column, columns });
        }
    }
    let (mut rows, mut wrong) = (Vec::new(), Vec::new());
    for cells in reader.into_records() {
        let of_line = |cells| {
            let line = Row { path, header: &header, cells, columns };
            Ok(row(line.plane()?, more(&line)?))
        };
        match cells.map_err(words).and_then(of_line) {
            Ok(row) => rows.push(row),
            Err(error) if wrong.len() < MOST_TOLD => wrong.push(error),
            Err(_) => break,
        }
    }
    match wrong.len() {
        0 if rows.is_empty() => Err(JointTableError::Empty(path.to_path_buf())),
        0 => Ok(rows),
        1 => Err(wrong.remove(0)),
        _ => Err(JointTableError::Several(wrong)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<Vec<DiscRow>, String> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("joints.csv");
        std::fs::write(&file, text).unwrap();
        DiscRow::read_all(&file).map_err(|error| error.to_string())
    }

    #[test]
    fn discs_are_read_in_any_order_of_columns() {
        let text = "# a model\nradius_m,set,z_m,y_m,x_m,remark,dip_direction_deg,dip_deg\n2.5, J1 ,3,2,1,x,130,40\n1,,0,0,0,,5,6\n";
        let rows = of(text).unwrap();
        let plane = PlaneRow { dip_deg: 40.0, dip_direction_deg: 130.0, set: Some("J1".into()) };
        assert_eq!(rows[0], DiscRow { plane, center_m: [1.0, 2.0, 3.0], radius_m: 2.5 });
        assert_eq!(rows[1].plane.set, None);
    }

    #[test]
    fn what_is_wrong_is_said_with_file_line_and_column() {
        let header = "dip_deg,dip_direction_deg,x_m,y_m,z_m,radius_m";
        for (lines, words) in [
            (
                "40,130,0,0,0,1\n40,130,0,0,0,0\n",
                "joints.csv, line 3, column 6: radius_m is `0`: write a length",
            ),
            ("40,130,0,east,0,1\n", "joints.csv, line 2, column 4: y_m is `east`: write a coordinate"),
            ("91,130,0,0,0,1\n", "joints.csv, line 2, column 1: dip_deg is `91`"),
            ("40,nan,0,0,0,1\n", "joints.csv, line 2, column 2: dip_direction_deg is `nan`"),
            ("40,130,0,0,inf,1\n", "joints.csv, line 2, column 5: z_m is `inf`"),
            ("40,130\n", "joints.csv: line 2 has 2 values, and the first line names 6 columns"),
            ("", "has no joints"),
        ] {
            let said = of(&format!("{header}\n{lines}")).unwrap_err();
            assert!(said.contains(words), "{said}");
        }
        let both =
            of(&format!("{header}\n91,130,0,0,0,1\n40,130,0,0,0,1\n40,130\n40,130,0,0,0,x\n")).unwrap_err();
        assert!(
            ["line 2, column 1", "line 4 has 2 values", "line 5, column 6"].iter().all(|w| both.contains(w)),
            "{both}"
        );
        assert!(of("dip_deg,dip_direction_deg\n40,130\n").unwrap_err().contains("no column x_m"));
        assert!(of("").unwrap_err().contains("no column dip_deg"));
        assert!(of("dip_deg,dip_direction_deg,Set\n40,130,a\n").unwrap_err().contains("write `set`"));
    }
}
