//! Blocks that overlap at the start: contact would throw them apart, so they are refused unless the scene settles first.

use std::collections::{BTreeSet, HashMap};

use ndda_contact::{PairResultant, resultants};
use ndda_io::code::Code;
use ndda_io::diagnostic::Diagnostic;
use ndda_io::read::LoadedScene;
use ndda_mesh::geometry::{Aabb, tet_volume};
use ndda_mesh::{BlockId, BlockSet, Vec3};
use ndda_solver::{BodyKind, Simulation, StepError};

/// Mean depth over the smaller of two blocks' smallest tetrahedron heights. Blocks that are laid as deep as contact carries
/// them at rest are well below.
const MOST_DEPTH: f64 = 0.01;
/// Force of a pair over the largest one, below which it is rounding.
const ROUNDING: f64 = 1e-6;
/// Pairs that are listed.
const MOST_LISTED: usize = 10;

/// Diagnostic for blocks of a scene that overlap too deep at the start, if there are any.
///
/// # Errors
/// [`StepError`] when contact cannot be computed.
pub fn refusal(loaded: &LoadedScene, simulation: &mut Simulation) -> Result<Option<Diagnostic>, StepError> {
    if !simulation.has_contact() {
        return Ok(None);
    }
    if let Some((inner, outer)) = enclosed(simulation) {
        let name = |block: BlockId| &simulation.blocks().names[block.index()];
        let message = format!("block `{}` lies wholly inside block `{}`", name(inner), name(outer));
        let help = "move one of them away: contact acts on surfaces that cross, and here none do";
        return Ok(Some(loaded.diagnose_as(Code::Overlap, "blocks", message).with_help(help)));
    }
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
        format!("`{first}` and `{second}` {:.2e} m deep, {percent:.1} % of an element size", pair.depth_m)
    };
    let listed: Vec<String> = pairs.iter().take(MOST_LISTED).map(one).collect();
    let more = pairs.len().saturating_sub(MOST_LISTED);
    let more = if more > 0 { format!("; and {more} more") } else { String::new() };
    let what = match pairs.len() {
        1 => "two blocks overlap at the start".into(),
        n => format!("{n} pairs of blocks overlap at the start"),
    };
    let message = format!("{what}: {}{more}", listed.join("; "));
    let help = "move them apart, or let them come to rest before the run begins: `settle: ()`";
    Ok(Some(loaded.diagnose_as(Code::Overlap, "blocks", message).with_help(help)))
}

/// A block with all nodes in the solid of another, and that other, unless both are fixed.
fn enclosed(simulation: &Simulation) -> Option<(BlockId, BlockId)> {
    let (blocks, position) = (simulation.blocks(), &simulation.state().position);
    let there = blocks.ids().filter(|&block| !simulation.is_absent(block));
    let mut boxes: Vec<(BlockId, Aabb)> =
        there.map(|block| (block, Aabb::around(&position[blocks.nodes_of(block)]))).collect();
    boxes.sort_by(|a, b| a.1.min.x.total_cmp(&b.1.min.x));
    let within = |inner: &Aabb, outer: &Aabb| {
        (0..3).all(|i| outer.min[i] < inner.min[i] && inner.max[i] < outer.max[i])
    };
    let places = BoxesByPlace::new(&boxes);
    boxes.iter().find_map(|(inner, bounds)| {
        let nodes = &position[blocks.nodes_of(*inner)];
        let holds = |place: &usize| {
            let (outer, around) = &boxes[*place];
            let moves = [*inner, *outer].iter().any(|&block| !is_fixed(simulation, block));
            moves && within(bounds, around) && nodes.iter().all(|x| is_in_solid(blocks, position, *outer, x))
        };
        let outer = places.that_may_hold(&bounds.min).filter(holds).min();
        outer.map(|outer| (*inner, boxes[outer].0))
    })
}

/// Boxes in grids, one for each power of two that some are no larger than: each box is in the cell of its lower corner.
struct BoxesByPlace {
    /// The powers of two.
    sizes: BTreeSet<i32>,
    in_cell: HashMap<(i32, [i64; 3]), Vec<usize>>,
}

impl BoxesByPlace {
    fn new(boxes: &[(BlockId, Aabb)]) -> Self {
        let mut places = Self { sizes: BTreeSet::new(), in_cell: HashMap::new() };
        for (place, (_, bounds)) in boxes.iter().enumerate() {
            let size = (bounds.max - bounds.min).amax().log2().ceil() as i32;
            places.sizes.insert(size);
            places.in_cell.entry((size, cell(&bounds.min, size))).or_default().push(place);
        }
        places
    }

    /// The boxes that may hold a point: their lower corner is in the cell of the point, or one cell lower along some axes.
    fn that_may_hold(&self, point: &Vec3) -> impl Iterator<Item = usize> {
        let near = move |&size: &i32| {
            let here = cell(point, size);
            (0..8).map(move |lower| (size, [0, 1, 2].map(|i| here[i] - i64::from(lower >> i & 1))))
        };
        self.sizes.iter().flat_map(near).filter_map(|cell| self.in_cell.get(&cell)).flatten().copied()
    }
}

fn cell(point: &Vec3, size: i32) -> [i64; 3] {
    let edge_m = f64::from(size).exp2();
    [0, 1, 2].map(|i| (point[i] / edge_m).floor() as i64)
}

/// Whether a point is in one of a block's tetrahedra: none of the four that it makes with their faces has negative volume.
pub(crate) fn is_in_solid(blocks: &BlockSet, position: &[Vec3], block: BlockId, x: &Vec3) -> bool {
    blocks.tets_of(block).any(|tet| {
        let corners = blocks.tets[tet].map(|n| position[n.index()]);
        let with_point = |k: usize| {
            let mut part = corners;
            part[k] = *x;
            tet_volume(&part)
        };
        (0..4).all(|k| with_point(k) >= 0.0)
    })
}

fn is_fixed(simulation: &Simulation, block: BlockId) -> bool {
    simulation.shape(block).kind == BodyKind::Fixed
}

fn height_m(simulation: &Simulation, pair: &PairResultant) -> f64 {
    let height = |block: BlockId| simulation.shape(block).smallest_height_m;
    height(pair.first).min(height(pair.second))
}
