//! What can be wrong with a mesh, with the ids of what is wrong.

use crate::BlockMesh;

/// One kind of defect in one block.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshProblem {
    /// The block has no tetrahedra.
    #[error("has no tetrahedra")]
    Empty,
}

/// Everything that is wrong with the blocks of a scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{} mesh problem(s)", problems.len())]
pub struct MeshError {
    /// Name of the block and what is wrong with it.
    pub problems: Vec<(String, MeshProblem)>,
}

/// All defects of a block; empty when it can be computed with.
pub fn problems(mesh: &BlockMesh) -> Vec<MeshProblem> {
    let mut found = Vec::new();
    if mesh.tets.is_empty() {
        found.push(MeshProblem::Empty);
    }
    found
}
