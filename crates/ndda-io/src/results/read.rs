//! Reads the results of a run: history, fields, forces of bolts.

mod bolts;
mod fields;

use std::path::{Path, PathBuf};

use crate::results::folder::OutputFolder;

pub use crate::mesh::vtk_file::Array;
pub use crate::results::table::Table;
pub use bolts::BoltForces;
pub use fields::{FieldFrame, ListedFrame};

impl OutputFolder {
    /// The history in the output folder of a run: as text, or else in columns.
    pub fn history_in(folder: &Path) -> Option<PathBuf> {
        [OutputFolder::HISTORY, OutputFolder::PARQUET[0]]
            .map(|name| folder.join(name))
            .into_iter()
            .find(|file| file.is_file())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::History;

    #[test]
    fn a_history_is_read_back_bit_by_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        let names = ["time_s".to_string(), "a, b".to_string()];
        let mut written = History::create(&path, &names).unwrap();
        let rows = [[0.0, 1.0 / 3.0], [0.1 + 0.2, -5e-324]];
        rows.iter().for_each(|row| written.push(row).unwrap());
        written.finish().unwrap();
        let table = Table::read(&path).unwrap();
        assert_eq!(table.names, names);
        assert_eq!(table.columns, [[rows[0][0], rows[1][0]], [rows[0][1], rows[1][1]]]);
    }

    #[test]
    fn a_damaged_row_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("history.csv");
        for (bad, place) in [("0.0,1.0\n0.1,x\n", "row 2"), ("0.0,1.0\n0.1\n", "line 3 has 1 value")] {
            std::fs::write(&path, format!("time_s,a\n{bad}")).unwrap();
            let error = Table::read(&path).unwrap_err().to_string();
            assert!(error.contains(place), "{error}");
        }
        assert!(Table::read(&folder.path().join("none.csv")).is_err());
    }
}
