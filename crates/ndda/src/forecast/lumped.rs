//! Error of lumped masses: an inertia of rotation that is too large.

use ndda_io::code::Code;
use ndda_io::diagnostic::{Diagnostic, Severity};
use ndda_io::read::LoadedScene;
use ndda_solver::Simulation;

/// Error of an inertia that is worth a warning: the part by which the label lets speeds be wrong.
const LARGE: f64 = 0.01;
/// Most blocks that a warning names.
const MOST_NAMES: usize = 4;

/// A warning for blocks whose inertia of rotation lumped masses change by more than a speed may be wrong.
pub fn warning(loaded: &LoadedScene, simulation: &Simulation) -> Option<Diagnostic> {
    let mut errors = simulation.lumped_inertia_errors();
    errors.retain(|(_, error)| *error > LARGE);
    errors.sort_by(|a, b| b.1.total_cmp(&a.1));
    let name = |block: ndda_mesh::BlockId| &simulation.blocks().names[block.index()];
    let named = errors.iter().take(MOST_NAMES);
    let named: Vec<String> =
        named.map(|(block, error)| format!("{:.1} % for block `{}`", 100.0 * error, name(*block))).collect();
    if named.is_empty() {
        return None;
    }
    let others = match errors.len() - named.len() {
        0 => String::new(),
        1 => ", and less for one other kind of block".into(),
        others => format!(", and less for {others} other kinds of blocks"),
    };
    let message =
        format!("lumped masses have too large an inertia of rotation: by {}{others}", named.join(", "));
    let help = "blocks that turn will turn too slowly: set mass: Consistent, use more cells, or make the blocks Affine or Rigid";
    let mut found = loaded.diagnose("time.mass", message).with_help(help);
    (found.code, found.severity) = (Code::Inexact, Severity::Warning);
    Some(found)
}
