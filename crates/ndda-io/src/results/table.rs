//! Reading a history back: named columns of numbers.

#[cfg(feature = "parquet")]
pub(crate) mod parquet;

use std::path::{Path, PathBuf};

/// A table of numbers by column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Their values, one list per name.
    pub columns: Vec<Vec<f64>>,
}

/// Why a table cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// It cannot be read.
    #[error("cannot read {}: {reason}", file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// The problem.
        reason: String,
    },
    /// A value is not a number.
    #[error("{}, row {row}: `{value}` in column `{column}` is not a number", file.display())]
    NotANumber {
        /// The file.
        file: PathBuf,
        /// Row of data, the first being 1.
        row: usize,
        /// The column.
        column: String,
        /// The cell's text.
        value: String,
    },
}

impl Table {
    /// The values of the column called `name`.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let index = self.names.iter().position(|known| known == name)?;
        Some(&self.columns[index])
    }

    /// The same where it is probably the column of a number, as in another table of the same kind: thousands are then found without a search.
    pub fn column_near(&self, number: usize, name: &str) -> Option<&[f64]> {
        match self.names.get(number) {
            Some(known) if known == name => Some(&self.columns[number]),
            _ => self.column(name),
        }
    }
}

impl Table {
    /// Reads a table such as `history.csv` or `history.parquet`.
    ///
    /// # Errors
    /// [`TableError`] naming the file, and row and column of a value that is not a number.
    pub fn read(file: &Path) -> Result<Self, TableError> {
        if file.extension().is_some_and(|ending| ending == "parquet") {
            return columns(file);
        }
        let broken = |error: csv::Error| TableError::Unreadable {
            file: file.to_path_buf(),
            reason: crate::csv_text::in_words(&error),
        };
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(file).map_err(broken)?;
        let names: Vec<String> = reader.headers().map_err(broken)?.iter().map(String::from).collect();
        let mut columns = vec![Vec::new(); names.len()];
        for (row, record) in reader.records().enumerate() {
            let record = record.map_err(broken)?;
            for ((value, column), name) in record.iter().zip(&mut columns).zip(&names) {
                let number = value.parse().map_err(|_| TableError::NotANumber {
                    file: file.to_path_buf(),
                    row: row + 1,
                    column: name.clone(),
                    value: value.to_string(),
                })?;
                column.push(number);
            }
        }
        Ok(Self { names, columns })
    }
}

#[cfg(feature = "parquet")]
fn columns(file: &Path) -> Result<Table, TableError> {
    parquet::read(file)
}

#[cfg(not(feature = "parquet"))]
fn columns(file: &Path) -> Result<Table, TableError> {
    let reason = "this program was built without Parquet: build it with `--features parquet`".into();
    Err(TableError::Unreadable { file: file.to_path_buf(), reason })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<Table, String> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("history.csv");
        std::fs::write(&file, text).unwrap();
        Table::read(&file).map_err(|error| error.to_string())
    }

    #[test]
    fn columns_are_found_by_name() {
        let table = read_text("time_s,kinetic_j\n0,1\n0.5,2e3\n").unwrap();
        assert_eq!(table.column("kinetic_j"), Some(&[1.0, 2e3][..]));
        assert_eq!(table.column("strain_j"), None);
        for number in [0, 1, 7] {
            assert_eq!(table.column_near(number, "kinetic_j"), table.column("kinetic_j"));
        }
    }

    #[test]
    fn what_is_no_table_is_refused_with_its_place() {
        assert!(read_text("a,b\n1,2\n3,x\n").unwrap_err().contains("row 2: `x` in column `b`"));
        assert!(read_text("a,b\n1,2\n3\n").unwrap_err().contains("line"));
        assert!(Table::read(Path::new("no/such.csv")).is_err());
    }
}
