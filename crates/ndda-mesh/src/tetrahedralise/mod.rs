//! Convex blocks filled with tetrahedra.
//!
//! The coarse fills are a fan from a vertex or a star from the centroid. The fine one starts from the star and is
//! refined in place: edges too long for the size are split, edges too short collapse, and flips and smoothing raise
//! the smallest dihedral angle, each step only if all volumes stay positive (Freitag & Ollivier-Gooch 1997). Nodes on
//! a face or edge of the block stay on it, so the surface is that of the block at any size.

mod apart;
mod glued;
mod improve;
mod pool;
mod refine;
mod size;
mod star;
mod weld;

pub use apart::{TETRAHEDRA, taken_apart};
pub use size::{Grading, Towards};

use std::collections::BTreeMap;

use crate::cut::{Blocks, Polyhedron};
use crate::surface::boundary_faces;
use crate::validate::MAX_TETS;
use crate::{BlockMesh, Vec3, validate};
use size::SizeField;
use weld::Welded;

/// How a block is filled.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Fill {
    /// As few tetrahedra as a fan from one of the vertices gives, unless they would be slivers; no interior node.
    #[default]
    Fewest,
    /// A star from one node at the centroid.
    Centre,
    /// Edges of about `size_m`, finer where `finer` says so, and down to a quarter near smaller features of the block.
    Size {
        /// Target length of edges [m].
        size_m: f64,
        /// Where to be finer.
        finer: Vec<Grading>,
    },
}

/// Why a block cannot be filled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FillError {
    /// A length is not positive and finite.
    #[error("{what} is {value:?}: give a number above 0")]
    Number {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A block that the system has not.
    #[error("there are {blocks} blocks, no block {block}: count from 0")]
    NoSuchBlock {
        /// The block requested.
        block: usize,
        /// Number of blocks.
        blocks: usize,
    },
    /// The polyhedron is not closed, not convex, or has no volume.
    #[error(
        "the polyhedron of {vertices} vertices and {faces} faces is not closed and convex at face {face}: correct this face, or split the polyhedron into convex ones"
    )]
    NotConvex {
        /// Number of vertices.
        vertices: usize,
        /// Number of faces.
        faces: usize,
        /// A face that is open, bent, or has a vertex in front of it.
        face: usize,
    },
    /// The block is too thin for tetrahedra of positive volume.
    #[error(
        "the block is {width_m:e} m thin and {length_m:e} m long, too thin to fill with tetrahedra: take it out, or unite it with a neighbour, by a larger sliver_width_m"
    )]
    TooThin {
        /// Smallest extent [m].
        width_m: f64,
        /// Diagonal of its box [m].
        length_m: f64,
    },
    /// Parts of a concave block that touch over parts of their faces.
    #[error(
        "block {block} is concave, and its {parts} parts do not meet face to face: discs, and joints of a persistence below 1, can cut only convex rock; make the rock convex, and cut the rest off by a Plane and list it in `removed`"
    )]
    NotFaceToFace {
        /// Index of the first part.
        block: usize,
        /// Number of parts.
        parts: usize,
    },
    /// The size requires more tetrahedra than can be counted or held.
    #[error(
        "edges of {size_m:e} m would need about {tets:e} tetrahedra, and at most {MOST_TETS} are possible: use a larger size"
    )]
    TooFine {
        /// Size requested [m].
        size_m: f64,
        /// Tetrahedra expected.
        tets: f64,
    },
}

/// Most tetrahedra of one block.
const MOST_TETS: usize = if MAX_TETS < 50_000_000 { MAX_TETS } else { 50_000_000 };
/// Edges shorter than this fraction of the block's diagonal become a vertex; the next is tried if one fails.
const WELD_RATIOS: [f64; 5] = [1e-8, 1e-7, 1e-6, 1e-5, 1e-4];
/// Coordinates beyond this leave the range of f64 in volumes [m].
const LARGEST_M: f64 = 1e50;
/// Faces may be bent, and the block concave, by this fraction of its diagonal.
const CONVEX_RATIO: f64 = 1e-7;

impl Blocks {
    /// Tetrahedra of one block, with a node set per name of its faces: joints, domain faces, `cells`.
    ///
    /// # Errors
    /// [`FillError`] when there is no such block, it is too thin, or the fill is no sensible one.
    pub fn mesh(&self, block: usize, fill: &Fill) -> Result<BlockMesh, FillError> {
        let blocks = self.blocks.len();
        let polyhedron = self.blocks.get(block).ok_or(FillError::NoSuchBlock { block, blocks })?;
        let names: Vec<&str> = polyhedron.faces.iter().map(|face| self.name_of(face)).collect();
        tetrahedralise(polyhedron, &names, fill)
    }
}

