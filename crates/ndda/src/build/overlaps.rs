//! Blocks that overlap at the start: contact would throw them apart, so they are refused unless the scene settles first.

use std::collections::{BTreeSet, HashMap};

use ndda_contact::{PairResultant, resultants};
use ndda_io::code::Code;
use ndda_io::diagnostic::{Diagnostic, Severity};
use ndda_io::read::LoadedScene;
use ndda_mesh::geometry::{Aabb, tet_volume};
use ndda_mesh::{BlockId, BlockSet, Vec3};
use ndda_solver::{BodyKind, Simulation, StepError};

/// Mean depth over the smaller of two blocks' smallest tetrahedron heights. Blocks that are laid as deep as contact carries
/// them at rest are well below.
const MOST_DEPTH: f64 = 0.01;
/// The same, below which blocks touch but for rounding.
const LEAST_DEPTH: f64 = 1e-9;
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
    let shared = in_the_same_place(simulation);
    let is_wholly = shared.as_ref().is_some_and(|shared| shared.is_wholly);
    let same_place = shared.map(|shared| {
        let message = shared.words(&simulation.blocks().names);
        loaded.diagnose_as(Code::Overlap, "blocks", message).with_help(shared.cure())
    });
    if is_wholly {
        return Ok(same_place);
    }
    if loaded.scene.settle.is_some() {
        return Ok(None);
    }
    let (report, mut facets) = simulation.contacts_at_start()?;
    let overlap = |ratio: f64| report.past_centroid.is_some() || report.max_penetration_ratio > ratio;
    if !overlap(LEAST_DEPTH) {
        return Ok(same_place);
    }
    let found = resultants(simulation.blocks(), &mut facets);
    simulation.note_drawn_overlaps(&found);
    let pairs = if overlap(MOST_DEPTH) { too_deep(simulation, found) } else { Vec::new() };
    if pairs.is_empty() {
        return Ok(same_place);
    }
    let message = listed(&simulation.blocks().names, &pairs);
    let help = format!("move them apart, or let them come to rest before the run begins: {}", settle(loaded));
    Ok(Some(loaded.diagnose_as(Code::Overlap, "blocks", message).with_help(help)))
}

/// Pairs that overlap too deep, with their mean depth over an element's height, the deepest first.
fn too_deep(simulation: &Simulation, found: Vec<PairResultant>) -> Vec<(PairResultant, f64)> {
    let largest_n = found.iter().map(|pair| pair.force_n.norm()).fold(0.0, f64::max);
    let mut pairs: Vec<(PairResultant, f64)> = found
        .into_iter()
        // Faces that only just touch have pieces made of rounding, of any depth and without force.
        .filter(|pair| pair.force_n.norm() > ROUNDING * largest_n)
        .filter(|pair| [pair.first, pair.second].iter().any(|&block| !is_fixed(simulation, block)))
        .map(|pair| (pair, pair.depth_m / height_m(simulation, &pair)))
        .filter(|(_, ratio)| *ratio > MOST_DEPTH)
        .collect();
    pairs.sort_by(|a, b| b.1.total_cmp(&a.1));
    pairs
}

/// The pairs in words.
fn listed(names: &[String], pairs: &[(PairResultant, f64)]) -> String {
    let one = |(pair, ratio): &(PairResultant, f64)| {
        let [first, second] = [pair.first, pair.second].map(|block| &names[block.index()]);
        let (depth_m, percent) = (pair.depth_m, 100.0 * ratio);
        format!("`{first}` and `{second}` {depth_m:.2e} m deep on average, {percent:.1} % of an element size")
    };
    let listed: Vec<String> = pairs.iter().take(MOST_LISTED).map(one).collect();
    let more = pairs.len().saturating_sub(MOST_LISTED);
    let more = if more > 0 { format!("; and {more} more") } else { String::new() };
    let what = match pairs.len() {
        1 => "two blocks overlap at the start".into(),
        n => format!("{n} pairs of blocks overlap at the start"),
    };
    format!("{what}: {}{more}", listed.join("; "))
}

/// Two blocks in the same place.
struct Shared {
    inner: BlockId,
    outer: BlockId,
    /// A point in the solid of both [m].
    at_m: Vec3,
    /// Whether all nodes of the inner one are in the solid of the outer one.
    is_wholly: bool,
}

