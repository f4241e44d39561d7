//! Problems of a mesh, with the ids of its faulty parts.

pub(crate) use coincident::first_twins;

mod coincident;
mod problem;
mod topology;

pub use problem::{Found, MeshError, MeshProblem};

use crate::geometry::{Aabb, TET_FACES, tet_volume, triangle_area_vector};
use crate::{BlockMesh, Vec3};

/// Least height of a tetrahedron over its longest edge: below it the sign of the volume is rounding.
///
/// Rounding moves a computed height by a few 2⁻⁵³ of the longest edge; the usual rest is margin for the rounding
/// of coordinates in a block of some thousand elements per side. Elements that thin spoil the conditioning anyway.
const LEAST_HEIGHT_RATIO: f64 = 1e-12;

/// Nodes closer than this fraction of the block's diagonal are the same node, written twice.
const COINCIDENT_RATIO: f64 = 1e-9;

/// Most tetrahedra of one block: four faces of each must be countable in 32 bits.
pub(crate) const MAX_TETS: usize = u32::MAX as usize / 4;

/// All defects of a block; empty when it can be computed with.
///
/// A defect that makes later checks meaningless ends the list: after an index out of range nothing is known
/// of the shape; after a coordinate that is not finite only the topology is looked at; after a repeated node or
/// a duplicate tetrahedron the faces are not; after an inverted or flat one the sides of faces are not.
pub fn problems(mesh: &BlockMesh) -> Vec<MeshProblem> {
    if mesh.tets.is_empty() {
        return vec![MeshProblem::Empty { nodes: mesh.nodes.len() }];
    }
    if mesh.nodes.len() > u32::MAX as usize || mesh.tets.len() > MAX_TETS {
        return vec![MeshProblem::TooLarge { nodes: mesh.nodes.len(), tets: mesh.tets.len() }];
    }
    let mut problems = set_problems(mesh);
    let not_finite: Found<u32> =
        ids(&mesh.nodes).filter(|(_, x)| !x.iter().all(|c| c.is_finite())).map(|(i, _)| i).collect();
    let node_count = mesh.nodes.len() as u32;
    let out_of_range: Found<(u32, u32)> = ids(&mesh.tets)
        .filter_map(|(id, tet)| tet.iter().find(|&&node| node >= node_count).map(|&node| (id, node)))
        .collect();
    let finite = not_finite.is_empty();
    let in_range = out_of_range.is_empty();
    push(&mut problems, not_finite, MeshProblem::NotFinite);
    push(&mut problems, out_of_range, |tets| MeshProblem::NoSuchNode { tets, node_count });
    if !in_range {
        return problems;
    }
    let shape = if finite { shape_problems(mesh) } else { Vec::new() };
    let all_positive =
        finite && !shape.iter().any(|p| matches!(p, MeshProblem::Inverted(_) | MeshProblem::Flat(_)));
    problems.extend(shape);
    problems.extend(topology::problems(mesh, all_positive));
    problems
}

/// Elements with their ids.
fn ids<T>(items: &[T]) -> impl Iterator<Item = (u32, &T)> {
    (0..).zip(items)
}

/// Adds a problem if anything was found.
fn push<T>(problems: &mut Vec<MeshProblem>, found: Found<T>, problem: impl FnOnce(Found<T>) -> MeshProblem) {
    if !found.is_empty() {
        problems.push(problem(found));
    }
}

fn set_problems(mesh: &BlockMesh) -> Vec<MeshProblem> {
    let node_count = mesh.nodes.len() as u32;
    let mut problems = Vec::new();
    for (name, set) in &mesh.node_sets {
        let nodes: Found<u32> = set.iter().copied().filter(|&node| node >= node_count).collect();
        push(&mut problems, nodes, |nodes| MeshProblem::SetOutOfRange {
            set: name.clone(),
            nodes,
            node_count,
        });
    }
    problems
}

