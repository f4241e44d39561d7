//! The fast kernel against its slow twin, over random and degenerate pairs of blocks.

use ndda_contact::element_pairs;
use ndda_contact::reference::tet_pair::NodalForces;
use ndda_contact::testing::{evaluate, test_set};
use ndda_contact::{ContactHistory, ContactInput, ContactModel, PotentialContact};
use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::{BlockMesh, BlockSet, Mat3, Vec3};
use proptest::prelude::*;

const PENALTY_PA: f64 = 1e9;

/// A box whose nodes are moved by part of a cell, so that no two blocks fit each other.
fn block(cells: [u32; 3], pattern: BoxPattern, jitter: &[f64], turn: Vec3, shift: Vec3) -> BlockMesh {
    let mut mesh = box_block([1.0, 0.8, 0.6], cells, pattern).unwrap();
    let largest = f64::from(*cells.iter().max().unwrap());
    for (i, node) in mesh.nodes.iter_mut().enumerate() {
        *node += Vec3::from_fn(|k, _| 0.08 / largest * jitter[(3 * i + k) % jitter.len()]);
    }
    mesh.placed(&nalgebra::Rotation3::new(turn).into_inner(), &shift)
}

/// Largest difference of forces over k_n L², and of energies over k_n L³.
fn deviation(blocks: &BlockSet) -> (f64, f64) {
    let position = &blocks.rest_position;
    let velocity = vec![Vec3::zeros(); position.len()];
    let input = ContactInput::new(blocks, position, &velocity, 1e-3);
    let mut model = PotentialContact::new(PENALTY_PA);
    let fast = evaluate(&mut model, &input, &mut ContactHistory::default());
    let slow = element_pairs::forces(blocks, position, PENALTY_PA);
    let size = ndda_mesh::geometry::Aabb::around(position).diagonal();
    // Forces of a grazing contact are differences of numbers of the size k_n L²: that is what 1e-12 is relative to.
    let scale = PENALTY_PA * size * size;
    let difference = fast.force.iter().zip(&slow).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    let fast_energy = model.energy_j(&input, &ContactHistory::default()).unwrap();
    if swallowed(blocks) {
        return (difference / scale, 0.0);
    }
    let energy = element_pairs::energy_j(blocks, position, PENALTY_PA);
    (difference / scale, (fast_energy - energy).abs() / (scale * size))
}

/// Whether the centroid of some tetrahedron lies in another block or on its surface: the fast energy is then out of
/// its domain, and a run stops.
fn swallowed(blocks: &BlockSet) -> bool {
    let corners = |t: usize| blocks.tets[t].map(|n| blocks.rest_position[n.index()]);
    let inside = |x: &Vec3, t: usize| {
        (0..4).all(|i| {
            let mut replaced = corners(t);
            replaced[i] = *x;
            ndda_mesh::geometry::tet_volume(&replaced) > -1e-12 * ndda_mesh::geometry::tet_volume(&corners(t))
        })
    };
    (0..blocks.tets.len()).any(|a| {
        let centroid = corners(a).iter().sum::<Vec3>() / 4.0;
        (0..blocks.tets.len()).any(|b| blocks.tet_block[a] != blocks.tet_block[b] && inside(&centroid, b))
    })
}

