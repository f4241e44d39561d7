//! Bodies as one list of nodes and tetrahedra, as all formats want them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use ndda_mesh::{BlockMesh, Vec3};

use crate::write_error::WriteError;

/// Bodies one after the other; nodes are not shared.
pub(crate) struct Joined<'a> {
    /// Positions [unit of the file].
    pub nodes: Vec<Vec3>,
    /// Index of the first node of each body, and the number of nodes.
    pub first_node: Vec<u32>,
    /// Four nodes per tetrahedron.
    pub tets: Vec<[u32; 4]>,
    /// Index of the first tetrahedron of each body, and the number of tetrahedra.
    pub first_tet: Vec<usize>,
    /// Names of the bodies.
    pub names: Vec<&'a str>,
    /// Nodes of each set of all bodies, rising.
    pub sets: BTreeMap<&'a str, Vec<u32>>,
}

impl<'a> Joined<'a> {
    /// All of `bodies` for a file at `path`, which is for the error.
    ///
    /// # Errors
    /// [`WriteError`] for a number that is not finite, an index without node, and names that no file can keep.
    pub(crate) fn new(path: &Path, bodies: &'a [(String, BlockMesh)]) -> Result<Self, WriteError> {
        let refuse = |reason: String| WriteError::Encode { path: path.to_path_buf(), reason };
        let mut joined = Self {
            nodes: Vec::new(),
            first_node: vec![0],
            tets: Vec::new(),
            first_tet: vec![0],
            names: Vec::new(),
            sets: BTreeMap::new(),
        };
        let mut known = BTreeSet::new();
        for (name, mesh) in bodies {
            check_name(name).map_err(refuse)?;
            if !known.insert(name) {
                return Err(refuse(format!("two bodies are called `{name}`: rename one")));
            }
            joined.add(name, mesh).map_err(refuse)?;
        }
        if joined.tets.is_empty() {
            return Err(refuse("there are no tetrahedra: name bodies that have some".into()));
        }
        match joined.nodes.iter().position(|x| !x.iter().all(|c| c.is_finite())) {
            Some(index) => Err(WriteError::not_finite(path, "node", Some(index))),
            None => Ok(joined),
        }
    }

    fn add(&mut self, name: &'a str, mesh: &'a BlockMesh) -> Result<(), String> {
        let first = self.nodes.len();
        let end = u32::try_from(first + mesh.nodes.len()).map_err(|_| "more than 2³² nodes".to_string())?;
        let first = first as u32;
        let shifted = |node: u32| {
            let shifted = first.checked_add(node).filter(|&node| node < end);
            shifted.ok_or_else(|| format!("body `{name}` has no node {node}, which one of its lists names"))
        };
        for tet in &mesh.tets {
            let mut nodes = *tet;
            for node in &mut nodes {
                *node = shifted(*node)?;
            }
            self.tets.push(nodes);
        }
        for (set, nodes) in &mesh.node_sets {
            check_name(set)?;
            let list = self.sets.entry(set).or_default();
            for &node in nodes {
                list.push(shifted(node)?);
            }
        }
        self.nodes.extend(&mesh.nodes);
        self.names.push(name);
        self.first_node.push(end);
        self.first_tet.push(self.tets.len());
        Ok(())
    }

    /// Index of each tetrahedron's body.
    pub(crate) fn body_of_tets(&self) -> impl Iterator<Item = u32> + '_ {
        (0..).zip(self.first_tet.windows(2)).flat_map(|(body, w)| std::iter::repeat_n(body, w[1] - w[0]))
    }
}

fn check_name(name: &str) -> Result<(), String> {
    let good =
        !name.is_empty() && name.trim() == name && !name.contains(|c: char| c.is_control() || c == '"');
    let cure = "rename it: no quotes, line ends, or spaces around it";
    if good { Ok(()) } else { Err(format!("the name {name:?} cannot be kept, {cure}")) }
}
