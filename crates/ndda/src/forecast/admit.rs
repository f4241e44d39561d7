//! Whether what a scene or a mesh file will take fits into the memory that there is.

use std::path::Path;

use ndda_io::code::Code;
use ndda_io::diagnostic::Diagnostic;
use ndda_io::read::LoadedScene;
use ndda_io::scene::Fill;

use super::memory::{self, readable};
use super::size::{
    BLOCK_B, Count, PROGRAM_B, Part, TET_B, bytes, filled, parts, rounded, taken_apart, tets_of_file, times,
};
use crate::numbers::counted;

/// Building for longer is announced [s].
const LONG_S: f64 = 60.0;
/// Building for longer is not told in seconds [s].
const A_DAY_S: f64 = 86_400.0;
/// More memory than any machine has [GB].
const MOST_GB: f64 = 1e5;

/// Why the scene is not to be built in the memory that there is.
///
/// # Errors
/// A message on its largest part, with the figures and what to change.
pub fn admit(loaded: &LoadedScene, folder: &Path) -> Result<(), Diagnostic> {
    let parts = parts(&loaded.scene, folder);
    let Some(largest) = parts.iter().max_by(|a, b| a.bytes.total_cmp(&b.bytes)) else { return Ok(()) };
    let (needed, build_s) = (bytes(&parts), parts.iter().map(|part| part.count.build_s).sum::<f64>());
    let figures = figures(largest);
    match memory::budget() {
        Some(budget) if needed > budget as f64 => {
            let message = format!(
                "{figures} would take {} of memory (the whole scene {}) and {} to build; there is {}",
                size(largest.bytes),
                size(needed),
                if build_s < A_DAY_S { format!("{build_s:.0} s") } else { "more than a day".into() },
                readable(budget)
            );
            let found = loaded.diagnose_as(Code::TooLarge, &largest.path, message);
            let enough = (1.1e-9 * needed).ceil();
            Err(found.with_help(match enough <= MOST_GB {
                true => format!(
                    "{}; if the machine has that much memory, give --memory {enough:.0}GB",
                    largest.cure
                ),
                false => largest.cure.into(),
            }))
        }
        _ => Ok(()),
    }
}

/// Holds what the blocks of a mesh file take, by its length, against the memory that there is. Of a geometry that Gmsh
/// meshes the length says nothing.
///
/// # Errors
/// A message with the figures and what to change.
pub fn admit_file(file: &Path) -> Result<(), String> {
    let tets = tets_of_file(file);
    let bytes = PROGRAM_B + tets * TET_B;
    match memory::budget() {
        Some(budget) if bytes > budget as f64 => Err(format!(
            "{}: about {} tetrahedra would take {} of memory; there is {}: use a coarser mesh; if the machine has more memory than that, \
             give --memory 64GB",
            file.display(),
            rounded(tets),
            readable(bytes as u64),
            readable(budget)
        )),
        _ => Ok(()),
    }
}

/// A line for a person to read while a scene is built that takes long.
pub fn slow_build(loaded: &LoadedScene, folder: &Path) -> Option<String> {
    let parts = parts(&loaded.scene, folder);
    let largest = parts.iter().max_by(|a, b| a.bytes.total_cmp(&b.bytes))?;
    let build_s = parts.iter().map(|part| part.count.build_s).sum::<f64>();
    let text = || format!("building {} takes about {:.0} min", figures(largest), build_s / 60.0);
    (build_s > LONG_S).then(text)
}

/// A size of memory in words, also of what no machine has.
fn size(bytes: f64) -> String {
    if bytes < 1e9 * MOST_GB { readable(bytes as u64) } else { format!("more than {MOST_GB} GB") }
}

fn figures(part: &Part) -> String {
    let Count { blocks, tets, .. } = part.count;
    let noun = if blocks == 1.0 { "block" } else { "blocks" };
    format!("about {} {noun} and {} tetrahedra", rounded(blocks), rounded(tets))
}

/// Most blocks that a cut may make in the memory that there is.
pub fn most_blocks(otherwise: usize) -> usize {
    memory::budget().map_or(otherwise, |bytes| otherwise.min((bytes as f64 / BLOCK_B) as usize).max(1))
}

/// Holds what filling takes at least, once blocks are cut or a surface is read, against the memory that there is; with `apart`, what tetrahedra take that
/// become blocks of their own.
///
/// # Errors
/// A message with the figures.
pub fn admit_fill(blocks: usize, fill: &Fill, (volume_m3, apart): (f64, bool)) -> Result<(), String> {
    let count = filled(times(Count::default(), blocks as f64), fill, volume_m3, 0.0);
    let count = if apart { taken_apart(count) } else { count };
    let bytes = count.blocks * BLOCK_B + count.tets * TET_B;
    match memory::budget() {
        Some(budget) if bytes > budget as f64 => Err(format!(
            "{} of {} tetrahedra in all would take {} of memory; there is {}: use a coarser fill",
            counted(blocks, "block", "blocks"),
            rounded(count.tets),
            readable(bytes as u64),
            readable(budget)
        )),
        _ => Ok(()),
    }
}
