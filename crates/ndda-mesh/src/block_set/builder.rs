//! A set that takes in one block after the other: their meshes need not be in memory together.

use std::collections::HashMap;

use super::BlockSet;
use crate::geometry::Aabb;
use crate::node_sets::{NameIndex, NodeSets};
use crate::surface::boundary_faces;
use crate::{BlockId, BlockMesh, MeshError, MeshProblem, NodeId, TetId, Vec3, validate};

/// Takes blocks in, one by one, and makes a [`BlockSet`] of them.
#[derive(Clone, Debug)]
pub struct BlockSetBuilder {
    /// Coordinates are not shifted yet.
    set: BlockSet,
    surface_names: NameIndex,
    set_names: NameIndex,
    problems: Vec<(String, MeshProblem)>,
}

impl Default for BlockSetBuilder {
    fn default() -> Self {
        let set = BlockSet {
            names: Vec::new(),
            rest_position: Vec::new(),
            tets: Vec::new(),
            triangles: Vec::new(),
            triangle_tet: Vec::new(),
            tet_block: Vec::new(),
            triangle_block: Vec::new(),
            triangle_surface: Vec::new(),
            surface_names: Vec::new(),
            origin_m: Vec3::zeros(),
            node_sets: NodeSets::default(),
            node_start: vec![0],
            tet_start: vec![0],
            triangle_start: vec![0],
        };
        let [surface_names, set_names] = [NameIndex::default(), NameIndex::default()];
        Self { set, surface_names, set_names, problems: Vec::new() }
    }
}

impl BlockSetBuilder {
    /// Room for so many blocks, nodes and tetrahedra; the number of boundary triangles is not known before.
    pub fn make_room(&mut self, blocks: usize, nodes: usize, tets: usize) {
        let set = &mut self.set;
        set.rest_position.reserve_exact(nodes);
        set.tets.reserve_exact(tets);
        set.tet_block.reserve_exact(tets);
        set.names.reserve_exact(blocks);
        for starts in [&mut set.node_start, &mut set.tet_start, &mut set.triangle_start] {
            starts.reserve_exact(blocks);
        }
    }

    /// Checks a block and takes it in; what is wrong with it is told at the [end](Self::finish).
    pub fn push(&mut self, name: String, mesh: &BlockMesh) {
        let problems = validate::problems(mesh);
        if !problems.is_empty() {
            self.problems.extend(problems.into_iter().map(|problem| (name.clone(), problem)));
            return;
        }
        let set = &mut self.set;
        let block = BlockId(set.names.len() as u32);
        let (first_node, first_tet) = (set.rest_position.len() as u32, set.tets.len() as u32);
        let global = |node: u32| NodeId(first_node + node);
        set.names.push(name);
        set.rest_position.extend_from_slice(&mesh.nodes);
        set.tets.extend(mesh.tets.iter().map(|tet| tet.map(global)));
        set.tet_block.resize(set.tets.len(), block);
        let mut surface_of = HashMap::new();
        for (name, triangles) in &mesh.surfaces {
            let surface = self.surface_names.of(name);
            surface_of.extend(triangles.iter().map(|&triangle| (triangle, surface)));
        }
        for face in boundary_faces(&mesh.tets) {
            let mut key = face.nodes;
            key.sort_unstable();
            set.triangle_surface.push(surface_of.get(&key).copied());
            set.triangles.push(face.nodes.map(global));
            set.triangle_tet.push(TetId(first_tet + face.tet));
            set.triangle_block.push(block);
        }
        let sets = mesh.node_sets.iter().map(|(name, nodes)| (self.set_names.of(name), &nodes[..]));
        set.node_sets.push(sets, global);
        set.node_start.push(set.rest_position.len() as u32);
        set.tet_start.push(set.tets.len() as u32);
        set.triangle_start.push(set.triangles.len() as u32);
    }

    /// The set, shifted near the origin.
    ///
    /// # Errors
    /// All that [`validate::problems`] found, with the names of the blocks.
    pub fn finish(self) -> Result<BlockSet, MeshError> {
        if !self.problems.is_empty() {
            return Err(MeshError { problems: self.problems });
        }
        let mut set = self.set;
        let origin_m = scene_origin(&set.rest_position);
        set.origin_m = origin_m;
        set.rest_position.iter_mut().for_each(|x| *x -= origin_m);
        (set.surface_names, set.node_sets.names) = (self.surface_names.list, self.set_names.list);
        Ok(set)
    }
}

/// Centre of the scene rounded to multiples of a power of two no smaller than the scene; zero near the origin.
fn scene_origin(nodes: &[Vec3]) -> Vec3 {
    let bounds = Aabb::around(nodes);
    let size = bounds.diagonal();
    if size == 0.0 {
        return Vec3::zeros();
    }
    let quantum = size.log2().ceil().exp2();
    bounds.center().map(|c| (c / quantum).round() * quantum)
}
