//! Blocks that overlap at the start: contact would throw them apart, so they are refused unless the scene settles first.

use ndda_contact::{PairResultant, resultants};
use ndda_io::code::Code;
use ndda_io::diagnostic::Diagnostic;
use ndda_io::read::LoadedScene;
use ndda_mesh::BlockId;
use ndda_solver::{BodyKind, Simulation, StepError};

/// Mean depth over the smaller of two blocks' smallest tetrahedron heights. Blocks that are laid as deep as contact carries
/// them at rest are well below.
const MOST_DEPTH: f64 = 0.01;
/// Force of a pair over the largest one, below which it is rounding.
const ROUNDING: f64 = 1e-6;
/// Pairs that are listed.
const MOST_LISTED: usize = 10;

/// What to say of the blocks of a scene that overlap too deep to begin with, if there are any.
///
/// # Errors
/// [`StepError`] when contact cannot be computed.
pub fn refusal(loaded: &LoadedScene, simulation: &mut Simulation) -> Result<Option<Diagnostic>, StepError> {
    if loaded.scene.settle.is_some() {
        return Ok(None);
    }
    let (report, mut facets) = simulation.contacts_at_start()?;
    if report.past_centroid.is_none() && report.max_penetration_ratio <= MOST_DEPTH {
        return Ok(None);
    }
    let found = resultants(simulation.blocks(), &mut facets);
    let largest_n = found.iter().map(|pair| pair.force_n.norm()).fold(0.0, f64::max);
    let mut pairs: Vec<(PairResultant, f64)> = found
        .into_iter()
        // Faces that only just touch have pieces made of rounding, of any depth and without force.
        .filter(|pair| pair.force_n.norm() > ROUNDING * largest_n)
        .filter(|pair| [pair.first, pair.second].iter().any(|&block| !is_fixed(simulation, block)))
        .map(|pair| (pair, pair.depth_m / height_m(simulation, &pair)))
        .filter(|(_, ratio)| *ratio > MOST_DEPTH)
        .collect();
    if pairs.is_empty() {
        return Ok(None);
    }
    pairs.sort_by(|a, b| b.1.total_cmp(&a.1));
    let name = |block: BlockId| &simulation.blocks().names[block.index()];
    let one = |(pair, ratio): &(PairResultant, f64)| {
        let (first, second, percent) = (name(pair.first), name(pair.second), 100.0 * ratio);
        format!(
            "`{first}` and `{second}` {:.2e} m deep, {percent:.1} % of a tetrahedron's height",
            pair.depth_m
        )
    };
    let listed: Vec<String> = pairs.iter().take(MOST_LISTED).map(one).collect();
    let more = pairs.len().saturating_sub(MOST_LISTED);
    let more = if more > 0 { format!("; and {more} more") } else { String::new() };
    let message =
        format!("{} pair(s) of blocks overlap at the start: {}{more}", pairs.len(), listed.join("; "));
    let help = "move them apart, or let them come to rest before the run begins: `settle: ()`";
    Ok(Some(loaded.diagnose_as(Code::Overlap, "blocks", message).with_help(help)))
}

fn is_fixed(simulation: &Simulation, block: BlockId) -> bool {
    simulation.shape(block).kind == BodyKind::Fixed
}

fn height_m(simulation: &Simulation, pair: &PairResultant) -> f64 {
    let height = |block: BlockId| simulation.shape(block).smallest_height_m;
    height(pair.first).min(height(pair.second))
}
