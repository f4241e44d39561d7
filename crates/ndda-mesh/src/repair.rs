//! Repairs that a user requests by name; each says what it did. Nothing here runs by itself.

use crate::geometry::{Aabb, tet_volume};
use crate::validate::first_twins;
use crate::{BlockMesh, Vec3};

/// Changes made by [`orient`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Oriented {
    /// Tetrahedra whose last two nodes were exchanged.
    pub flipped: Vec<u32>,
}

/// Exchanges the last two nodes of tetrahedra with negative volume. Those that name missing nodes are left alone.
pub fn orient(mesh: &mut BlockMesh) -> Oriented {
    let mut done = Oriented::default();
    for (id, tet) in (0..).zip(&mut mesh.tets) {
        let corners =
            tet.map(|node| mesh.nodes.get(node as usize).copied().unwrap_or(Vec3::repeat(f64::NAN)));
        if tet_volume(&corners) < 0.0 {
            tet.swap(2, 3);
            done.flipped.push(id);
        }
    }
    done
}

/// Changes made by [`merge`]; ids are those from before.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Merged {
    /// Each node that went, after the one that stands for it.
    pub nodes: Vec<(u32, u32)>,
    /// Tetrahedra that lost their volume, as two of their nodes became one.
    pub dropped_tets: Vec<u32>,
    /// Distance within which nodes were merged [m].
    pub tolerance_m: f64,
}

/// Why nodes cannot be merged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MergeError {
    /// The tolerance is no fraction.
    #[error("the relative tolerance is {0:?}: give at least 0 and less than 1, usually 1e-9 to 1e-4")]
    Tolerance(f64),
    /// A tetrahedron names a node that does not exist.
    #[error("tetrahedron {tet} names node {node}, but there are {nodes} nodes: repair the file first")]
    NoSuchNode {
        /// Index of the tetrahedron.
        tet: usize,
        /// The node that it names.
        node: u32,
        /// Number of nodes.
        nodes: usize,
    },
    /// A coordinate is not finite.
    #[error("node {0} has a coordinate that is not finite: repair the file first")]
    NotFinite(usize),
}

