//! Common parts of the tests of results.

use ndda_mesh::{BlockMesh, BlockSet, Vec3};

/// A block of one tetrahedron.
pub(crate) fn one_tet() -> BlockSet {
    let nodes = vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
    let mesh = BlockMesh { nodes, tets: vec![[0, 1, 2, 3]], ..BlockMesh::default() };
    BlockSet::new(vec![("a".into(), mesh)]).unwrap()
}
