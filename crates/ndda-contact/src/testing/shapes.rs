//! Blocks and numbers to test on.

use std::collections::{BTreeMap, BTreeSet};

use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::{BlockMesh, BlockSet, Mat3, Vec3};

/// Knuth's MMIX generator: tests and benches need numbers that are the same everywhere, no more.
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    /// From 0 to 1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A box with one corner at `corner`, cut into six tetrahedra per cell.
pub fn test_box(corner: [f64; 3], size_m: [f64; 3], cells: [u32; 3]) -> BlockMesh {
    let mesh = box_block(size_m, cells, BoxPattern::Six).expect("positive sizes");
    mesh.placed(&Mat3::identity(), &Vec3::from(corner))
}

/// A horseshoe of twelve cells, `size_m` wide: its arms are so far apart that they may touch. Arms point along z.
pub fn test_horseshoe(corner: [f64; 3], size_m: f64) -> BlockMesh {
    let cell = size_m / 6.0;
    let mut mesh = test_box(corner, [size_m, cell, 4.0 * cell], [6, 1, 4]);
    let nodes = std::mem::take(&mut mesh.nodes);
    let is_gap = |tet: &[u32; 4]| {
        let middle = tet.iter().map(|&n| nodes[n as usize]).sum::<Vec3>() / 4.0 - Vec3::from(corner);
        middle.z > cell && (middle.x - 0.5 * size_m).abs() < 2.0 * cell
    };
    mesh.tets.retain(|tet| !is_gap(tet));
    let used: BTreeSet<u32> = mesh.tets.iter().flatten().copied().collect();
    let place: BTreeMap<u32, u32> = used.iter().zip(0..).map(|(&node, place)| (node, place)).collect();
    mesh.tets.iter_mut().flatten().for_each(|node| *node = place[node]);
    mesh.nodes = used.iter().map(|&node| nodes[node as usize]).collect();
    mesh.node_sets.clear();
    mesh
}

/// Blocks named by their number.
pub fn test_set(meshes: Vec<BlockMesh>) -> BlockSet {
    let named = meshes.into_iter().enumerate().map(|(i, mesh)| (format!("block {i}"), mesh));
    BlockSet::new(named.collect()).expect("valid meshes")
}
