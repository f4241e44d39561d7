//! Cases that are measured, by the clock and by counting instructions.
#![allow(dead_code)] // each bench takes some of it

use ndda_mesh::cut::{
    Blocks, CutOptions, Discontinuity, Domain, JointSet, OrientationScatter, VoronoiOptions, cut_blocks,
    random_seeds, voronoi_blocks,
};
use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::tetrahedralise::Fill;
use ndda_mesh::{BlockMesh, Mat3, Vec3};

/// A cube of 100 m.
pub fn domain() -> Domain {
    Domain::cuboid(Vec3::zeros(), Vec3::repeat(100.0)).expect("a cube")
}

/// Three oblique sets, about `per_side`³ blocks in a cube of 100 m.
pub fn sets(per_side: f64, orientation: OrientationScatter) -> Vec<Discontinuity> {
    let spacing_m = 100.0 / per_side;
    [("a", 75.0, 30.0), ("b", 65.0, 140.0), ("c", 15.0, 250.0)]
        .map(|(name, dip, direction)| {
            Discontinuity::Set(JointSet { orientation, ..JointSet::new(name, dip, direction, spacing_m) })
        })
        .to_vec()
}

/// Joints that scatter about their means.
pub const SCATTERED: OrientationScatter = OrientationScatter::Fisher { kappa: 200.0 };

/// About `per_side`³ blocks between joints that scatter.
pub fn by_joints(per_side: f64) -> Blocks {
    cut_blocks(&domain(), &sets(per_side, SCATTERED), &CutOptions::default()).expect("blocks")
}

/// Cells around seeds.
pub fn by_seeds(cells: usize) -> Blocks {
    let seeds = random_seeds(&domain(), cells, 5.0, 1);
    voronoi_blocks(&domain(), &seeds, &VoronoiOptions::default()).expect("cells")
}

/// Tetrahedra in all blocks that take them.
pub fn filled(blocks: &Blocks, fill: &Fill) -> Vec<BlockMesh> {
    blocks.groups().iter().filter_map(|group| blocks.mesh_glued(group, fill).ok()).collect()
}

/// A cube of 6 n³ tetrahedra.
pub fn cube(n: u32) -> BlockMesh {
    box_block([1.0; 3], [n; 3], BoxPattern::Six).expect("a cube")
}

/// Cubes in a row, named.
pub fn row(count: usize, n: u32) -> Vec<(String, BlockMesh)> {
    let cube = cube(n);
    let place = |i: usize| cube.clone().placed(&Mat3::identity(), &Vec3::new(2.0 * i as f64, 0.0, 0.0));
    (0..count).map(|i| (format!("cube {i}"), place(i))).collect()
}
