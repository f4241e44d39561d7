//! Rock of a scene as blocks.

mod domain;
mod joints;

use std::fmt;
use std::path::Path;

use ndda_io::scene::{self, Contact, Fill, Potential, Rock, Scene, Slivers, Whereabouts};
use ndda_mesh::cut::{
    Axis, Blocks, CutOptions, Domain, Merged, VoronoiOptions, cut_blocks, random_seeds, voronoi_blocks,
};
use ndda_mesh::geometry::tet_volume;
use ndda_mesh::tetrahedralise::taken_apart;
use ndda_mesh::{BlockId, BlockMesh, BlockSet, Vec3};
use rayon::prelude::*;
use serde::Serialize;

pub use super::bonded::{Bonded, Bonds};
use super::{Fault, solid, vec3};
use crate::forecast::admit;
use crate::numbers::{counted, four_figures};
use domain::domain;
use joints::Discs;

/// Most faces of a block that tetrahedra without a node inside fill, where contact is `Smooth`.
const FACES_OF_A_FAN: usize = 13;

/// Blocks that a rock was cut into, and what was left out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RockReport {
    /// Name of the rock.
    pub name: String,
    /// Blocks that are left.
    pub blocks: usize,
    /// Volume of the rock before it was cut [m³].
    pub domain_m3: f64,
    /// Slivers united with their neighbours, and their volume [m³].
    pub merged: (usize, f64),
    /// Slivers left out, and their volume [m³].
    pub slivers: (usize, f64),
    /// Slivers kept: parts of concave blocks, and those that are convex with none of their neighbours.
    pub thin: usize,
    /// Parts taken out by `removed`, and their volume [m³].
    pub removed: (usize, f64),
    /// Cuts that would have left a needle thinner than rounding, and were not made.
    pub refused: usize,
    /// Warning of heights that are missing within its terrain; none where there are none.
    #[serde(skip)]
    pub gaps: Option<String>,
    /// What discs cut; left out where there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub discs: Option<Discs>,
    /// How stiff it is where it is taken apart into pieces that bonds hold together; left out where it is not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bonded: Option<Bonded>,
}

impl fmt::Display for RockReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, blocks, domain_m3, merged, slivers, thin, removed, refused, discs, bonded, .. } =
            self;
        let kept_m3 = domain_m3 - slivers.1 - removed.1;
        write!(f, "rock {name}: {} of {} m³", counted(*blocks, "block", "blocks"), four_figures(kept_m3))?;
        let counts = [
            ("sliver", "united with neighbours", merged),
            ("sliver", "left out", slivers),
            ("part", "removed", removed),
        ];
        for (noun, what, (count, m3)) in counts {
            if *count > 0 {
                write!(
                    f,
                    ", {} {what} ({} m³)",
                    counted(*count, noun, &format!("{noun}s")),
                    four_figures(*m3)
                )?;
            }
        }
        if *thin > 0 {
            write!(f, ", {} kept", counted(*thin, "sliver", "slivers"))?;
        }
        if *refused > 0 {
            let cuts = counted(*refused, "cut", "cuts");
            write!(f, ", {cuts} not made because they would leave needles")?;
        }
        discs.as_ref().map_or(Ok(()), |discs| write!(f, "\n  {discs}"))?;
        bonded.as_ref().map_or(Ok(()), |bonded| write!(f, "\n  {bonded}"))
    }
}

/// A rock in blocks.
#[derive(Clone, Debug)]
pub struct CutRock {
    /// Counts of the cut.
    pub report: RockReport,
    /// The convex parts of the blocks that are left.
    pub blocks: Blocks,
}

/// What each rock of a scene was cut into, and how stiff it is where it is in pieces.
pub(super) fn reports(scene: &Scene, rocks: Vec<CutRock>, blocks: &BlockSet) -> Vec<RockReport> {
    let report = |(index, rock): (usize, CutRock)| RockReport {
        bonded: Bonded::new(scene, index, blocks),
        ..rock.report
    };
    rocks.into_iter().enumerate().map(report).collect()
}

/// Names and meshes of blocks.
pub type Meshes = Vec<(String, BlockMesh)>;