/// Merges nodes nearer to each other than `relative_tolerance` of the mesh's diagonal into the first of them.
///
/// Tetrahedra that two merged nodes belonged to are dropped; node sets and surfaces follow. Nodes are compared with the kept ones
/// only, so that a chain of near nodes does not shrink to one.
///
/// # Errors
/// [`MergeError`] when the tolerance is no fraction, a node is missing or a coordinate not finite; the mesh is then
/// as it was.
pub fn merge(mesh: &mut BlockMesh, relative_tolerance: f64) -> Result<Merged, MergeError> {
    if !(0.0..1.0).contains(&relative_tolerance) {
        return Err(MergeError::Tolerance(relative_tolerance));
    }
    let nodes = mesh.nodes.len();
    if let Some(bad) = mesh.nodes.iter().position(|x| !x.iter().all(|c| c.is_finite())) {
        return Err(MergeError::NotFinite(bad));
    }
    for (tet, corners) in mesh.tets.iter().enumerate() {
        if let Some(&node) = corners.iter().find(|&&node| node as usize >= nodes) {
            return Err(MergeError::NoSuchNode { tet, node, nodes });
        }
    }
    let tolerance_m = relative_tolerance * Aabb::around(&mesh.nodes).diagonal();
    let mut done = Merged { tolerance_m, ..Merged::default() };
    let twins = first_twins(&mesh.nodes, tolerance_m);
    let mut index = Vec::with_capacity(nodes);
    let mut kept = Vec::new();
    for (node, (twin, x)) in (0..).zip(twins.iter().zip(&mesh.nodes)) {
        match twin {
            Some(first) => {
                done.nodes.push((*first, node));
                index.push(index[*first as usize]);
            }
            None => {
                index.push(kept.len() as u32);
                kept.push(*x);
            }
        }
    }
    mesh.nodes = kept;
    let mut tets = Vec::with_capacity(mesh.tets.len());
    for (id, tet) in (0..).zip(&mesh.tets) {
        let tet = tet.map(|node| index[node as usize]);
        if (0..4).any(|i| tet[..i].contains(&tet[i])) {
            done.dropped_tets.push(id);
        } else {
            tets.push(tet);
        }
    }
    mesh.tets = tets;
    for set in mesh.node_sets.values_mut() {
        set.iter_mut().for_each(|node| *node = index.get(*node as usize).copied().unwrap_or(*node));
        set.sort_unstable();
        set.dedup();
    }
    for surface in mesh.surfaces.values_mut() {
        for triangle in surface.iter_mut() {
            *triangle = triangle.map(|node| index.get(node as usize).copied().unwrap_or(node));
            triangle.sort_unstable();
        }
        surface.retain(|[a, b, c]| a != b && b != c);
    }
    Ok(done)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{BoxPattern, box_block};
    use crate::validate::problems;

    fn cube() -> BlockMesh {
        box_block([1.0; 3], [2; 3], BoxPattern::Six).unwrap()
    }

    #[test]
    fn inverted_tetrahedra_are_flipped_and_named() {
        let mut mesh = cube();
        mesh.tets[4].swap(0, 1);
        mesh.tets[9].swap(1, 3);
        mesh.tets.push([0, 1, 2, 99]);
        assert_eq!(orient(&mut mesh).flipped, [4, 9]);
        mesh.tets.pop();
        assert_eq!(problems(&mesh), vec![]);
        assert_eq!(orient(&mut mesh), Oriented::default());
    }

    #[test]
    fn a_mesh_of_loose_tetrahedra_becomes_the_one_that_it_was() {
        let whole = cube();
        let mut loose = BlockMesh::default();
        for tet in &whole.tets {
            let first = loose.nodes.len() as u32;
            loose.nodes.extend(tet.map(|node| whole.nodes[node as usize]));
            loose.tets.push([0, 1, 2, 3].map(|i| first + i));
        }
        let on_side = (0..).zip(&loose.nodes).filter(|(_, x)| x.x == 0.0).map(|(i, _)| i).collect();
        loose.node_sets.insert("side".into(), on_side);
        let done = merge(&mut loose, 1e-9).unwrap();
        assert_eq!((loose.nodes.len(), loose.node_sets["side"].len()), (27, 9));
        assert_eq!(done.nodes.len(), 4 * 48 - 27);
        assert!(done.dropped_tets.is_empty());
        assert_eq!(problems(&loose), vec![]);
    }

    #[test]
    fn tetrahedra_without_volume_go_and_are_named() {
        let mut mesh = cube();
        let copy = mesh.nodes[0] + Vec3::repeat(1e-9);
        mesh.nodes.push(copy);
        mesh.tets.push([0, 27, 1, 3]);
        let done = merge(&mut mesh, 1e-6).unwrap();
        assert_eq!((done.nodes, done.dropped_tets), (vec![(0, 27)], vec![48]));
        assert_eq!(mesh, cube());
    }

    #[test]
    fn what_cannot_be_merged_is_named_and_left_alone() {
        let mut mesh = cube();
        assert_eq!(merge(&mut mesh, 1.0), Err(MergeError::Tolerance(1.0)));
        assert!(matches!(merge(&mut mesh, f64::NAN), Err(MergeError::Tolerance(_))));
        mesh.tets[3][1] = 27;
        assert_eq!(merge(&mut mesh, 0.0), Err(MergeError::NoSuchNode { tet: 3, node: 27, nodes: 27 }));
        mesh.nodes[5].y = f64::INFINITY;
        assert_eq!(merge(&mut mesh, 0.0), Err(MergeError::NotFinite(5)));
        assert_eq!(merge(&mut BlockMesh::default(), 0.1).unwrap().nodes, vec![]);
    }
}
