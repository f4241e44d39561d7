//! The tetrahedra of a block as blocks of their own.

use std::collections::{BTreeMap, HashMap};

use crate::geometry::TET_FACES;
use crate::{BlockMesh, Vec3};

/// Name of the faces between the tetrahedra that a block is taken apart into.
pub const TETRAHEDRA: &str = "tetrahedra";

/// Each tetrahedron of a mesh as a mesh of its own, in their order. Faces on the boundary keep the names that they have; those between two tetrahedra are
/// named [`TETRAHEDRA`]. Nodes keep the sets that they are in.
pub fn taken_apart(mesh: &BlockMesh) -> Vec<BlockMesh> {
    let mut names: HashMap<[u32; 3], &str> = HashMap::new();
    for (name, triangles) in &mesh.surfaces {
        names.extend(triangles.iter().map(|&triangle| (triangle, name.as_str())));
    }
    let mut seen: HashMap<[u32; 3], u32> = HashMap::new();
    for tet in &mesh.tets {
        TET_FACES
            .iter()
            .for_each(|face| *seen.entry(sorted(face.map(|corner| tet[corner]))).or_default() += 1);
    }
    let name_of = |face: [u32; 3]| match seen[&face] {
        1 => names.get(&face).copied(),
        _ => Some(TETRAHEDRA),
    };
    mesh.tets.iter().map(|tet| alone(mesh, tet, name_of)).collect()
}

/// One tetrahedron, whose faces have these names.
fn alone<'a>(mesh: &BlockMesh, tet: &[u32; 4], name_of: impl Fn([u32; 3]) -> Option<&'a str>) -> BlockMesh {
    let nodes: Vec<Vec3> = tet.iter().map(|&node| mesh.nodes[node as usize]).collect();
    let mut node_sets: BTreeMap<String, Vec<u32>> = BTreeMap::new();
    for (name, set) in &mesh.node_sets {
        let own: Vec<u32> = (0..4).filter(|&k| set.binary_search(&tet[k as usize]).is_ok()).collect();
        if !own.is_empty() {
            node_sets.insert(name.clone(), own);
        }
    }
    let mut surfaces: BTreeMap<String, Vec<[u32; 3]>> = BTreeMap::new();
    for face in TET_FACES {
        let Some(name) = name_of(sorted(face.map(|corner| tet[corner]))) else { continue };
        let own = sorted(face.map(|corner| corner as u32));
        surfaces.entry(name.to_string()).or_default().push(own);
        if name == TETRAHEDRA {
            let set = node_sets.entry(name.to_string()).or_default();
            set.extend(own);
            set.sort_unstable();
            set.dedup();
        }
    }
    BlockMesh { nodes, tets: vec![[0, 1, 2, 3]], node_sets, surfaces }
}

fn sorted(mut face: [u32; 3]) -> [u32; 3] {
    face.sort_unstable();
    face
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cut::{CutOptions, Domain, cut_blocks};
    use crate::geometry::{tet_volume, triangle_area_vector};
    use crate::tetrahedralise::Fill;

    #[test]
    fn a_cube_comes_apart_into_tetrahedra_that_fill_it_and_keep_the_names_of_its_faces() {
        let cube = Domain::cuboid(Vec3::zeros(), Vec3::repeat(1.0)).unwrap();
        let blocks = cut_blocks(&cube, &[], &CutOptions::default()).unwrap();
        let mesh = blocks.mesh(0, &Fill::Size { size_m: 0.4, finer: Vec::new() }).unwrap();
        let pieces = taken_apart(&mesh);
        assert_eq!(pieces.len(), mesh.tets.len());
        let (mut volume_m3, mut areas_m2) = (0.0, BTreeMap::<&str, f64>::new());
        for piece in &pieces {
            let corners = |face: &[u32; 3]| face.map(|node| piece.nodes[node as usize]);
            volume_m3 += tet_volume(&[0, 1, 2, 3].map(|k| piece.nodes[k]));
            assert_eq!(piece.surfaces.values().map(Vec::len).sum::<usize>(), 4);
            for (name, faces) in &piece.surfaces {
                let area: f64 = faces.iter().map(|face| triangle_area_vector(&corners(face)).norm()).sum();
                *areas_m2.entry(name).or_default() += area;
            }
        }
        assert!((volume_m3 - 1.0).abs() < 1e-12);
        let inside = areas_m2.remove(TETRAHEDRA).unwrap();
        assert!(inside > 6.0, "{inside}");
        assert_eq!(areas_m2.len(), 6);
        assert!(areas_m2.values().all(|area| (area - 1.0).abs() < 1e-12), "{areas_m2:?}");
    }
}
