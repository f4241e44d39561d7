//! A file's nodes, tetrahedra and sets, and their split into bodies with nodes of their own.

use std::collections::BTreeMap;

use ndda_mesh::{BlockMesh, Vec3};

use super::error::{Fault, FileProblem};

/// Name of the body of a file that names none.
pub(crate) const ONLY_BODY: &str = "body";

/// Content of a file before it is split into bodies. All indices are checked by the reader that fills it.
#[derive(Default)]
pub(crate) struct Parts {
    /// Positions [unit of the file].
    pub nodes: Vec<Vec3>,
    /// Four nodes per tetrahedron.
    pub tets: Vec<[u32; 4]>,
    /// Body of each tetrahedron, an index in `names`; empty for one body.
    pub body: Vec<u32>,
    /// Names of the bodies.
    pub names: Vec<String>,
    /// Points, lines and triangles of each set; entries that one does not need repeat its first.
    pub sets: BTreeMap<String, Vec<[u32; 4]>>,
}

impl Parts {
    /// Bodies in the order of their names, without those that have no tetrahedra. Nodes keep the order of the file.
    pub(crate) fn split(self) -> Result<Vec<(String, BlockMesh)>, Fault> {
        if self.tets.is_empty() {
            return Err(FileProblem::NoTetrahedra.into());
        }
        let mut tets_of: Vec<Vec<[u32; 4]>> = vec![Vec::new(); self.names.len().max(1)];
        for (i, tet) in self.tets.iter().enumerate() {
            tets_of[self.body.get(i).map_or(0, |&b| b as usize)].push(*tet);
        }
        let nodes_of: Vec<Vec<u32>> = tets_of.iter().map(|tets| used(tets)).collect();
        let mut sets = self.node_sets(&nodes_of);
        let mut local = vec![0; self.nodes.len()];
        let mut bodies = Vec::new();
        for (id, (tets, nodes)) in tets_of.into_iter().zip(nodes_of).enumerate() {
            if tets.is_empty() {
                continue;
            }
            for (index, &node) in (0..).zip(&nodes) {
                local[node as usize] = index;
            }
            let mesh = BlockMesh {
                nodes: nodes.iter().map(|&node| self.nodes[node as usize]).collect(),
                tets: tets.iter().map(|tet| tet.map(|node| local[node as usize])).collect(),
                node_sets: std::mem::take(&mut sets[id]),
                ..BlockMesh::default()
            };
            bodies.push((self.names.get(id).map_or(ONLY_BODY, String::as_str).to_string(), mesh));
        }
        Ok(bodies)
    }

    /// Sets of each body. An item counts for a body if all its nodes are the body's, so that a surface between two
    /// bodies is a set of both, and of no third body that it only touches.
    fn node_sets(&self, nodes_of: &[Vec<u32>]) -> Vec<BTreeMap<String, Vec<u32>>> {
        let mut owners: Vec<(u32, usize)> = Vec::new();
        if !self.sets.is_empty() {
            for (id, nodes) in nodes_of.iter().enumerate() {
                owners.extend(nodes.iter().map(|&node| (node, id)));
            }
            owners.sort_unstable();
        }
        let mut sets = vec![BTreeMap::<String, Vec<u32>>::new(); nodes_of.len()];
        for (name, items) in &self.sets {
            for item in items {
                let first = owners.partition_point(|owner| owner.0 < item[0]);
                for &(_, id) in owners[first..].iter().take_while(|owner| owner.0 == item[0]) {
                    let local = item.map(|node| nodes_of[id].binary_search(&node).map(|i| i as u32));
                    if let [Ok(a), Ok(b), Ok(c), Ok(d)] = local {
                        sets[id].entry(name.clone()).or_default().extend([a, b, c, d]);
                    }
                }
            }
            for nodes in sets.iter_mut().filter_map(|sets| sets.get_mut(name)) {
                nodes.sort_unstable();
                nodes.dedup();
            }
        }
        sets
    }
}

/// The nodes of tetrahedra, rising.
fn used(tets: &[[u32; 4]]) -> Vec<u32> {
    let mut nodes = tets.as_flattened().to_vec();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}
