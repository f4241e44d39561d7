//! Convex parts of one concave block as one mesh.
//!
//! The parts meet face to face, so a star in each of them conforms once the faces between them are triangulated
//! only once. Each face stays convex on its own, so refining works as in a single part.

use std::collections::BTreeMap;

use super::star::best_triangles;
use super::{Fill, FillError, Filled, SizeField, named, refine};
use crate::cut::{Blocks, Neighbour, Polyhedron};
use crate::geometry::Aabb;
use crate::validate::{self, first_twins};
use crate::{BlockMesh, Vec3};

/// Vertices of two parts nearer than this fraction of the block's diagonal are the same.
const SAME_VERTEX: f64 = 1e-10;

impl Blocks {
    /// Blocks that are glued to each other, directly or through others, by rising first index; most have one member.
    pub fn groups(&self) -> Vec<Vec<u32>> {
        let mut leader: Vec<u32> = (0..self.blocks.len() as u32).collect();
        // Each look halves the way, so that long chains are walked once.
        let root = |leader: &mut [u32], mut block: u32| {
            while leader[block as usize] != block {
                leader[block as usize] = leader[leader[block as usize] as usize];
                block = leader[block as usize];
            }
            block
        };
        for neighbour in self.neighbours.iter().filter(|neighbour| neighbour.glued) {
            let [a, b] = neighbour.blocks.map(|block| root(&mut leader, block));
            leader[a.max(b) as usize] = a.min(b);
        }
        let mut groups: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for block in 0..self.blocks.len() as u32 {
            groups.entry(root(&mut leader, block)).or_default().push(block);
        }
        groups.into_values().collect()
    }

    /// One conforming mesh of blocks that are glued face to face: see [`groups`](Self::groups).
    ///
    /// [`Fill::Fewest`] is the star of [`Fill::Centre`] here, one node in each part.
    ///
    /// # Errors
    /// [`FillError`] as for a single block, and when the parts do not meet face to face.
    pub fn mesh_glued(&self, group: &[u32], fill: &Fill) -> Result<BlockMesh, FillError> {
        let blocks = self.blocks.len();
        if let Some(&block) = group.iter().find(|&&block| block as usize >= blocks) {
            return Err(FillError::NoSuchBlock { block: block as usize, blocks });
        }
        let [first, _, ..] = *group else {
            return self.mesh(group.first().map_or(blocks, |&block| block as usize), fill);
        };
        let parts: Vec<&Polyhedron> = group.iter().map(|&block| &self.blocks[block as usize]).collect();
        let union = Union::new(&parts);
        let mut is_part = vec![false; blocks];
        group.iter().for_each(|&block| is_part[block as usize] = true);
        let is_inside = |n: &&Neighbour| n.glued && n.blocks.iter().all(|&block| is_part[block as usize]);
        let shared = self.neighbours.iter().filter(is_inside);
        if shared.count() != union.faces.iter().filter(|face| face.is_inner).count() {
            return Err(FillError::NotFaceToFace { block: first as usize, parts: parts.len() });
        }
        let names: Vec<Option<&str>> =
            union.faces.iter().map(|f| (!f.is_inner).then(|| self.surface_name(f.surface))).collect();
        let mut filled = union.filled;
        if let Fill::Size { size_m, finer } = fill {
            let size = SizeField::of_parts(&parts, *size_m, finer)?;
            let normals = union.faces.iter().map(|face| face.normal).collect();
            let too_fine = |tets| FillError::TooFine { size_m: *size_m, tets: tets as f64 };
            filled = refine::refine(normals, filled, &size).map_err(too_fine)?;
        }
        let mesh = named(filled, |face| names[face as usize].map(str::to_string));
        if validate::problems(&mesh).is_empty() {
            return Ok(mesh);
        }
        let width_m = parts.iter().map(|part| part.width_m()).fold(f64::INFINITY, f64::min);
        Err(FillError::TooThin { width_m, length_m: Aabb::around(&mesh.nodes).diagonal() })
    }
}

struct UnionFace {
    surface: u32,
    normal: Vec3,
    /// Whether two parts share it.
    is_inner: bool,
    triangles: Vec<[u32; 3]>,
}

/// Stars in all parts.
struct Union {
    filled: Filled,
    faces: Vec<UnionFace>,
}