/// Problems of volumes and distances; indices are in range and coordinates finite.
fn shape_problems(mesh: &BlockMesh) -> Vec<MeshProblem> {
    let bounds = Aabb::around(&mesh.nodes);
    let farthest_m = bounds.min.amax().max(bounds.max.amax());
    let mut inverted = Found::default();
    let mut flat = Found::default();
    for (id, tet) in ids(&mesh.tets).filter(|(_, tet)| !repeats_a_node(tet)) {
        let corners = tet.map(|node| mesh.nodes[node as usize]);
        let volume_m3 = tet_volume(&corners);
        if is_flat(&corners, volume_m3, farthest_m) {
            flat.add((id, volume_m3));
        } else if volume_m3 < 0.0 {
            inverted.add((id, volume_m3));
        }
    }
    let mut problems = Vec::new();
    push(&mut problems, inverted, MeshProblem::Inverted);
    push(&mut problems, flat, MeshProblem::Flat);
    let tolerance_m = COINCIDENT_RATIO * bounds.diagonal();
    let pairs = coincident::pairs(&mesh.nodes, tolerance_m);
    push(&mut problems, pairs, |pairs| MeshProblem::Coincident { pairs, tolerance_m });
    problems
}

/// Whether the smallest height, 3 V / A_max, is lost in rounding: of edges, or of coordinates far from the origin.
fn is_flat(corners: &[Vec3; 4], volume_m3: f64, farthest_m: f64) -> bool {
    let area_m2 = TET_FACES
        .map(|face| triangle_area_vector(&face.map(|i| corners[i])).norm())
        .into_iter()
        .fold(0.0, f64::max);
    let least_m = (LEAST_HEIGHT_RATIO * longest_edge(corners)).max(4.0 * f64::EPSILON * farthest_m);
    3.0 * volume_m3.abs() <= least_m * area_m2 || !volume_m3.is_finite()
}

/// Length of the longest of the six edges [m].
pub(crate) fn longest_edge(corners: &[Vec3; 4]) -> f64 {
    let edges = (0..4).flat_map(|i| (0..i).map(move |j| (i, j)));
    edges.map(|(i, j)| (corners[i] - corners[j]).norm()).fold(0.0, f64::max)
}

