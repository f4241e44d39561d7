//! How tetrahedra hang together; indices are in range.

use super::{Found, MeshProblem, ids, push, repeats_a_node};
use crate::BlockMesh;
use crate::geometry::TET_FACES;

/// A face of a tetrahedron under its sorted nodes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Face {
    nodes: [u32; 3],
    tet: u32,
    /// Whether sorting kept the outward sense; differs between two tetrahedra on either side.
    outward: bool,
}

/// Problems of the topology of `mesh`; `all_positive` says that every volume is.
pub(super) fn problems(mesh: &BlockMesh, all_positive: bool) -> Vec<MeshProblem> {
    let mut problems = Vec::new();
    let mut is_used = vec![false; mesh.nodes.len()];
    mesh.tets.iter().flatten().for_each(|&node| is_used[node as usize] = true);
    let orphans = ids(&is_used).filter(|(_, used)| !**used).map(|(id, _)| id).collect();
    let repeated: Found<u32> =
        ids(&mesh.tets).filter(|(_, tet)| repeats_a_node(tet)).map(|(id, _)| id).collect();
    let duplicates = duplicate_tets(&mesh.tets);
    let faces_mean_something = repeated.is_empty() && duplicates.is_empty();
    push(&mut problems, orphans, MeshProblem::Orphans);
    push(&mut problems, repeated, MeshProblem::RepeatedNode);
    push(&mut problems, duplicates, MeshProblem::DuplicateTets);
    if faces_mean_something {
        problems.extend(face_problems(&mesh.tets, all_positive));
    }
    problems
}

/// Each tetrahedron with the nodes of an earlier one, after that one.
fn duplicate_tets(tets: &[[u32; 4]]) -> Found<(u32, u32)> {
    let mut keys: Vec<([u32; 4], u32)> = ids(tets)
        .map(|(id, tet)| {
            let mut key = *tet;
            key.sort_unstable();
            (key, id)
        })
        .collect();
    keys.sort_unstable();
    let mut pairs: Vec<(u32, u32)> = keys
        .chunk_by(|a, b| a.0 == b.0)
        .flat_map(|same| same[1..].iter().map(|later| (same[0].1, later.1)))
        .collect();
    pairs.sort_unstable();
    pairs.into_iter().collect()
}

fn face_problems(tets: &[[u32; 4]], all_positive: bool) -> Vec<MeshProblem> {
    let faces = sorted_faces(tets);
    let shared = || faces.chunk_by(|a, b| a.nodes == b.nodes);
    let crowded: Found<[u32; 3]> = shared().filter(|run| run.len() > 2).map(|run| run[0].nodes).collect();
    let folded = shared()
        .filter(|run| all_positive && run.len() == 2 && run[0].outward == run[1].outward)
        .map(|run| run[0].nodes)
        .collect();
    let is_closed = crowded.is_empty();
    let mut problems = Vec::new();
    push(&mut problems, crowded, MeshProblem::CrowdedFaces);
    push(&mut problems, folded, MeshProblem::Folded);
    if is_closed {
        let boundary: Vec<[u32; 3]> = shared().filter(|run| run.len() == 1).map(|run| run[0].nodes).collect();
        push(&mut problems, open_edges(&boundary), MeshProblem::OpenEdges);
    }
    let parts = parts(tets.len(), shared());
    if parts.len() > 1 {
        let largest = parts.iter().copied().take(10).collect();
        problems.push(MeshProblem::Parts { parts: parts.len(), tets: largest });
    }
    problems
}

fn sorted_faces(tets: &[[u32; 4]]) -> Vec<Face> {
    let mut faces = Vec::with_capacity(4 * tets.len());
    for (tet, corners) in ids(tets) {
        for local in TET_FACES {
            let [a, b, c] = local.map(|i| corners[i]);
            let mut nodes = [a, b, c];
            nodes.sort_unstable();
            let outward = nodes == [a, b, c] || nodes == [b, c, a] || nodes == [c, a, b];
            faces.push(Face { nodes, tet, outward });
        }
    }
    faces.sort_unstable();
    faces
}