/// Takes a mesh and its name.
pub(super) type TakeMesh<'a> = dyn FnMut(String, BlockMesh) + 'a;

/// Blocks that are filled at a time, so that the meshes of a large rock are not in memory together.
const AT_A_TIME: usize = 1024;

/// Cuts and fills rock `index` of a scene, and hands out the meshes.
///
/// # Errors
/// Faults of rock that cannot be cut or filled.
pub(super) fn cut_rock(
    scene: &Scene,
    folder: &Path,
    index: usize,
    take: &mut TakeMesh,
) -> Result<CutRock, Vec<Fault>> {
    let rock = &scene.rock[index];
    let at = |field: &str| format!("rock[{index}]{field}");
    let (domain, gaps) = domain(&rock.domain, folder).map_err(|m| vec![Fault::new(at(".domain"), m)])?;
    if rock.sliver_width_m.powi(3) >= domain.volume_m3() {
        let message = format!(
            "{} m: a cube of this width is larger than the rock of {:.3e} m³, so that all of it is slivers",
            rock.sliver_width_m,
            domain.volume_m3()
        );
        return Err(vec![Fault::new(at(".sliver_width_m"), message)]);
    }
    let cut_field = if rock.voronoi.is_some() { ".voronoi" } else { ".joints" };
    let blocks = cut(rock, &domain, folder).map_err(|m| vec![Fault::new(at(cut_field), m)])?;
    let carved = Carved::new(rock, &domain, blocks).map_err(|(field, m)| vec![Fault::new(at(&field), m)])?;
    let mut report = RockReport { gaps, ..carved.report(rock, &domain) };
    let fill_field = if rock.into.is_some() { ".into" } else { ".fill" };
    let kept_m3 = report.domain_m3 - report.slivers.1 - report.removed.1;
    let groups = carved.blocks.groups();
    admit::admit_fill(groups.len(), &rock.filling(), (kept_m3, rock.into.is_some()))
        .map_err(|m| vec![Fault::new(at(fill_field), m)])?;
    let (counts, refused) = carved.fill((scene, rock), &groups, take);
    let mut faults: Vec<Fault> = refused.into_iter().map(|m| Fault::new(at(fill_field), m)).collect();
    if let Some(k) = counts[..carved.spaces.len()].iter().position(|count| *count == 0) {
        let message = "holds no rock: check its outline, which is given as (y, z) along X, (x, z) along Y, and (x, y) along Z";
        faults.push(Fault::new(at(&format!(".excavations[{k}]")), message));
    }
    report.blocks = counts.iter().sum();
    if report.blocks == 0 && faults.is_empty() {
        faults.push(Fault::new(at(".removed"), "no block is left: take out fewer"));
    }
    if faults.is_empty() { Ok(CutRock { report, blocks: carved.blocks }) } else { Err(faults) }
}

/// Rock that is cut, without slivers and what is removed, and along the borders of what is to be excavated.
struct Carved {
    blocks: Blocks,
    /// Spaces that stages excavate.
    spaces: Vec<Domain>,
    /// Slivers united with their neighbours.
    merged: Merged,
    /// Slivers left out, and their volume [m³].
    slivers: (usize, f64),
    /// Parts removed, and their volume [m³].
    removed: (usize, f64),
    /// Cuts that would have left needles before anything was taken out.
    refused: usize,
}