fn repeats_a_node(tet: &[u32; 4]) -> bool {
    (0..4).any(|i| (0..i).any(|j| tet[i] == tet[j]))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::generate::{BoxPattern, box_block};

    fn cube() -> BlockMesh {
        box_block([1.0; 3], [2; 3], BoxPattern::Six).unwrap()
    }

    fn found<T>(items: impl IntoIterator<Item = T>) -> Found<T> {
        items.into_iter().collect()
    }

    #[test]
    fn a_generated_cube_has_no_problems() {
        assert_eq!(problems(&cube()), vec![]);
    }

    #[test]
    fn a_block_without_tetrahedra_is_empty() {
        let mesh = BlockMesh { nodes: vec![Vec3::zeros()], ..BlockMesh::default() };
        assert_eq!(problems(&mesh), vec![MeshProblem::Empty { nodes: 1 }]);
    }

    #[test]
    fn coordinates_that_are_not_finite_are_listed_and_the_shape_is_left_alone() {
        let mut mesh = cube();
        mesh.nodes[3].y = f64::NAN;
        mesh.nodes[5].z = f64::INFINITY;
        assert_eq!(problems(&mesh), vec![MeshProblem::NotFinite(found([3, 5]))]);
    }

    #[test]
    fn an_index_out_of_range_hides_all_later_checks() {
        let mut mesh = cube();
        mesh.tets[7][2] = 27;
        mesh.tets[9].swap(0, 1);
        let expected = MeshProblem::NoSuchNode { tets: found([(7, 27)]), node_count: 27 };
        assert_eq!(problems(&mesh), vec![expected]);
    }

    #[test]
    fn a_node_set_out_of_range_is_named() {
        let mut mesh = cube();
        mesh.node_sets.insert("top".into(), vec![1, 27, 99]);
        let expected =
            MeshProblem::SetOutOfRange { set: "top".into(), nodes: found([27, 99]), node_count: 27 };
        assert_eq!(problems(&mesh), vec![expected]);
    }

    #[test]
    fn inverted_tetrahedra_are_listed_with_their_volumes() {
        let mut mesh = cube();
        mesh.tets[4].swap(0, 1);
        let [MeshProblem::Inverted(inverted)] = &problems(&mesh)[..] else { panic!() };
        assert_eq!(inverted.first.len(), 1);
        assert_eq!(inverted.first[0].0, 4);
        assert!((inverted.first[0].1 + 1.0 / 48.0).abs() < 1e-15);
    }

    #[test]
    fn flat_is_relative_to_the_size_of_the_tetrahedron() {
        for size in [1e-6, 1.0, 1e6] {
            let tet = |height: f64| {
                let nodes = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.3, 0.3, height]];
                let nodes = nodes.map(|x| Vec3::from(x) * size).to_vec();
                BlockMesh { nodes, tets: vec![[0, 1, 2, 3]], ..BlockMesh::default() }
            };
            assert!(matches!(problems(&tet(1e-13))[..], [MeshProblem::Flat(_)]));
            assert!(matches!(problems(&tet(-1e-13))[..], [MeshProblem::Flat(_)]));
            assert_eq!(problems(&tet(1e-6)), vec![]);
        }
    }

    #[test]
    fn a_height_within_the_rounding_of_map_coordinates_is_flat() {
        let tet = |height: f64| {
            let nodes = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.3, 0.3, height]];
            let nodes = nodes.map(|x| Vec3::from(x) + Vec3::repeat(4.5e6)).to_vec();
            BlockMesh { nodes, tets: vec![[0, 1, 2, 3]], ..BlockMesh::default() }
        };
        assert!(matches!(problems(&tet(1e-9))[..], [MeshProblem::Flat(_)]));
        assert_eq!(problems(&tet(1e-6)), vec![]);
    }

    #[test]
    fn needles_with_an_aspect_of_a_million_are_accepted() {
        let mesh = box_block([1e6, 1.0, 1.0], [1; 3], BoxPattern::Six).unwrap();
        assert_eq!(problems(&mesh), vec![]);
    }

    #[test]
    fn nodes_written_twice_are_paired() {
        let mut mesh = cube();
        let twin = mesh.nodes[0] + Vec3::repeat(1e-12);
        mesh.nodes.push(twin);
        let old = mesh.tets.iter().position(|tet| tet.contains(&0)).unwrap();
        mesh.tets[old] = mesh.tets[old].map(|node| if node == 0 { 27 } else { node });
        assert!(
            problems(&mesh)
                .iter()
                .any(|p| matches!(p, MeshProblem::Coincident { pairs, .. } if pairs.first == vec![(0, 27)]))
        );
    }

    #[test]
    fn only_the_first_ten_ids_are_kept_but_all_are_counted() {
        let mut mesh = cube();
        mesh.tets.iter_mut().for_each(|tet| tet.swap(0, 1));
        let [MeshProblem::Inverted(inverted)] = &problems(&mesh)[..] else { panic!() };
        assert_eq!((inverted.count, inverted.first.len()), (48, 10));
    }

    proptest! {
        #[test]
        fn no_mesh_panics(
            nodes in prop::collection::vec(prop::array::uniform3(prop_oneof![-2.0..2.0f64, any::<f64>()]), 0..8),
            tets in prop::collection::vec(prop::array::uniform4(prop_oneof![0..8u32, any::<u32>()]), 0..8),
            set in prop::collection::vec(any::<u32>(), 0..3),
        ) {
            let nodes = nodes.into_iter().map(Vec3::from).collect();
            let mesh = BlockMesh { nodes, tets, node_sets: [("a".to_string(), set)].into(), ..BlockMesh::default() };
            for problem in problems(&mesh) {
                prop_assert!(!problem.to_string().is_empty());
            }
        }
    }
}
