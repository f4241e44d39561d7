//! Tables in columns: what grew as CSV becomes Parquet at the end of a run.
//!
//! A Parquet file can only be read once its last bytes are there; so a run grows text, which survives a crash and can be
//! gone on with.

use std::fs;

use crate::results::folder::OutputFolder;
#[cfg(feature = "parquet")]
use crate::results::table::Table;
use crate::scene::{Output, TableFormat};
use crate::write_error::WriteError;

/// Whether this build writes Parquet.
pub(crate) const HAS_PARQUET: bool = cfg!(feature = "parquet");

impl OutputFolder {
    /// Writes the tables of a run that has ended as Parquet, where the scene requests that.
    ///
    /// # Errors
    /// [`WriteError`] when a table cannot be read or a file not be written.
    #[cfg(feature = "parquet")]
    pub fn write_parquet(&self, output: &Output) -> Result<(), WriteError> {
        if !output.history.has_parquet() {
            return Ok(());
        }
        let contacts = output.contacts.then(|| self.contacts());
        let tables = [Some(self.history()), contacts, output.blocks.then(|| self.blocks())];
        for (csv, name) in tables.into_iter().zip(Self::PARQUET) {
            if let Some(csv) = csv {
                crate::results::table::parquet::from_csv(&csv, &self.path().join(name))?;
            }
        }
        Ok(())
    }

    /// Removes the text of tables that are wanted as Parquet only; after the summary, as a run that lacks it is resumed.
    ///
    /// # Errors
    /// [`WriteError::Io`] when a file cannot be removed.
    pub fn remove_csv(&self, output: &Output) -> Result<(), WriteError> {
        if output.history != TableFormat::Parquet {
            return Ok(());
        }
        let tables =
            [(self.history(), true), (self.contacts(), output.contacts), (self.blocks(), output.blocks)];
        for (path, is_there) in tables {
            if is_there {
                fs::remove_file(&path).map_err(WriteError::io("remove", &path))?;
            }
        }
        Ok(())
    }
}

#[cfg(feature = "parquet")]
impl Table {
    /// Copies a table of numbers with a header, a CSV file, as Parquet.
    ///
    /// # Errors
    /// [`WriteError`] when the table cannot be read or the file not be written.
    pub fn copy_as_parquet(csv: &std::path::Path, parquet: &std::path::Path) -> Result<(), WriteError> {
        crate::results::table::parquet::from_csv(csv, parquet)
    }
}
