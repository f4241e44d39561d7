//! Files of a test of a joint.

use std::path::Path;

use ndda_io::{WriteError, atomic};

use super::report::{Rows, closure_csv, shear_csv};

/// Writes all rows as `joint.csv`, the test as `joint.json`, and the pictures, to a folder that is created.
///
/// # Errors
/// [`WriteError`] when one of them cannot be written.
pub fn write(folder: &Path, rows: &Rows, title: &str, json: &str) -> Result<(), WriteError> {
    std::fs::create_dir_all(folder).map_err(WriteError::io("create", folder))?;
    let table = match rows {
        Rows::Shear(rows) => shear_csv(rows),
        Rows::Closure(rows) => closure_csv(rows),
    };
    atomic::write(&folder.join("joint.csv"), table.as_bytes())?;
    atomic::write(&folder.join("joint.json"), json.as_bytes())?;
    draw(folder, rows, title)
}

#[cfg(feature = "plots")]
fn draw(folder: &Path, rows: &Rows, title: &str) -> Result<(), WriteError> {
    crate::picture::ENDINGS.iter().try_for_each(|ending| {
        let file = folder.join(format!("joint.{ending}"));
        match rows {
            Rows::Shear(rows) => super::picture::draw_shear(rows, title, &file),
            Rows::Closure(rows) => super::picture::draw_closure(rows, title, &file),
        }
    })
}

#[cfg(not(feature = "plots"))]
fn draw(_: &Path, _: &Rows, _: &str) -> Result<(), WriteError> {
    Ok(())
}
