//! Vertices too close to distinguish become one.

use crate::cut::{Face, Polyhedron};

/// A polyhedron without short edges.
pub(super) struct Welded {
    pub block: Polyhedron,
    /// The face of the original behind each face.
    pub old_face: Vec<usize>,
}

/// Joins vertices along edges shorter than `least_m`; faces that lose their area go. `None` if no solid is left.
pub(super) fn weld(block: &Polyhedron, least_m: f64) -> Option<Welded> {
    let mut same: Vec<u32> = (0..block.vertices.len() as u32).collect();
    for face in &block.faces {
        let ring = &face.vertices;
        for (i, &a) in ring.iter().enumerate() {
            let b = ring[(i + 1) % ring.len()];
            if (block.vertices[a as usize] - block.vertices[b as usize]).norm() < least_m {
                let (from, to) =
                    (same[a as usize].max(same[b as usize]), same[a as usize].min(same[b as usize]));
                same.iter_mut().filter(|s| **s == from).for_each(|s| *s = to);
            }
        }
    }
    let mut rings: Vec<Vec<u32>> =
        block.faces.iter().map(|face| face.vertices.iter().map(|&v| same[v as usize]).collect()).collect();
    tidy(&mut rings, block.vertices.len());
    let (mut faces, mut old_face) = (Vec::new(), Vec::new());
    let mut index = vec![u32::MAX; same.len()];
    let mut vertices = Vec::new();
    for (old, mut ring) in rings.into_iter().enumerate().filter(|(_, ring)| !ring.is_empty()) {
        for vertex in &mut ring {
            let from = *vertex as usize;
            if index[from] == u32::MAX {
                index[from] = vertices.len() as u32;
                vertices.push(block.vertices[from]);
            }
            *vertex = index[from];
        }
        faces.push(Face { vertices: ring, surface: block.faces[old].surface });
        old_face.push(old);
    }
    let block = Polyhedron { vertices, faces };
    let repeats = |ring: &[u32]| (1..ring.len()).any(|i| ring[..i].contains(&ring[i]));
    let sound = block.euler() == Some(2) && !block.faces.iter().any(|face| repeats(&face.vertices));
    sound.then_some(Welded { block, old_face })
}

/// Empties rings that enclose nothing, and takes out vertices of two faces only: they lie on the edge between those.
fn tidy(rings: &mut [Vec<u32>], vertices: usize) {
    loop {
        let mut degree = vec![0; vertices];
        for ring in rings.iter_mut() {
            ring.dedup();
            if ring.len() > 1 && ring.first() == ring.last() {
                ring.pop();
            }
            if ring.len() < 3 {
                ring.clear();
            }
            ring.iter().for_each(|&v| degree[v as usize] += 1);
        }
        if rings.iter().flatten().all(|&v| degree[v as usize] > 2) {
            return;
        }
        rings.iter_mut().for_each(|ring| ring.retain(|&v| degree[v as usize] > 2));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;

    #[test]
    fn a_chamfer_too_small_to_see_is_gone_with_its_face() {
        let cube = Polyhedron::cuboid(Vec3::zeros(), Vec3::repeat(1.0));
        assert_eq!(weld(&cube, 0.1).unwrap().block.faces.len(), 6);
        let plane = crate::cut::Plane::new(Vec3::repeat(1.0 - 1e-6), Vec3::new(1.0, 1.0, 1.0)).unwrap();
        let tolerance = crate::cut::Tolerance { on_plane_m: 1e-13, least_depth_m: 1e-9 };
        let crate::cut::Split::Both { below, .. } = crate::cut::split(&cube, &plane, 6, tolerance) else {
            panic!()
        };
        assert_eq!(below.faces.len(), 7);
        let welded = weld(&below, 1e-5).unwrap();
        assert_eq!((welded.block.faces.len(), welded.block.vertices.len()), (6, 8));
        assert!(weld(&cube, 2.0).is_none());
    }
}
