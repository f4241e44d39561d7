//! Conditions that every fill must satisfy, and the quality of the fine one.

use std::f64::consts::PI;

use proptest::prelude::*;

use super::*;
use crate::cut::{
    CutOptions, Discontinuity, Domain, JointSet, OrientationScatter, SpacingScatter, VoronoiOptions,
    cut_blocks, random_seeds, voronoi_blocks,
};
use crate::geometry::{tet_volume, triangle_area_vector};
use crate::quality::dihedral_angles_deg;
use crate::surface::boundary_faces;

fn cube() -> Polyhedron {
    Polyhedron::cuboid(Vec3::zeros(), Vec3::repeat(1.0))
}

fn corners(mesh: &BlockMesh, tet: &[u32; 4]) -> [Vec3; 4] {
    tet.map(|n| mesh.nodes[n as usize])
}

/// Volume and surface are those of the block, and each boundary triangle lies in one of its faces.
fn check(block: &Polyhedron, mesh: &BlockMesh) {
    assert_eq!(validate::problems(mesh), vec![]);
    let volume: f64 = mesh.tets.iter().map(|tet| tet_volume(&corners(mesh, tet))).sum();
    assert!((volume / block.volume_m3() - 1.0).abs() < 1e-10, "{volume} {}", block.volume_m3());
    let area: f64 = block.faces.iter().map(|face| block.area_vector(face).norm()).sum();
    let triangles = boundary_faces(&mesh.tets);
    let area_of = |nodes: [u32; 3]| triangle_area_vector(&nodes.map(|n| mesh.nodes[n as usize]));
    let meshed: f64 = triangles.iter().map(|t| area_of(t.nodes).norm()).sum();
    assert!((meshed / area - 1.0).abs() < 1e-7, "{meshed} {area}");
}

/// Blocks of a cube: oblique scattered joint sets, or Voronoi cells.
fn random_blocks(seed: u64) -> Blocks {
    let domain = Domain::cuboid(Vec3::zeros(), Vec3::repeat(1.0)).unwrap();
    if seed.is_multiple_of(2) {
        let seeds = random_seeds(&domain, 40, 0.1, seed);
        return voronoi_blocks(&domain, &seeds, &VoronoiOptions::default()).unwrap();
    }
    let sets = [(70.0, 40.0), (55.0, 170.0), (20.0, 290.0)].map(|(dip, direction)| {
        Discontinuity::Set(JointSet {
            orientation: OrientationScatter::Fisher { kappa: 60.0 },
            spacing: SpacingScatter::Uniform { half_width_m: 0.1 },
            ..JointSet::new("joint", dip, direction, 0.4)
        })
    });
    cut_blocks(&domain, &sets, &CutOptions { seed, ..CutOptions::default() }).unwrap()
}

/// Smallest dihedral angle between faces, or angle within a face, of a block [°].
fn sharpest_deg(block: &Polyhedron) -> f64 {
    let mut least = f64::INFINITY;
    let mut edges = std::collections::BTreeMap::new();
    for face in &block.faces {
        let ring: Vec<Vec3> = block.ring(face).collect();
        let n = ring.len();
        for i in 0..n {
            let (before, after) = (ring[(i + n - 1) % n] - ring[i], ring[(i + 1) % n] - ring[i]);
            least = least.min(before.angle(&after).to_degrees());
            let (a, b) = (face.vertices[i], face.vertices[(i + 1) % n]);
            let normal = block.area_vector(face);
            if let Some(other) = edges.insert((a.min(b), a.max(b)), normal) {
                least = least.min((PI - normal.angle(&other)).to_degrees());
            }
        }
    }
    least
}

#[test]
fn a_cube_has_six_or_twelve_tetrahedra() {
    let fan = tetrahedralise(&cube(), &[], &Fill::Fewest).unwrap();
    assert_eq!((fan.tets.len(), fan.nodes.len()), (6, 8));
    let star = tetrahedralise(&cube(), &["a", "b"], &Fill::Centre).unwrap();
    assert_eq!((star.tets.len(), star.nodes.len()), (12, 9));
    assert_eq!(star.node_sets["a"].len(), 4);
    assert_eq!(star.node_sets["face_5"].len(), 4);
    check(&cube(), &fan);
    check(&cube(), &star);
}