impl Union {
    fn new(parts: &[&Polyhedron]) -> Self {
        let all: Vec<Vec3> = parts.iter().flat_map(|part| &part.vertices).copied().collect();
        let twins = first_twins(&all, SAME_VERTEX * Aabb::around(&all).diagonal());
        let (mut index, mut nodes) = (Vec::with_capacity(all.len()), Vec::new());
        for (twin, x) in twins.into_iter().zip(&all) {
            let node = twin.map_or(nodes.len() as u32, |first| index[first as usize]);
            if node as usize == nodes.len() {
                nodes.push(*x);
            }
            index.push(node);
        }
        let mut union = Self {
            filled: Filled { on: vec![Vec::new(); nodes.len()], nodes, tets: Vec::new() },
            faces: Vec::new(),
        };
        let mut known: BTreeMap<Vec<u32>, usize> = BTreeMap::new();
        let mut first = 0;
        for part in parts {
            let centre = union.filled.nodes.len() as u32;
            for face in &part.faces {
                let ring: Vec<u32> = face.vertices.iter().map(|&v| index[first + v as usize]).collect();
                let mut key = ring.clone();
                key.sort_unstable();
                let (id, is_new) = match known.get(&key) {
                    Some(&id) => (id, false),
                    None => (union.faces.len(), true),
                };
                if is_new {
                    known.insert(key, id);
                    union.add_face(ring, face.surface, part.area_vector(face).normalize());
                } else {
                    union.faces[id].is_inner = true;
                }
                // Triangles are outward for the part that brought the face.
                let turn = |[a, b, c]: [u32; 3]| if is_new { [a, c, b, centre] } else { [a, b, c, centre] };
                union.filled.tets.extend(union.faces[id].triangles.iter().map(|&triangle| turn(triangle)));
            }
            union.filled.nodes.push(part.volume_and_centroid().1);
            union.filled.on.push(Vec::new());
            first += part.vertices.len();
        }
        union
    }

    fn add_face(&mut self, ring: Vec<u32>, surface: u32, normal: Vec3) {
        let id = self.faces.len() as u32;
        ring.iter().for_each(|&node| self.filled.on[node as usize].push(id));
        let points: Vec<Vec3> = ring.iter().map(|&node| self.filled.nodes[node as usize]).collect();
        let triangles = best_triangles(&points).into_iter().map(|t| t.map(|i| ring[i])).collect();
        self.faces.push(UnionFace { surface, normal, is_inner: false, triangles });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cut::{
        Axis, CutOptions, Discontinuity, Domain, JointSet, VoronoiOptions, cut_blocks, random_seeds,
        voronoi_blocks,
    };
    use crate::geometry::tet_volume;

    fn volume(mesh: &BlockMesh) -> f64 {
        mesh.tets.iter().map(|tet| tet_volume(&tet.map(|n| mesh.nodes[n as usize]))).sum()
    }

    fn slope() -> Domain {
        let profile = [
            [0.0, 0.0],
            [20.0, 0.0],
            [20.0, 4.0],
            [13.0, 4.0],
            [12.0, 8.0],
            [9.0, 8.0],
            [7.0, 12.0],
            [0.0, 12.0],
        ];
        Domain::extruded(&profile, Axis::Y, 0.0, 5.0).unwrap()
    }

    fn check(blocks: &Blocks, fill: &Fill) {
        let groups = blocks.groups();
        let sum: f64 = groups.iter().map(|group| volume(&blocks.mesh_glued(group, fill).unwrap())).sum();
        assert!((sum / blocks.report.domain_m3 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn an_uncut_slope_is_one_block_at_any_size() {
        let blocks = cut_blocks(&slope(), &[], &CutOptions::default()).unwrap();
        assert!(blocks.blocks.len() > 1);
        check(&blocks, &Fill::Centre);
        check(&blocks, &Fill::Size { size_m: 1.5, finer: vec![] });
        let mesh = blocks.mesh_glued(&blocks.groups()[0], &Fill::Centre).unwrap();
        let on_start = mesh.nodes.iter().filter(|x| x.y == 0.0).count();
        assert_eq!(mesh.node_sets["start"].len(), on_start);
        assert_eq!(mesh.node_sets.len(), 10);
    }

    #[test]
    fn joints_and_cells_cut_a_slope_into_blocks_that_are_whole() {
        let sets = [(60.0, 90.0, 2.5), (80.0, 180.0, 2.0), (20.0, 270.0, 3.0)];
        let sets =
            sets.map(|(dip, to, spacing)| Discontinuity::Set(JointSet::new("joint", dip, to, spacing)));
        let blocks = cut_blocks(&slope(), &sets, &CutOptions::default()).unwrap();
        assert!(blocks.groups().len() < blocks.blocks.len());
        check(&blocks, &Fill::Fewest);
        check(&blocks, &Fill::Size { size_m: 1.5, finer: vec![] });
        let seeds = random_seeds(&slope(), 60, 0.0, 4);
        check(&voronoi_blocks(&slope(), &seeds, &VoronoiOptions::default()).unwrap(), &Fill::Centre);
    }
}
