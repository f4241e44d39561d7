//! Resultants of pairs of blocks against the forces on their nodes, the overlap, and a bond.

use ndda_contact::testing::{evaluate, test_box, test_set};
use ndda_contact::{
    ContactAudit, ContactHistory, ContactInput, Coulomb, FacetContact, MohrCoulomb, PotentialContact,
    resultants,
};
use ndda_mesh::{BlockId, BlockSet, Vec3};

/// Blocks, a model and what it found, with the upper block moving along x.
fn found(meshes: Vec<ndda_mesh::BlockMesh>, slip_m: f64) -> (BlockSet, Vec<FacetContact>, Vec<Vec3>) {
    let blocks = test_set(meshes);
    let mut velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
    velocity[blocks.nodes_of(BlockId(1))].fill(Vec3::x());
    let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, slip_m);
    let mut model = PotentialContact::new(1e9).with_friction(Box::new(Coulomb::new(30.0, 1e10)));
    let mut history = ContactHistory::default();
    let force = evaluate(&mut model, &input, &mut history).force;
    let mut facets = Vec::new();
    model.add_facets(&input, &history, &mut facets);
    (blocks, facets, force)
}

#[test]
fn forces_and_moments_of_pairs_are_those_of_the_nodes() {
    let lower = || test_box([0.0; 3], [3.0, 3.0, 1.0], [2, 2, 1]);
    let upper = || test_box([0.3, 0.4, 0.99], [1.0, 1.0, 0.5], [2, 1, 1]);
    let third = || test_box([1.28, 0.5, 1.1], [1.0, 0.7, 0.5], [1, 2, 1]);
    let (blocks, mut facets, force) = found(vec![lower(), upper(), third()], 1e-6);
    let pairs = resultants(&blocks, &mut facets);
    let between: Vec<_> = pairs.iter().map(|p| (p.first.0, p.second.0)).collect();
    assert_eq!(between, [(0, 1), (1, 2)]);
    for block in blocks.ids() {
        let nodes = blocks.nodes_of(block);
        let (mut sum, mut torque) = (Vec3::zeros(), Vec3::zeros());
        for pair in pairs.iter().filter(|pair| pair.first == block || pair.second == block) {
            let sign = if pair.first == block { 1.0 } else { -1.0 };
            sum -= sign * pair.force_n;
            torque -= sign * (pair.moment_n_m + pair.center.cross(&pair.force_n));
        }
        let scale: f64 = force.iter().map(|f| f.norm()).sum();
        sum += force[nodes.clone()].iter().sum::<Vec3>();
        torque += nodes.map(|n| blocks.rest_position[n].cross(&force[n])).sum::<Vec3>();
        assert!(sum.norm() < 1e-12 * scale && torque.norm() < 1e-11 * scale, "{sum:?} {torque:?}");
    }
}

#[test]
fn area_and_depth_are_those_of_the_overlap_and_friction_holds_until_it_slides() {
    let depth = 1e-3;
    for (slip_m, sliding) in [(1e-9, 0.0), (1.0, 1.0)] {
        let lower = test_box([0.0; 3], [3.0, 3.0, 1.0], [2, 2, 1]);
        let upper = test_box([1.0, 1.0, 1.0 - depth], [1.0, 1.0, 0.5], [1, 1, 1]);
        let (blocks, mut facets, _) = found(vec![lower, upper], slip_m);
        let [pair] = resultants(&blocks, &mut facets)[..] else { panic!("one pair touches") };
        // A square metre, and half of the walls that it is deep.
        let area = 1.0 + 2.0 * depth;
        assert!((pair.area_m2 / area - 1.0).abs() < 1e-9, "{}", pair.area_m2);
        assert!((pair.depth_m / (depth / area) - 1.0).abs() < 1e-9, "{}", pair.depth_m);
        // Walls across the slip do not slide.
        assert!((pair.sliding - sliding).abs() < 2.0 * depth, "{}", pair.sliding);
        let ratio = pair.friction_n.norm() / (pair.force_n - pair.friction_n).norm();
        assert!(ratio < 30f64.to_radians().tan() * (1.0 + 1e-2) && pair.friction_n.x > 0.0, "{ratio}");
        assert!((pair.center - Vec3::new(1.5, 1.5, 1.0)).norm() < 2e-3, "{:?}", pair.center);
    }
}

/// A cube on a cube, which have four walls in common, and on the end of a beam, which have three; upright and turned in space.
#[test]
fn the_depth_of_blocks_with_walls_in_common_is_that_of_their_overlap() {
    let depth = 4e-2;
    for floor in [[1.0, 1.0, 1.0], [3.0, 1.0, 1.0]] {
        for angle in [0.0, 0.7] {
            let turned = |mut mesh: ndda_mesh::BlockMesh| {
                let turn = nalgebra::Rotation3::new(angle * Vec3::new(0.6, 0.0, 0.8));
                mesh.nodes.iter_mut().for_each(|x| *x = turn * *x);
                mesh
            };
            let lower = turned(test_box([0.0; 3], floor, [1, 1, 1]));
            let upper = turned(test_box([0.0, 0.0, 1.0 - depth], [1.0, 1.0, 1.0], [1, 1, 1]));
            let (blocks, mut facets, _) = found(vec![lower, upper], 1e-6);
            let [pair] = resultants(&blocks, &mut facets)[..] else { panic!("one pair touches") };
            // A square metre, and at most half of the walls that it is deep.
            assert!(pair.area_m2 < 1.0 + 2.0 * depth, "{}", pair.area_m2);
            assert!((pair.depth_m * pair.area_m2 / depth - 1.0).abs() < 1e-6, "{floor:?} {}", pair.depth_m);
        }
    }
}

#[test]
fn a_bond_pulls_two_blocks_together() {
    let stiffness = 1e9;
    let law = MohrCoulomb::new(30.0, stiffness, 0.0, 1e6);
    let mut model = PotentialContact::new(1e9).with_friction(Box::new(law));
    let lower = test_box([0.0; 3], [3.0, 3.0, 1.0], [3, 3, 1]);
    let blocks = test_set(vec![lower, test_box([1.0; 3], [1.0, 1.0, 0.5], [1, 1, 1])]);
    let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
    let mut history = ContactHistory::default();
    let gap_m = 1e-4;
    let mut lifted = blocks.rest_position.clone();
    lifted[blocks.nodes_of(BlockId(1))].iter_mut().for_each(|x| x.z += gap_m);
    for position in [&blocks.rest_position, &lifted] {
        let input = ContactInput::new(&blocks, position, &velocity, 1e-3);
        evaluate(&mut model, &input, &mut history);
    }
    let mut facets = Vec::new();
    model.add_facets(&ContactInput::new(&blocks, &lifted, &velocity, 1e-3), &history, &mut facets);
    let [pair] = resultants(&blocks, &mut facets)[..] else { panic!("one pair is glued") };
    // A square metre of glue.
    assert!((pair.force_n.z / (stiffness * gap_m) - 1.0).abs() < 1e-6, "{:?}", pair.force_n);
}