/// Fills a convex polyhedron. `face_names` names the node set of each face; several faces may share one, and faces
/// beyond its end are `face_i`.
///
/// Vertices joined by edges shorter than 1e-8 of the diagonal become one first. Only if features of about that size
/// still leave a tetrahedron without volume does the length grow, to 1e-4 at most; faces are met within it.
///
/// # Errors
/// [`FillError`] when the polyhedron is not closed and convex or too thin, or the fill is no sensible one.
pub fn tetrahedralise(block: &Polyhedron, face_names: &[&str], fill: &Fill) -> Result<BlockMesh, FillError> {
    check_convex(block)?;
    let length_m = block.bounds().diagonal();
    for ratio in WELD_RATIOS {
        if let Some(welded) = weld::weld(block, ratio * length_m) {
            let filled = filled(&welded, fill)?;
            let mesh = named(filled, |face| {
                let face = welded.old_face[face as usize];
                Some(face_names.get(face).map_or_else(|| format!("face_{face}"), |name| name.to_string()))
            });
            if validate::problems(&mesh).is_empty() {
                return Ok(mesh);
            }
        }
    }
    Err(FillError::TooThin { width_m: block.width_m(), length_m })
}

fn filled(welded: &Welded, fill: &Fill) -> Result<Filled, FillError> {
    match fill {
        Fill::Fewest => Ok(star::fewest(&welded.block)),
        Fill::Centre => Ok(star::centre(&welded.block)),
        Fill::Size { size_m, finer } => {
            let size = SizeField::new(&welded.block, *size_m, finer)?;
            let normals =
                welded.block.faces.iter().map(|f| welded.block.area_vector(f).normalize()).collect();
            let too_fine = |tets| FillError::TooFine { size_m: *size_m, tets: tets as f64 };
            refine::refine(normals, star::centre(&welded.block), &size).map_err(too_fine)
        }
    }
}

/// The mesh with a node set and a part of the boundary for each name of a face.
fn named(filled: Filled, name_of: impl Fn(u32) -> Option<String>) -> BlockMesh {
    let mut surfaces: BTreeMap<String, Vec<[u32; 3]>> = BTreeMap::new();
    for face in boundary_faces(&filled.tets) {
        let [a, b, c] = face.nodes.map(|node| &filled.on[node as usize]);
        let mut shared = a.iter().filter(|on| b.contains(on) && c.contains(on));
        if let Some(name) = shared.find_map(|&on| name_of(on)) {
            let mut triangle = face.nodes;
            triangle.sort_unstable();
            surfaces.entry(name).or_default().push(triangle);
        }
    }
    let mut node_sets: BTreeMap<String, Vec<u32>> = BTreeMap::new();
    for (node, faces) in (0..).zip(&filled.on) {
        for name in faces.iter().filter_map(|&face| name_of(face)) {
            let set = node_sets.entry(name).or_default();
            if set.last() != Some(&node) {
                set.push(node);
            }
        }
    }
    BlockMesh { nodes: filled.nodes, tets: filled.tets, node_sets, surfaces }
}

/// Nodes, the faces of the block that each lies on (sorted), and tetrahedra.
#[derive(Clone, Debug, Default)]
struct Filled {
    nodes: Vec<Vec3>,
    on: Vec<Vec<u32>>,
    tets: Vec<[u32; 4]>,
}

fn check_convex(block: &Polyhedron) -> Result<(), FillError> {
    let count = block.vertices.len();
    let bad = |face| FillError::NotConvex { vertices: count, faces: block.faces.len(), face };
    for (index, face) in block.faces.iter().enumerate() {
        if face.vertices.len() < 3 || face.vertices.iter().any(|&v| v as usize >= count) {
            return Err(bad(index));
        }
    }
    let in_range = block.vertices.iter().all(|x| x.amax() <= LARGEST_M && x.iter().all(|c| c.is_finite()));
    if block.euler() != Some(2) || !in_range || block.volume_m3().is_nan() || block.volume_m3() <= 0.0 {
        return Err(bad(0));
    }
    let tolerance_m = CONVEX_RATIO * block.bounds().diagonal();
    for (index, face) in block.faces.iter().enumerate() {
        let area = block.area_vector(face);
        let Some(normal) = area.try_normalize(0.0) else { continue };
        let mean = block.ring(face).sum::<Vec3>() / face.vertices.len() as f64;
        // A face narrower than the tolerance has no normal worth the name.
        let longest = block.ring(face).map(|x| (x - mean).norm()).fold(0.0, f64::max);
        if area.norm() > tolerance_m * longest
            && block
                .vertices
                .iter()
                .any(|x| normal.dot(&(x - mean)) > tolerance_m * (longest * longest / area.norm()).max(1.0))
        {
            return Err(bad(index));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
