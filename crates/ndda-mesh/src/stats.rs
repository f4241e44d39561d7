//! Statistics of a mesh.

use crate::BlockMesh;
use crate::geometry::{tet_heights, tet_volume};
use crate::surface::boundary_faces;
use crate::validate::longest_edge;

/// Counts and sizes of one block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshStats {
    /// Number of nodes.
    pub nodes: usize,
    /// Number of tetrahedra.
    pub tets: usize,
    /// Number of boundary triangles.
    pub triangles: usize,
    /// Volume of the block [m³].
    pub volume_m3: f64,
    /// Smallest height of a tetrahedron over one of its faces [m]; infinite without tetrahedra.
    pub smallest_height_m: f64,
    /// Longest edge of a tetrahedron [m].
    pub largest_edge_m: f64,
}

/// Counts and sizes of a mesh in which [`problems`](crate::validate::problems) found nothing.
///
/// # Panics
/// If a tetrahedron names a node that does not exist.
pub fn stats(mesh: &BlockMesh) -> MeshStats {
    let mut stats = MeshStats {
        nodes: mesh.nodes.len(),
        tets: mesh.tets.len(),
        triangles: boundary_faces(&mesh.tets).len(),
        volume_m3: 0.0,
        smallest_height_m: f64::INFINITY,
        largest_edge_m: 0.0,
    };
    for tet in &mesh.tets {
        let corners = tet.map(|node| mesh.nodes[node as usize]);
        stats.volume_m3 += tet_volume(&corners);
        stats.smallest_height_m = tet_heights(&corners).into_iter().fold(stats.smallest_height_m, f64::min);
        stats.largest_edge_m = stats.largest_edge_m.max(longest_edge(&corners));
    }
    stats
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{BoxPattern, box_block};

    #[test]
    fn a_unit_cube_in_six_has_the_numbers_of_its_geometry() {
        let stats = stats(&box_block([1.0; 3], [1; 3], BoxPattern::Six).unwrap());
        assert_eq!((stats.nodes, stats.tets, stats.triangles), (8, 6, 12));
        assert!((stats.volume_m3 - 1.0).abs() < 1e-15);
        assert!((stats.smallest_height_m - 0.5f64.sqrt()).abs() < 1e-15);
        assert_eq!(stats.largest_edge_m, 3f64.sqrt());
    }
}
