//! The outward boundary of a block: faces that belong to one tetrahedron only.

use crate::geometry::TET_FACES;

/// A boundary face: its corners in outward order and the tetrahedron behind it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoundaryFace {
    /// Node indices, counter-clockwise seen from outside.
    pub nodes: [u32; 3],
    /// The tetrahedron that the face bounds.
    pub tet: u32,
}

/// The faces of `tets` that occur once, ordered by tetrahedron and local face.
pub fn boundary_faces(tets: &[[u32; 4]]) -> Vec<BoundaryFace> {
    let mut keys: Vec<([u32; 3], u32)> = Vec::with_capacity(4 * tets.len());
    for (tet, corners) in tets.iter().enumerate() {
        for (local, face) in TET_FACES.iter().enumerate() {
            let mut key = face.map(|i| corners[i]);
            key.sort_unstable();
            keys.push((key, (4 * tet + local) as u32));
        }
    }
    keys.sort_unstable();
    let mut faces: Vec<u32> =
        keys.chunk_by(|a, b| a.0 == b.0).filter(|run| run.len() == 1).map(|run| run[0].1).collect();
    faces.sort_unstable();
    faces
        .into_iter()
        .map(|face| {
            let (tet, local) = (face / 4, face % 4);
            let nodes = TET_FACES[local as usize].map(|i| tets[tet as usize][i]);
            BoundaryFace { nodes, tet }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_tetrahedra_that_share_a_face_have_six_boundary_faces() {
        let faces = boundary_faces(&[[0, 1, 2, 3], [1, 2, 3, 4]]);
        assert_eq!(faces.len(), 6);
        assert!(faces.iter().all(|f| {
            let mut nodes = f.nodes;
            nodes.sort_unstable();
            nodes != [1, 2, 3]
        }));
    }
}
