//! Loss of digits by coordinates far from the origin: those that a file's numbers have left for the blocks.

use ndda_io::code::Code;
use ndda_io::diagnostic::{Diagnostic, Severity};
use ndda_io::read::LoadedScene;
use ndda_mesh::{BlockSet, Vec3};

/// Rounding of coordinates over the size of the smallest block that is still exact enough.
const ENOUGH: f64 = 1e-8;

/// Rounding of the coordinates over the longest side of the smallest block.
fn rounding(blocks: &BlockSet) -> f64 {
    let side = |block| {
        let nodes = &blocks.rest_position[blocks.nodes_of(block)];
        let (low, high) = nodes.iter().fold((nodes[0], nodes[0]), |(low, high), x| (low.inf(x), high.sup(x)));
        (high - low).amax()
    };
    let smallest = blocks.ids().map(side).fold(f64::INFINITY, f64::min);
    let farthest = |far: f64, x: &Vec3| far.max((x + blocks.origin_m).amax());
    blocks.rest_position.iter().fold(0.0, farthest) * f64::EPSILON / smallest
}

/// A warning for blocks so far away that too few of the sixteen digits of their coordinates say what shape they have.
pub fn warning(loaded: &LoadedScene, blocks: &BlockSet) -> Option<Diagnostic> {
    let rounding = rounding(blocks);
    if rounding <= ENOUGH {
        return None;
    }
    let lost = (rounding / f64::EPSILON).log10().ceil();
    let path = if loaded.scene.blocks.is_empty() { "rock" } else { "blocks" };
    let message = format!(
        "coordinates are so large that {lost} of 16 digits are lost: they are rounded by {rounding:.0e} of the smallest block"
    );
    let mut found =
        loaded.diagnose(path, message).with_help("move the origin of coordinates near the blocks");
    (found.code, found.severity) = (Code::Inexact, Severity::Warning);
    Some(found)
}
