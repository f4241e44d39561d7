//! Fills closed surfaces of any shape with TetGen, through the crate `tritet`. Feature `tetgen`.
//!
//! TetGen is under the AGPL: a program built with this feature is, too.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use ndda_mesh::geometry::tet_volume;
use ndda_mesh::{BlockMesh, Vec3};
use tritet::Tetgen;

use crate::mesh::surface_file::Surface;

/// TetGen keeps state of its own for all threads.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// Volumes of a surface and its tetrahedra that differ by less, relatively, are one.
const SAME_VOLUME: f64 = 1e-9;

/// Why a surface could not be filled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TetgenError {
    /// A size that is not positive.
    #[error("the size is {0:e}: give one above 0")]
    Size(f64),
    /// A face names a vertex that is not there, or there are too few.
    #[error("the surface has no vertex {0}: read it with ndda_io::surface_file")]
    Vertex(u32),
    /// TetGen's message.
    #[error("TetGen cannot fill the surface: {0}; check that it is closed and does not cut itself")]
    Tetgen(String),
    /// The tetrahedra do not add up to the surface.
    #[error(
        "the surface encloses a volume of {surface:e}, but its tetrahedra have {tets:e}: the surface is inside out or cuts \
         itself; turn its faces outward, or remove the crossing"
    )]
    Inconsistent {
        /// Volume under the surface [unit cubed].
        surface: f64,
        /// Volume of the tetrahedra [unit cubed].
        tets: f64,
    },
    /// TetGen made no tetrahedra.
    #[error("TetGen made no tetrahedra: check that the surface is closed")]
    Nothing,
}

/// Fills a closed surface with tetrahedra whose edges are about `size` or shorter [unit of the surface].
///
/// The largest volume is that of a regular tetrahedron of this edge, size³ / (6 √2). Names of faces become node sets
/// and surfaces.
///
/// # Errors
/// [`TetgenError`], for a surface that cuts itself for instance.
pub fn fill(surface: &Surface, size: f64) -> Result<BlockMesh, TetgenError> {
    if !(size.is_finite() && size > 0.0) {
        return Err(TetgenError::Size(size));
    }
    let count = surface.vertices.len();
    if let Some(bad) = surface.faces.iter().flat_map(|f| &f.vertices).find(|&&v| v as usize >= count) {
        return Err(TetgenError::Vertex(*bad));
    }
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let mut names: Vec<&str> = surface.faces.iter().map(|face| face.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let tetgen = run(surface, &names, size.powi(3) / (6.0 * 2f64.sqrt()));
    let tetgen = tetgen.map_err(|said| TetgenError::Tetgen(said.to_string()))?;
    if tetgen.out_ncell() == 0 {
        return Err(TetgenError::Nothing);
    }
    let mesh = block(&tetgen, &names);
    let volume = |tet: &[u32; 4]| tet_volume(&tet.map(|i| mesh.nodes[i as usize]));
    let (surface, tets) = (surface.volume(), mesh.tets.iter().map(volume).sum::<f64>());
    if (surface - tets).abs() <= SAME_VOLUME * tets {
        Ok(mesh)
    } else {
        Err(TetgenError::Inconsistent { surface, tets })
    }
}

/// The marker of a face is the index of its name, from 1.
fn run(surface: &Surface, names: &[&str], most_volume: f64) -> Result<Tetgen, &'static str> {
    let corners = surface.faces.iter().map(|face| face.vertices.len()).collect();
    let mut tetgen = Tetgen::new(surface.vertices.len(), Some(corners), None, None)?;
    for (i, x) in surface.vertices.iter().enumerate() {
        tetgen.set_point(i, 0, x.x, x.y, x.z)?;
    }
    for (i, face) in surface.faces.iter().enumerate() {
        for (m, &vertex) in face.vertices.iter().enumerate() {
            tetgen.set_facet_point(i, m, vertex as usize)?;
        }
        let marker = 1 + names.partition_point(|name| *name < face.name.as_str());
        tetgen.set_facet_marker(i, marker as i32)?;
    }
    tetgen.generate_mesh(false, false, Some(most_volume), None)?;
    Ok(tetgen)
}