fn pattern() -> impl Strategy<Value = BoxPattern> {
    prop_oneof![Just(BoxPattern::Six), Just(BoxPattern::TwentyFour)]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_blocks_get_the_same_forces_and_energy(
        cells in [1u32..3, 1u32..3, 1u32..3],
        patterns in (pattern(), pattern()),
        jitter in prop::collection::vec(-1.0f64..1.0, 40),
        turn in prop::array::uniform3(-3.0f64..3.0),
        shift in prop::array::uniform3(-0.9f64..0.9),
        scale in -3i32..4,
    ) {
        let first = block(cells, patterns.0, &jitter, Vec3::zeros(), Vec3::zeros());
        let second = block([1, 1, 1], patterns.1, &jitter[7..], Vec3::from(turn), Vec3::from(shift) + Vec3::repeat(0.3));
        let sized = |mut mesh: BlockMesh| {
            mesh.nodes.iter_mut().for_each(|x| *x *= 10f64.powi(scale));
            mesh
        };
        let (force, energy) = deviation(&test_set(vec![sized(first), sized(second)]));
        prop_assert!(force < 1e-12, "forces differ by {force:e}");
        prop_assert!(energy < 1e-12, "energies differ by {energy:e}");
    }

    #[test]
    fn aligned_and_coincident_blocks_get_the_same_forces(
        cells in [1u32..3, 1u32..3, 1u32..3],
        patterns in (pattern(), pattern()),
        eighths in prop::array::uniform3(-8i32..9),
        quarter_turns in prop::array::uniform3(0i32..4),
    ) {
        let mesh = |pattern| box_block([1.0, 1.0, 1.0], cells, pattern).unwrap();
        let quarter = |axis: Vec3, n: i32| {
            nalgebra::Rotation3::new(axis * (f64::from(n) * std::f64::consts::FRAC_PI_2)).into_inner().map(f64::round)
        };
        let turn: Mat3 = quarter(Vec3::x(), quarter_turns[0]) * quarter(Vec3::y(), quarter_turns[1]) * quarter(Vec3::z(), quarter_turns[2]);
        let shift = Vec3::from(eighths.map(|e| f64::from(e) / 8.0));
        let second = mesh(patterns.1).placed(&turn, &shift);
        let (force, energy) = deviation(&test_set(vec![mesh(patterns.0), second]));
        prop_assert!(force < 1e-12, "forces differ by {force:e}");
        prop_assert!(energy < 1e-12, "energies differ by {energy:e}");
    }
}

/// The sum over all pairs of elements (eq 16) by the kernel that the fast sum uses, too.
fn over_all_elements(blocks: &BlockSet) -> Vec<Vec3> {
    let corners = |t: usize| blocks.tets[t].map(|n| blocks.rest_position[n.index()]);
    let [lower, upper] = [0, 1].map(|b| blocks.tets_of(ndda_mesh::BlockId(b)));
    let pairs: Vec<_> = lower.flat_map(|a| upper.clone().map(move |b| (a, b))).collect();
    let tets: Vec<_> = pairs.iter().map(|&(a, b)| [corners(a), corners(b)]).collect();
    let mut nodal = vec![[[Vec3::zeros(); 4]; 2]; pairs.len()];
    NodalForces::default().of(&tets, PENALTY_PA, &mut nodal);
    let mut force = vec![Vec3::zeros(); blocks.rest_position.len()];
    for ((a, b), nodal) in pairs.iter().zip(&nodal) {
        for (tet, nodal) in [a, b].iter().zip(nodal) {
            blocks.tets[**tet].iter().zip(nodal).for_each(|(node, f)| force[node.index()] += f);
        }
    }
    force
}

#[test]
fn faces_inside_a_block_cancel_whatever_its_mesh() {
    let meshes =
        [([1, 1, 1], BoxPattern::Six), ([1, 1, 1], BoxPattern::TwentyFour), ([5, 4, 4], BoxPattern::Six)];
    for (cells, pattern) in meshes {
        let cube = box_block([1.0; 3], cells, pattern).unwrap();
        let turn = nalgebra::Rotation3::new(Vec3::new(0.3, -0.2, 0.5)).into_inner();
        let blocks = test_set(vec![cube.clone(), cube.placed(&turn, &Vec3::new(0.4, 0.3, 0.9))]);
        let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
        let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, 1e-3);
        let mut model = PotentialContact::new(PENALTY_PA);
        let fast = evaluate(&mut model, &input, &mut ContactHistory::default()).force;
        let all = over_all_elements(&blocks);
        let difference = fast.iter().zip(&all).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(fast.iter().any(|f| f.norm() > 1e-3 * PENALTY_PA), "no contact");
        assert!(difference < 1e-12 * PENALTY_PA, "{difference:e} for {cells:?}");
    }
}