impl Shared {
    fn words(&self, names: &[String]) -> String {
        let [inner, outer] = [self.inner, self.outer].map(|block| &names[block.index()]);
        let at = self.at_m;
        if self.is_wholly {
            return format!("block `{inner}` lies wholly inside block `{outer}`");
        }
        format!(
            "blocks `{inner}` and `{outer}` are in the same place: ({:.4}, {:.4}, {:.4}) m is inside both",
            at.x, at.y, at.z
        )
    }

    fn cure(&self) -> &'static str {
        match self.is_wholly {
            true => "move one of them away: contact acts on surfaces that cross, and here none do",
            false => {
                "move one of them away: contact is made for blocks that overlap by a small part of their size"
            }
        }
    }
}

/// A block whose largest tetrahedron has its middle in the solid of another, and that other, unless both are fixed.
fn in_the_same_place(simulation: &Simulation) -> Option<Shared> {
    let (blocks, position) = (simulation.blocks(), &simulation.state().position);
    let there = blocks.ids().filter(|&block| !simulation.is_absent(block));
    let mut boxes: Vec<(BlockId, Aabb)> =
        there.map(|block| (block, Aabb::around(&position[blocks.nodes_of(block)]))).collect();
    boxes.sort_by(|a, b| a.1.min.x.total_cmp(&b.1.min.x));
    let holds_point = |outer: &Aabb, x: &Vec3| (0..3).all(|i| outer.min[i] <= x[i] && x[i] <= outer.max[i]);
    let places = BoxesByPlace::new(&boxes);
    boxes.iter().find_map(|(inner, _)| {
        let at_m = middle_of_largest(blocks, position, *inner);
        let holds = |place: &usize| {
            let (outer, around) = &boxes[*place];
            let moves = [*inner, *outer].iter().any(|&block| !is_fixed(simulation, block));
            let may = inner != outer && moves && holds_point(around, &at_m);
            may && is_in_solid(blocks, position, *outer, &at_m)
        };
        let outer = boxes[places.that_may_hold(&at_m).filter(holds).min()?].0;
        let is_within = |inner: BlockId, outer: BlockId| {
            position[blocks.nodes_of(inner)].iter().all(|x| is_in_solid(blocks, position, outer, x))
        };
        let [inner, outer] = if is_within(outer, *inner) { [outer, *inner] } else { [*inner, outer] };
        Some(Shared {
            inner,
            outer,
            at_m: at_m + blocks.origin_m,
            is_wholly: is_within(inner, outer) && !is_within(outer, inner),
        })
    })
}

/// What brings a scene to rest; gravity has no ramp then.
fn settle(loaded: &LoadedScene) -> &'static str {
    match loaded.scene.gravity_ramp_s > 0.0 {
        true => "`settle: ()` in place of gravity_ramp_s",
        false => "`settle: ()`",
    }
}

/// A warning for blocks that contact throws apart from where they are drawn, faster than errors of an accurate run may be.
pub fn warning(loaded: &LoadedScene, simulation: &Simulation) -> Option<Diagnostic> {
    let thrown = simulation.invariants().drawn_overlap_m_s;
    let fastest_m_s = simulation.state().velocity.iter().map(|v| v.norm()).fold(0.0, f64::max);
    if thrown.value <= crate::judge::verdict::SPEED * simulation.speed_scale_m_s().max(fastest_m_s) {
        return None;
    }
    let name = &simulation.blocks().names[thrown.block as usize];
    let message = format!(
        "block `{name}` overlaps others as drawn, and contact throws it away at {:.2e} m/s",
        thrown.value
    );
    let help = format!("move it, or let the scene come to rest before the run begins: {}", settle(loaded));
    let mut found = loaded.diagnose_as(Code::Overlap, "blocks", message).with_help(help);
    found.severity = Severity::Warning;
    Some(found)
}

/// The middle of a block's largest tetrahedron [m].
fn middle_of_largest(blocks: &BlockSet, position: &[Vec3], block: BlockId) -> Vec3 {
    let corners = |tet: usize| blocks.tets[tet].map(|n| position[n.index()]);
    let volume = |tet: &usize| tet_volume(&corners(*tet));
    let largest = blocks.tets_of(block).max_by(|a, b| volume(a).total_cmp(&volume(b)));
    corners(largest.expect("a block has tetrahedra")).iter().sum::<Vec3>() / 4.0
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
