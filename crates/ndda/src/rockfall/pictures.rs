//! The outcome as pictures: the map with paths, the map of reach, the profile with envelopes, and histograms at lines.

mod axes;
mod ground;
mod lines;
mod map;
mod profile;

use std::path::Path;

use ndda_io::WriteError;

use super::Model;
use super::fall::Fall;
use super::result::Outcome;
use crate::picture::svg::Rgb;
use crate::picture::{ENDINGS, write_svg};

/// Text and axes.
const INK: Rgb = [28, 28, 32];
/// Text of less weight.
const GREY: Rgb = [104, 104, 112];
/// Lines of a grid.
const FAINT: Rgb = [222, 222, 226];
/// The 95th percentile, the largest and the median.
const PERCENTILE: Rgb = [213, 94, 0];
const LARGEST: Rgb = [150, 150, 158];
const MEDIAN: Rgb = [0, 114, 178];

/// Draws all pictures of an outcome into a folder, as SVG and, where the program can, as PNG.
///
/// # Errors
/// [`WriteError`] of the first that cannot be drawn or written.
pub fn draw(model: &Model, outcome: &Outcome, falls: &[Fall], out: &Path) -> Result<(), WriteError> {
    let write = |name: &str, svg: String| {
        ENDINGS.iter().try_for_each(|ending| write_svg(&out.join(format!("{name}.{ending}")), svg.clone()))
    };
    write("map", map::paths(model, outcome, falls))?;
    write("reach", map::reach(model, outcome, falls))?;
    write("profile", profile::draw(model, outcome, falls))?;
    match lines::draw(model, outcome, falls) {
        Some(svg) => write("lines", svg),
        None => Ok(()),
    }
}

/// How many falls there are, in words.
fn subtitle(outcome: &Outcome) -> String {
    let ends = &outcome.ends;
    let mut words = format!(
        "{} boulders, seed {}: {} at rest, {} left the terrain",
        outcome.count, outcome.seed, ends.rest, ends.left_terrain
    );
    for (count, what) in [(ends.still_moving, "still moved"), (ends.stopped, "not computed to the end")] {
        if count > 0 {
            words += &format!(", {count} {what}");
        }
    }
    words
}
