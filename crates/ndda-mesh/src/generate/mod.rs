//! Structured generators: boxes, triangular prisms, hexahedra, voussoirs, cylinders and spheres.

use std::ops::RangeInclusive;

mod box_block;
mod mapped;
mod prism;
mod round;
#[cfg(test)]
mod testing;

pub use box_block::{BoxPattern, box_block};
pub use mapped::{Voussoir, hexahedron, voussoir};
pub use prism::prism;
pub use round::{cylinder, sphere};

use crate::validate::MAX_TETS;

/// Lengths whose products, in any number of cells, neither overflow nor underflow.
const LENGTHS_M: RangeInclusive<f64> = 1e-50..=1e50;

/// Why a block cannot be generated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GenerateError {
    /// A length is zero, negative, not finite, or so extreme that volumes leave the range of f64.
    #[error("{what} is {value_m:?} m: give a length between {:e} and {:e} m", LENGTHS_M.start(), LENGTHS_M.end())]
    Length {
        /// Which length.
        what: &'static str,
        /// Its value [m].
        value_m: f64,
    },
    /// A number of cells is zero.
    #[error("the number of cells along {along} is 0: give at least 1")]
    NoCells {
        /// Which edge.
        along: &'static str,
    },
    /// A coordinate of the outline is not finite, or so extreme that areas leave the range of f64.
    #[error("corner {corner} of the outline is {at_m:?} m: give coordinates up to {:e} m", LENGTHS_M.end())]
    Corner {
        /// Index of the corner, 0 to 2.
        corner: usize,
        /// Its coordinates [m].
        at_m: [f64; 2],
    },
    /// The corners of the outline run clockwise.
    #[error("the outline runs clockwise (area {area_m2:e} m²): swap two of its corners")]
    Clockwise {
        /// Signed area [m²].
        area_m2: f64,
    },
    /// The corners of the outline lie on a line.
    #[error(
        "the outline has no area ({area_m2:e} m² with a longest edge of {edge_m:?} m): move a corner off the line"
    )]
    NoArea {
        /// Signed area [m²].
        area_m2: f64,
        /// Longest edge [m].
        edge_m: f64,
    },
    /// A corner in space is not finite or extreme.
    #[error("corner {corner} is at {at_m:?} m: give coordinates up to {:e} m", LENGTHS_M.end())]
    Place {
        /// Index of the corner.
        corner: usize,
        /// Its place [m].
        at_m: [f64; 3],
    },
    /// An angle outside its range.
    #[error("{what} is {value_deg:?}°: give {least} to {most}°")]
    Angle {
        /// Which angle.
        what: &'static str,
        /// Its value [°].
        value_deg: f64,
        /// Least value [°].
        least: f64,
        /// Largest value [°].
        most: f64,
    },
    /// The shape is folded, inside out, or too coarse for its curve.
    #[error(
        "tetrahedron {tet} of the shape has {volume_m3:e} m³: reorder the corners, or use more cells along an arc"
    )]
    Folded {
        /// Index of the tetrahedron.
        tet: usize,
        /// Its volume [m³].
        volume_m3: f64,
    },
    /// More nodes or tetrahedra than 32-bit indices can hold.
    #[error(
        "the mesh would have {nodes} nodes and {tets} tetrahedra, and at most {} and {MAX_TETS} are possible: use fewer cells",
        u32::MAX
    )]
    TooMany {
        /// Nodes requested.
        nodes: u128,
        /// Tetrahedra requested.
        tets: u128,
    },
}

fn check_length(what: &'static str, value_m: f64) -> Result<(), GenerateError> {
    if LENGTHS_M.contains(&value_m) { Ok(()) } else { Err(GenerateError::Length { what, value_m }) }
}

fn check_cells(along: &'static str, cells: u32) -> Result<(), GenerateError> {
    if cells > 0 { Ok(()) } else { Err(GenerateError::NoCells { along }) }
}

fn check_counts(nodes: u128, tets: u128) -> Result<(), GenerateError> {
    if nodes > u128::from(u32::MAX) || tets > MAX_TETS as u128 {
        return Err(GenerateError::TooMany { nodes, tets });
    }
    Ok(())
}

/// `size_m` · `step` / `steps`; exact at both ends, so that opposite sides are where the user put them.
fn fraction(size_m: f64, step: u32, steps: u32) -> f64 {
    if step == steps { size_m } else { size_m * f64::from(step) / f64::from(steps) }
}
