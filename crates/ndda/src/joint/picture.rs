//! Pictures of tests of joints.

use std::path::Path;

use ndda_io::WriteError;

use super::{ClosureRow, ShearRow};
use crate::picture::write;
use crate::plot::{Line, draw};

/// Width and height [px].
const SIZE: (u32, u32) = (1160, 900);

/// Draws shear stress, normal stress and opening over the slip, to an SVG or PNG file.
///
/// # Errors
/// [`WriteError`] when it cannot be drawn or written.
pub fn draw_shear(rows: &[ShearRow], title: &str, out: &Path) -> Result<(), WriteError> {
    let line = |name: &str, value: fn(&ShearRow) -> f64| Line {
        name: name.into(),
        points: rows.iter().map(|row| (1e3 * row.slip_m, value(row))).collect(),
    };
    let stresses =
        [line("shear stress", |row| 1e-6 * row.shear_pa), line("normal stress", |row| 1e-6 * row.normal_pa)];
    let openings = [line("opening", |row| 1e3 * row.opening_m)];
    write(out, SIZE, |root| {
        let root = root.titled(title, ("sans-serif", 20))?;
        let (upper, lower) = root.split_vertically(520);
        let axis = |unit: &str| ["slip [mm]".to_string(), unit.to_string()];
        draw(&upper, &stresses, &axis("[MPa]"), false)?;
        draw(&lower, &openings, &axis("opening [mm]"), false)
    })
}

/// Draws the normal stress over the closure, to an SVG or PNG file.
///
/// # Errors
/// As [`draw_shear`].
pub fn draw_closure(rows: &[ClosureRow], title: &str, out: &Path) -> Result<(), WriteError> {
    let points = rows.iter().map(|row| (1e3 * row.closure_m, 1e-6 * row.normal_pa)).collect();
    let lines = [Line { name: "normal stress".into(), points }];
    write(out, (SIZE.0, 600), |root| {
        let root = root.titled(title, ("sans-serif", 20))?;
        draw(&root, &lines, &["closure [mm]".to_string(), "normal stress [MPa]".to_string()], false)
    })
}