#[test]
fn edges_of_a_fine_cube_have_the_size_asked_for() {
    let mesh = tetrahedralise(&cube(), &[], &Fill::Size { size_m: 0.2, finer: vec![] }).unwrap();
    check(&cube(), &mesh);
    for &[a, b, c, d] in &mesh.tets {
        for (i, j) in [(a, b), (a, c), (a, d), (b, c), (b, d), (c, d)] {
            assert!((mesh.nodes[i as usize] - mesh.nodes[j as usize]).norm() < 0.2 * 1.6);
        }
    }
    let on = &mesh.node_sets["face_1"];
    assert!(on.iter().all(|&n| mesh.nodes[n as usize].x == 1.0));
    assert_eq!(on.len(), mesh.nodes.iter().filter(|x| x.x == 1.0).count());
}

#[test]
fn grading_makes_the_mesh_finer_at_a_point_and_at_a_face() {
    let mean_edge = |mesh: &BlockMesh, near: &dyn Fn(&Vec3) -> bool| {
        let chosen = mesh.tets.iter().map(|t| corners(mesh, t)).filter(|t| t.iter().all(near));
        let volumes: Vec<f64> = chosen.map(|t| tet_volume(&t)).collect();
        (volumes.iter().sum::<f64>() / volumes.len() as f64 * 8.0).cbrt()
    };
    let side = Towards::Plane { point_m: Vec3::zeros(), normal: -2.0 * Vec3::x() };
    for towards in [Towards::Point(Vec3::zeros()), side] {
        let finer = vec![Grading { towards, size_m: 0.04, growth: 0.4 }];
        let mesh = tetrahedralise(&cube(), &[], &Fill::Size { size_m: 0.3, finer }).unwrap();
        check(&cube(), &mesh);
        let near = mean_edge(&mesh, &|x| if towards == side { x.x < 0.1 } else { x.norm() < 0.15 });
        let far = mean_edge(&mesh, &|x| x.x > 0.5);
        assert!(near < 0.09 && far > 0.15, "{near} {far}");
    }
}

/// Prints the histogram; 99.9 % of tetrahedra in blocks that are not sharp themselves are above 10°.
#[test]
fn fine_meshes_of_random_blocks_are_good() {
    let mut least: Vec<f64> = Vec::new();
    for seed in 0..8 {
        let blocks = random_blocks(seed);
        for (index, block) in blocks.blocks.iter().enumerate().filter(|(_, b)| sharpest_deg(b) > 20.0) {
            let size_m = block.volume_m3().cbrt() / 4.0;
            let mesh = blocks.mesh(index, &Fill::Size { size_m, finer: vec![] }).unwrap();
            check(block, &mesh);
            let angle = |tet| dihedral_angles_deg(&corners(&mesh, tet)).into_iter().fold(180.0, f64::min);
            least.extend(mesh.tets.iter().map(angle));
        }
    }
    least.sort_by(f64::total_cmp);
    let at = |share: f64| least[(share * least.len() as f64) as usize];
    println!(
        "{} tets; least dihedral angle {:.1}°, 0.1 % {:.1}°, 1 % {:.1}°, 10 % {:.1}°, 50 % {:.1}°",
        least.len(),
        least[0],
        at(0.001),
        at(0.01),
        at(0.1),
        at(0.5)
    );
    assert!(least[0] > 0.0 && at(0.001) >= 10.0);
}

#[test]
fn every_block_of_a_cut_gets_a_coarse_mesh() {
    for seed in 0..40 {
        let blocks = random_blocks(seed);
        for (index, block) in blocks.blocks.iter().enumerate() {
            for fill in [Fill::Fewest, Fill::Centre] {
                let mesh = blocks.mesh(index, &fill).unwrap();
                check(block, &mesh);
                let expected = mesh.node_sets.keys().all(|name| blocks.names.contains(name));
                assert!(expected && !mesh.node_sets.is_empty());
            }
        }
    }
}

