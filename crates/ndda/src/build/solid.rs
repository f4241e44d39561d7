//! Bodies under closed surfaces, and how they are filled with tetrahedra.

use std::path::Path;

use ndda_io::scene::{self, Grading};
use ndda_io::surface_file::Surface;
use ndda_mesh::BlockMesh;
use ndda_mesh::cut::{Blocks, Domain, DomainFace, cut_blocks};
use ndda_mesh::tetrahedralise::{self, Fill, Towards};

use super::vec3;
use crate::forecast::admit;

/// Part of its size by which a flat face of a surface may be bent: nothing but rounding.
pub(super) const EXACT: f64 = 0.0;
/// Tolerance for coordinates in files, which are written in single precision.
pub(super) const ROUNDED: f64 = 1e-6;

/// A surface by its corners and faces, `face_0`, `face_1`, ….
pub(super) fn of_corners(corners_m: &[[f64; 3]], faces: &[Vec<u32>]) -> Surface {
    let named =
        |(i, face): (usize, &Vec<u32>)| DomainFace { name: format!("face_{i}"), vertices: face.clone() };
    Surface {
        vertices: corners_m.iter().copied().map(vec3).collect(),
        faces: faces.iter().enumerate().map(named).collect(),
    }
}

/// A surface in a file, in metres.
pub(super) fn of_file(path: &Path, unit_m: f64) -> Result<Surface, String> {
    let mut surface = Surface::read(path, ROUNDED).map_err(|e| e.to_string())?;
    surface.vertices.iter_mut().for_each(|x| *x *= unit_m);
    Ok(surface)
}

/// The rock under a surface.
pub(super) fn domain(surface: &Surface, flat_ratio: f64) -> Result<Domain, String> {
    Domain::rounded(&surface.vertices, &surface.faces, flat_ratio).map_err(|e| e.to_string())
}

/// The body under a surface, as rock that nothing cuts.
pub(super) fn filled(surface: &Surface, flat_ratio: f64, fill: &scene::Fill) -> Result<BlockMesh, String> {
    if let scene::Fill::TetGen { size_m } = fill {
        return by_tetgen(surface, *size_m);
    }
    let domain = domain(surface, flat_ratio)?;
    admit::admit_fill(1, fill, (domain.volume_m3(), false))?;
    let blocks = cut_blocks(&domain, &[], &Default::default()).map_err(|e| e.to_string())?;
    match blocks.groups().as_slice() {
        [whole] => filled_group(&blocks, whole, fill),
        several => Err(format!("the faces bound {} bodies: give each its own block", several.len())),
    }
}

/// One block of a cut, whose parts are glued.
pub(super) fn filled_group(blocks: &Blocks, group: &[u32], fill: &scene::Fill) -> Result<BlockMesh, String> {
    let own = match fill {
        scene::Fill::Fewest => Fill::Fewest,
        scene::Fill::Centre => Fill::Centre,
        scene::Fill::Size { size_m, finer } => {
            Fill::Size { size_m: *size_m, finer: finer.iter().map(grading).collect() }
        }
        scene::Fill::TetGen { size_m } => return by_tetgen(&surface_of(blocks, group)?, *size_m),
    };
    blocks.mesh_glued(group, &own).map_err(|e| e.to_string())
}

fn grading(grading: &Grading) -> tetrahedralise::Grading {
    let towards = match grading.towards {
        scene::Towards::Point(at) => Towards::Point(vec3(at)),
        scene::Towards::Plane { point_m, normal } => {
            Towards::Plane { point_m: vec3(point_m), normal: vec3(normal) }
        }
    };
    tetrahedralise::Grading { towards, size_m: grading.size_m, growth: grading.growth }
}

/// The surface of a block of one convex part.
fn surface_of(blocks: &Blocks, group: &[u32]) -> Result<Surface, String> {
    let &[block] = group else {
        return Err("`TetGen` fills convex blocks and whole surfaces: use `Size` for this concave one".into());
    };
    let block = &blocks.blocks[block as usize];
    let named = |face: &ndda_mesh::cut::Face| DomainFace {
        name: blocks.name_of(face).to_string(),
        vertices: face.vertices.clone(),
    };
    Ok(Surface { vertices: block.vertices.clone(), faces: block.faces.iter().map(named).collect() })
}

#[cfg(feature = "tetgen")]
fn by_tetgen(surface: &Surface, size_m: f64) -> Result<BlockMesh, String> {
    ndda_io::tetgen_fill::fill(surface, size_m).map_err(|e| e.to_string())
}

#[cfg(not(feature = "tetgen"))]
fn by_tetgen(_surface: &Surface, _size_m: f64) -> Result<BlockMesh, String> {
    Err("this program was built without TetGen: use `Size`, or build it with `--features tetgen` (AGPL)"
        .into())
}