/// TetGen's mesh, with the corners in our order.
fn block(tetgen: &Tetgen, names: &[&str]) -> BlockMesh {
    let at = |i: usize| Vec3::from_fn(|axis, _| tetgen.out_point(i, axis));
    let nodes: Vec<Vec3> = (0..tetgen.out_npoint()).map(at).collect();
    let tet = |i: usize| {
        let mut tet = [0, 1, 2, 3].map(|m| tetgen.out_cell_point(i, m) as u32);
        if tet_volume(&tet.map(|node| nodes[node as usize])) < 0.0 {
            tet.swap(0, 1);
        }
        tet
    };
    let tets = (0..tetgen.out_ncell()).map(tet).collect();
    let mut node_sets: BTreeMap<String, Vec<u32>> = BTreeMap::new();
    let mut surfaces: BTreeMap<String, Vec<[u32; 3]>> = BTreeMap::new();
    for i in 0..tetgen.out_n_marked_face() {
        let mut points = [0; 6];
        let (marker, _) = tetgen.out_marked_face(i, &mut points);
        let name = usize::try_from(marker - 1).ok().and_then(|index| names.get(index));
        if let Some(name) = name {
            let mut triangle = [points[0], points[1], points[2]].map(|point| point as u32);
            triangle.sort_unstable();
            node_sets.entry(name.to_string()).or_default().extend(triangle);
            surfaces.entry(name.to_string()).or_default().push(triangle);
        }
    }
    for nodes in node_sets.values_mut() {
        nodes.sort_unstable();
        nodes.dedup();
    }
    BlockMesh { nodes, tets, node_sets, surfaces }
}

#[cfg(test)]
mod tests {
    use ndda_mesh::cut::{DomainFace, Polyhedron};
    use ndda_mesh::stats::stats;
    use ndda_mesh::validate;

    use super::*;

    fn cube() -> Surface {
        let cube = Polyhedron::cuboid(Vec3::zeros(), Vec3::new(1.0, 2.0, 1.0));
        let face = |(i, face): (usize, &ndda_mesh::cut::Face)| DomainFace {
            name: if i == 4 { "floor" } else { "wall" }.into(),
            vertices: face.vertices.clone(),
        };
        Surface { faces: cube.faces.iter().enumerate().map(face).collect(), vertices: cube.vertices }
    }

    #[test]
    fn a_box_is_filled_with_sound_tetrahedra_below_the_size_and_named_sets() {
        let size = 0.3;
        let mesh = fill(&cube(), size).unwrap();
        assert_eq!(validate::problems(&mesh), vec![]);
        assert!((stats(&mesh).volume_m3 - 2.0).abs() < 1e-12);
        let largest = mesh.tets.iter().map(|tet| tet_volume(&tet.map(|i| mesh.nodes[i as usize])));
        assert!(largest.fold(0.0, f64::max) <= size.powi(3) / (6.0 * 2f64.sqrt()) * (1.0 + 1e-9));
        let floor = &mesh.node_sets["floor"];
        assert!(floor.len() >= 4 && floor.iter().all(|&node| mesh.nodes[node as usize].z == 0.0));
    }

    #[test]
    fn a_surface_that_cuts_itself_and_a_bad_size_are_refused() {
        let mut crossed = cube();
        let far = crossed.vertices[7];
        crossed.vertices[7] = -far;
        assert!(fill(&crossed, 0.5).is_err());
        assert_eq!(fill(&cube(), 0.0), Err(TetgenError::Size(0.0)));
        let mut missing = cube();
        missing.faces[0].vertices[0] = 99;
        assert_eq!(fill(&missing, 0.5), Err(TetgenError::Vertex(99)));
    }
}
