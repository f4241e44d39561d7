//! Contract of generated meshes.

use std::collections::{BTreeMap, BTreeSet};

use crate::BlockMesh;
use crate::geometry::{TET_FACES, tet_volume, triangle_area_vector};
use crate::surface::boundary_faces;

pub(crate) fn volume(mesh: &BlockMesh) -> f64 {
    mesh.tets.iter().map(|tet| tet_volume(&tet.map(|i| mesh.nodes[i as usize]))).sum()
}

pub(crate) fn surface_area(mesh: &BlockMesh) -> f64 {
    let area = |nodes: [u32; 3]| triangle_area_vector(&nodes.map(|i| mesh.nodes[i as usize])).norm();
    boundary_faces(&mesh.tets).iter().map(|face| area(face.nodes)).sum()
}

/// Panics unless all volumes are positive, all faces belong to one or two tetrahedra, and the surface is
/// closed, outward and without holes: Euler characteristic V − E + F = 2.
pub(crate) fn check_closed_conforming(mesh: &BlockMesh) {
    let mut owners: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    for tet in &mesh.tets {
        assert!(tet_volume(&tet.map(|i| mesh.nodes[i as usize])) > 0.0);
        for face in TET_FACES {
            let mut key = face.map(|i| tet[i]);
            key.sort_unstable();
            *owners.entry(key).or_default() += 1;
        }
    }
    let faces = boundary_faces(&mesh.tets);
    assert!(owners.values().all(|&n| n <= 2));
    assert_eq!(owners.values().filter(|&&n| n == 1).count(), faces.len());
    let mut directed = BTreeSet::new();
    for face in &faces {
        for i in 0..3 {
            assert!(directed.insert((face.nodes[i], face.nodes[(i + 1) % 3])));
        }
    }
    assert!(directed.iter().all(|&(a, b)| directed.contains(&(b, a))));
    let nodes: BTreeSet<u32> = faces.iter().flat_map(|face| face.nodes).collect();
    assert_eq!(nodes.len() + faces.len(), directed.len() / 2 + 2);
}