/// Edges of the surface that do not belong to exactly two of its triangles, and to how many they do.
fn open_edges(boundary: &[[u32; 3]]) -> Found<([u32; 2], usize)> {
    // Nodes of a face are sorted, so those of its edges are too.
    let mut edges: Vec<[u32; 2]> = boundary.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [a, c]]).collect();
    edges.sort_unstable();
    edges.chunk_by(|a, b| a == b).filter(|run| run.len() != 2).map(|run| (run[0], run.len())).collect()
}

/// Numbers of tetrahedra of the parts that hang together by faces, falling.
fn parts<'a>(tets: usize, shared: impl Iterator<Item = &'a [Face]>) -> Vec<usize> {
    let mut parent: Vec<u32> = (0..tets as u32).collect();
    for run in shared {
        for face in &run[1..] {
            let (a, b) = (root(&mut parent, run[0].tet), root(&mut parent, face.tet));
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    let mut sizes = vec![0; tets];
    for tet in 0..tets as u32 {
        sizes[root(&mut parent, tet) as usize] += 1;
    }
    sizes.retain(|&size| size > 0);
    sizes.sort_unstable_by(|a, b| b.cmp(a));
    sizes
}

/// Representative of the part that `tet` is in; halves the path to it.
fn root(parent: &mut [u32], mut tet: u32) -> u32 {
    while parent[tet as usize] != tet {
        let above = parent[parent[tet as usize] as usize];
        parent[tet as usize] = above;
        tet = above;
    }
    tet
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;
    use crate::generate::{BoxPattern, box_block};

    fn mesh(nodes: usize, tets: &[[u32; 4]]) -> BlockMesh {
        BlockMesh { nodes: vec![Vec3::zeros(); nodes], tets: tets.to_vec(), ..BlockMesh::default() }
    }

    #[test]
    fn orphans_are_listed() {
        assert_eq!(
            problems(&mesh(6, &[[0, 1, 2, 4]]), true),
            vec![MeshProblem::Orphans([3, 5].into_iter().collect())]
        );
    }

    #[test]
    fn repeated_nodes_and_duplicates_hide_the_faces() {
        let found = problems(&mesh(4, &[[0, 1, 2, 3], [1, 2, 0, 3], [0, 0, 1, 2]]), true);
        assert_eq!(
            found,
            vec![
                MeshProblem::RepeatedNode([2].into_iter().collect()),
                MeshProblem::DuplicateTets([(0, 1)].into_iter().collect()),
            ]
        );
    }

    #[test]
    fn a_face_of_three_tetrahedra_is_crowded() {
        let found = problems(&mesh(6, &[[0, 1, 2, 3], [0, 2, 1, 4], [0, 1, 2, 5]]), true);
        assert_eq!(found, vec![MeshProblem::CrowdedFaces([[0, 1, 2]].into_iter().collect())]);
    }

    #[test]
    fn two_tetrahedra_on_the_same_side_of_a_face_are_folded() {
        let found = problems(&mesh(5, &[[0, 1, 2, 3], [0, 1, 2, 4]]), true);
        assert_eq!(found, vec![MeshProblem::Folded([[0, 1, 2]].into_iter().collect())]);
    }

    #[test]
    fn tetrahedra_that_share_an_edge_only_touch_themselves_and_are_two_parts() {
        let found = problems(&mesh(6, &[[0, 1, 2, 3], [0, 1, 4, 5]]), true);
        assert_eq!(
            found,
            vec![
                MeshProblem::OpenEdges([([0, 1], 4)].into_iter().collect()),
                MeshProblem::Parts { parts: 2, tets: vec![1, 1] },
            ]
        );
    }

    #[test]
    fn parts_are_counted_with_their_sizes() {
        let cube = box_block([1.0; 3], [2; 3], BoxPattern::TwentyFour).unwrap();
        let first = cube.nodes.len() as u32;
        let mut both = cube.clone();
        both.nodes.extend(cube.nodes.iter().map(|x| x.add_scalar(3.0)));
        both.tets.extend(cube.tets.iter().take(24).map(|tet| tet.map(|node| node + first)));
        let found = problems(&both, true);
        assert_eq!(found.last(), Some(&MeshProblem::Parts { parts: 2, tets: vec![192, 24] }));
    }
}