impl Carved {
    /// Carves blocks; a field of the rock and its fault where that cannot be.
    fn new(rock: &Rock, domain: &Domain, mut blocks: Blocks) -> Result<Self, (String, String)> {
        let refused = blocks.report.refused.iter().map(|(_, count)| count).sum();
        let (mut merged, slivers) = match rock.slivers {
            _ if rock.sliver_width_m == 0.0 => (Merged::default(), Vec::new()),
            Slivers::Merge => {
                // Slivers unite with neighbours on their own side of the border between rock that stays and rock that is removed, which so stays plane.
                let is_removed = |at: &Vec3| usize::from(holds(&rock.removed, at));
                (blocks.merge_slivers_within(domain, rock.sliver_width_m, &is_removed), Vec::new())
            }
            Slivers::Remove => (Merged::default(), slivers(&blocks)),
        };
        let slivers = (slivers.len(), blocks.remove(&slivers));
        let removed = chosen(&blocks, &rock.removed);
        let removed = (removed.len(), blocks.remove(&removed));
        let is_empty = |place: &Whereabouts| chosen(&blocks, std::slice::from_ref(place)).is_empty();
        if let Some(k) = rock.fixed.iter().position(is_empty) {
            let message = "holds no block, since no block has its centroid in it: check the signs of its planes, or leave it out; if blocks are larger than this region, enlarge the region or the domain, or reduce the spacing of joints";
            return Err((format!(".fixed[{k}]"), message.into()));
        }
        let spaces = excavate(rock, domain, &mut blocks)
            .map_err(|(k, message)| (format!(".excavations[{k}]"), message))?;
        if !spaces.is_empty() && rock.sliver_width_m > 0.0 && rock.slivers == Slivers::Merge {
            // Borders of excavations make slivers of their own, which stay on their side.
            let space_of = |at: &Vec3| space_of(&spaces, at);
            let more = blocks.merge_slivers_within(domain, rock.sliver_width_m, &space_of);
            merged =
                Merged { count: merged.count + more.count, volume_m3: merged.volume_m3 + more.volume_m3 };
        }
        Ok(Self { blocks, spaces, merged, slivers, removed, refused })
    }

    /// The report, as yet without the number of blocks, which is known once they are filled.
    fn report(&self, rock: &Rock, domain: &Domain) -> RockReport {
        RockReport {
            name: rock.name.clone(),
            blocks: 0,
            domain_m3: domain.volume_m3(),
            merged: (self.merged.count, self.merged.volume_m3),
            slivers: self.slivers,
            thin: self.blocks.report.slivers.len(),
            removed: self.removed,
            refused: self.refused,
            gaps: None,
            discs: Discs::new(&self.blocks.report.discs),
            bonded: None,
        }
    }

    /// Fills all blocks, which are groups of parts, and hands out their meshes: how many there are in each space and, last, outside of all, and why some cannot be filled.
    fn fill(
        &self,
        (scene, rock): (&Scene, &Rock),
        groups: &[Vec<u32>],
        take: &mut TakeMesh,
    ) -> (Vec<usize>, Vec<String>) {
        let (blocks, filling) = (&self.blocks, rock.filling());
        let fill_of =
            |group: &Vec<u32>| solid::filled_group(blocks, group, fill(scene, &filling, blocks, group));
        let filled =
            groups.chunks(AT_A_TIME).flat_map(|some| some.par_iter().map(fill_of).collect::<Vec<_>>());
        let (mut counts, mut refused) = (vec![0; self.spaces.len() + 1], Vec::new());
        for (group, filled) in groups.iter().zip(filled) {
            let space = space_of(&self.spaces, &centroid(blocks, group));
            let stem = rock.excavations.get(space).map_or(&rock.name, |space| &space.name);
            let count = &mut counts[space];
            let mut next = || {
                *count += 1;
                format!("{stem}_{count:04}")
            };
            match filled {
                Ok(mesh) if rock.into.is_some() => {
                    taken_apart(&mesh).into_iter().for_each(|piece| take(next(), piece));
                }
                Ok(mesh) => take(next(), mesh),
                Err(error) => refused.push(format!(
                    "block {} cannot be filled: {error}; a larger `sliver_width_m` unites thin ones with neighbours",
                    next()
                )),
            }
        }
        (counts, refused)
    }
}

/// Number of the space that a place is in; as many as there are where it is in none.
fn space_of(spaces: &[Domain], at_m: &Vec3) -> usize {
    spaces.iter().position(|space| space.holds(at_m)).unwrap_or(spaces.len())
}

/// How a block is filled. A tetrahedron of a fan may be near all faces of its block, which for `Smooth` contact can be too many; one of a star is near few.
fn fill<'a>(scene: &Scene, asked: &'a Fill, blocks: &Blocks, group: &[u32]) -> &'a Fill {
    let is_smooth = matches!(
        scene.contact,
        Some(Contact::Potential { potential: Potential::Smooth { .. } | Potential::Closure { .. }, .. })
    );
    let faces = || group.iter().map(|&part| blocks.blocks[part as usize].faces.len()).max();
    match asked {
        Fill::Fewest if is_smooth && faces() > Some(FACES_OF_A_FAN) => &Fill::Centre,
        _ => asked,
    }
}

