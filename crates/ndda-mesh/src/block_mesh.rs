//! One block before it joins a set.

use std::collections::BTreeMap;

use crate::{Mat3, Vec3};

/// One meshed block on its own: the product of a generator or an importer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BlockMesh {
    /// Node positions [m].
    pub nodes: Vec<Vec3>,
    /// Four node indices per tetrahedron, ordered so that the signed volume is positive.
    pub tets: Vec<[u32; 4]>,
    /// Named sets of node indices, sorted and without repeats.
    pub node_sets: BTreeMap<String, Vec<u32>>,
    /// Named parts of the boundary: triangles as three node indices, rising. Nodes alone do not tell: a triangle may have
    /// its corners on two joints of one name and lie on neither.
    pub surfaces: BTreeMap<String, Vec<[u32; 3]>>,
}

impl BlockMesh {
    /// The block turned by `rotation` about the origin and then moved by `shift_m`.
    pub fn placed(mut self, rotation: &Mat3, shift_m: &Vec3) -> Self {
        for node in &mut self.nodes {
            *node = rotation * *node + shift_m;
        }
        self
    }
}
