//! Indices that cannot be mistaken for each other.

use serde::{Deserialize, Serialize};

/// Index of a block in a [`BlockSet`](crate::BlockSet).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct BlockId(pub u32);

/// Index of a node; blocks never share nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct NodeId(pub u32);

/// Index of a tetrahedron.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct TetId(pub u32);

/// Index of a boundary triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct TriangleId(pub u32);

impl BlockId {
    /// The index into per-block arrays.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl NodeId {
    /// The index into per-node arrays.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl TetId {
    /// The index into per-tetrahedron arrays.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl TriangleId {
    /// The index into per-triangle arrays.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}