/// Slivers that are blocks of their own, not parts of a concave one.
fn slivers(blocks: &Blocks) -> Vec<u32> {
    let alone: Vec<u32> = blocks.groups().iter().filter(|g| g.len() == 1).map(|g| g[0]).collect();
    let listed = blocks.report.slivers.iter().map(|sliver| sliver.block);
    listed.filter(|block| alone.binary_search(block).is_ok()).collect()
}

/// Blocks whose centroid, that of all glued parts, is in one of the places.
fn chosen(blocks: &Blocks, places: &[Whereabouts]) -> Vec<u32> {
    let groups = if places.is_empty() { Vec::new() } else { blocks.groups() };
    groups.into_iter().filter(|group| holds(places, &centroid(blocks, group))).flatten().collect()
}

/// Centroid of glued parts [m].
fn centroid(blocks: &Blocks, group: &[u32]) -> Vec3 {
    let parts = group.iter().map(|&b| blocks.blocks[b as usize].volume_and_centroid());
    let (volume, moment) =
        parts.fold((0.0, Vec3::zeros()), |(v, m), (volume, c)| (v + volume, m + volume * c));
    moment / volume
}

/// Cuts rock along the borders of what is to be excavated, and gives these spaces.
fn excavate(rock: &Rock, domain: &Domain, blocks: &mut Blocks) -> Result<Vec<Domain>, (usize, String)> {
    let mut spaces = Vec::new();
    for (k, given) in rock.excavations.iter().enumerate() {
        let space = Domain::extruded(&given.outline_m, axis(given.axis), given.start_m, given.end_m);
        let space = space.map_err(|error| (k, error.to_string()))?;
        blocks.excavate(domain, (&given.name, &space), rock.sliver_width_m);
        spaces.push(space);
    }
    Ok(spaces)
}

fn axis(axis: scene::Axis) -> Axis {
    match axis {
        scene::Axis::X => Axis::X,
        scene::Axis::Y => Axis::Y,
        scene::Axis::Z => Axis::Z,
    }
}

fn holds(places: &[Whereabouts], at: &Vec3) -> bool {
    places.iter().any(|place| match place {
        Whereabouts::Inside { min_m, max_m } => (0..3).all(|i| min_m[i] <= at[i] && at[i] <= max_m[i]),
        Whereabouts::Beyond { point_m, normal } => (at - vec3(*point_m)).dot(&vec3(*normal)) > 0.0,
    })
}

/// How a block of a rock may move.
pub(super) fn body(rock: &Rock, blocks: &BlockSet, block: BlockId) -> scene::Body {
    if rock.fixed.is_empty() {
        return rock.body;
    }
    let (mut volume, mut moment) = (0.0, Vec3::zeros());
    for tet in blocks.tets_of(block) {
        let corners = blocks.tets[tet].map(|n| blocks.rest_position[n.index()]);
        let part = tet_volume(&corners);
        volume += part;
        moment += part * corners.iter().sum::<Vec3>() / 4.0;
    }
    let centroid = moment / volume + blocks.origin_m;
    if holds(&rock.fixed, &centroid) { scene::Body::Fixed } else { rock.body }
}

fn cut(rock: &Rock, domain: &Domain, folder: &Path) -> Result<Blocks, String> {
    if let Some(voronoi) = rock.voronoi {
        let seeds = random_seeds(domain, voronoi.count as usize, voronoi.least_distance_m, rock.seed);
        let options = VoronoiOptions { sliver_width_m: rock.sliver_width_m };
        return voronoi_blocks(domain, &seeds, &options).map_err(|e| e.to_string());
    }
    let joints = joints::discontinuities(rock, folder)?;
    // The number of blocks is known only while rock is cut, since spacings scatter.
    let most_blocks = admit::most_blocks(CutOptions::default().most_blocks);
    let options = CutOptions { seed: rock.seed, sliver_width_m: rock.sliver_width_m, most_blocks };
    cut_blocks(domain, &joints, &options).map_err(|e| e.to_string())
}