/// Planes through vertices, edges and older sections of a cube, some of them off by rounding or a little more.
fn degenerate_blocks(seed: u64) -> Blocks {
    let domain = Domain::cuboid(Vec3::zeros(), Vec3::repeat(1.0)).unwrap();
    let draws = random_seeds(&domain, 18, 0.0, seed);
    let planes = draws.chunks(3).map(|draw| {
        let jitter = [0.0, 0.0, 1e-16, 1e-12, 1e-9, 1e-8, 1e-6][(draw[2].x * 7.0) as usize];
        let point = draw[0].map(|c| (c * 5.0).floor() / 4.0) + (draw[2] - draw[1]) * jitter;
        let normal = draw[1].map(|c| (c * 5.0).floor() - 2.0) + (draw[0] - draw[2]) * jitter;
        let plane = crate::cut::Plane::new(point, normal).ok()?;
        Some(Discontinuity::Plane { name: "plane".into(), plane })
    });
    let planes: Vec<Discontinuity> = planes.flatten().collect();
    cut_blocks(&domain, &planes, &CutOptions { sliver_width_m: 1e-3, ..CutOptions::default() }).unwrap()
}

#[test]
fn blocks_of_degenerate_cuts_are_filled_unless_they_are_slivers() {
    let (mut filled, mut refused) = (0, 0);
    for seed in 0..2000 {
        let blocks = degenerate_blocks(seed);
        assert!((blocks.report.volume_m3 - 1.0).abs() < 1e-12);
        let sections = blocks.blocks.iter().flat_map(|b| b.faces.iter().map(move |f| (b, f)));
        let sections = sections.filter(|(_, f)| f.surface >= 6).map(|(b, f)| b.area_vector(f).norm());
        let met: f64 = blocks.neighbours.iter().map(|n| n.area_m2).sum();
        assert!((sections.sum::<f64>() - 2.0 * met).abs() < 1e-6, "{seed}");
        let slivers: Vec<u32> = blocks.report.slivers.iter().map(|sliver| sliver.block).collect();
        for index in 0..blocks.blocks.len() {
            let size = Fill::Size { size_m: 0.5, finer: vec![] };
            for fill in [Fill::Fewest, Fill::Centre, size].iter().take(if seed < 30 { 3 } else { 2 }) {
                match blocks.mesh(index, fill) {
                    Ok(mesh) => {
                        let volume: f64 = mesh.tets.iter().map(|tet| tet_volume(&corners(&mesh, tet))).sum();
                        assert!((volume - blocks.blocks[index].volume_m3()).abs() < 1e-4);
                        filled += 1;
                    }
                    Err(error) => {
                        assert!(slivers.contains(&(index as u32)), "{seed} {index}: {error}");
                        refused += 1;
                    }
                }
            }
        }
    }
    println!("{filled} filled, {refused} slivers refused");
    assert!(refused * 20 < filled);
}

#[test]
fn bad_polyhedra_and_sizes_are_named() {
    let mut open = cube();
    open.faces.pop();
    assert!(matches!(tetrahedralise(&open, &[], &Fill::Centre), Err(FillError::NotConvex { .. })));
    let mut dented = cube();
    dented.vertices[7] = Vec3::repeat(0.2);
    assert!(matches!(tetrahedralise(&dented, &[], &Fill::Centre), Err(FillError::NotConvex { .. })));
    let mut unknown = cube();
    unknown.faces[0].vertices[0] = 99;
    assert!(matches!(tetrahedralise(&unknown, &[], &Fill::Centre), Err(FillError::NotConvex { .. })));
    let flat = Polyhedron::cuboid(Vec3::zeros(), Vec3::new(1.0, 1.0, 1e-14));
    assert!(matches!(tetrahedralise(&flat, &[], &Fill::Centre), Err(FillError::TooThin { .. })));
    let size = |size_m| tetrahedralise(&cube(), &[], &Fill::Size { size_m, finer: vec![] });
    assert!(matches!(size(0.0), Err(FillError::Number { .. })));
    assert!(matches!(size(f64::NAN), Err(FillError::Number { .. })));
    assert!(matches!(size(1e-9), Err(FillError::TooFine { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn no_polyhedron_panics(
        vertices in prop::collection::vec(prop::array::uniform3(prop_oneof![-1.0..1.0f64, any::<f64>()]), 8),
    ) {
        let block = Polyhedron { vertices: vertices.into_iter().map(Vec3::from).collect(), ..cube() };
        let _ = tetrahedralise(&block, &[], &Fill::Fewest);
        let _ = tetrahedralise(&block, &[], &Fill::Size { size_m: 0.5, finer: vec![] });
    }
}
