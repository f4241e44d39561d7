//! Blocks that are affine convex targets against the same blocks taken by their tetrahedra.

use nalgebra::{DMatrix, DVector};
use ndda_contact::testing::{Answer, Random, evaluate, test_box, test_set};
use ndda_contact::{
    ContactHistory, ContactInput, ContactModel, Coulomb, MohrCoulomb, PotentialContact, SmoothPotential,
};
use ndda_mesh::generate::{cylinder, prism};
use ndda_mesh::{BlockId, BlockMesh, BlockSet, Mat3, Vec3};

const PENALTY_PA: f64 = 1e9;

fn model() -> PotentialContact {
    PotentialContact::new(PENALTY_PA).with_potential(Box::new(SmoothPotential { reference_m: 0.7 }))
}

/// A vector with coordinates from −1 to 1.
fn vector(random: &mut Random) -> Vec3 {
    Vec3::from_fn(|_, _| 2.0 * random.unit() - 1.0)
}

/// A box, sheared, turned and shifted: convex with six faces, none along an axis.
fn slanted(random: &mut Random, cells: [u32; 3], at: Vec3) -> BlockMesh {
    let mut mesh = test_box([-0.5, -0.4, -0.3], [1.0, 0.8, 0.6], cells);
    let shear = Mat3::identity() + 0.2 * Mat3::from_fn(|_, _| 2.0 * random.unit() - 1.0);
    mesh.nodes.iter_mut().for_each(|x| *x = shear * *x);
    mesh.placed(&nalgebra::Rotation3::new(3.0 * vector(random)).into_inner(), &at)
}

/// Forces on each block as a whole: sum and torque about the origin.
fn wrenches(blocks: &BlockSet, position: &[Vec3], force: &[Vec3]) -> Vec<(Vec3, Vec3)> {
    let of_block = |block| {
        let nodes = blocks.nodes_of(block);
        let arms = position[nodes.clone()].iter().zip(&force[nodes.clone()]);
        (force[nodes].iter().sum(), arms.map(|(x, f)| x.cross(f)).sum())
    };
    blocks.ids().map(of_block).collect()
}

/// The work of the forces on an affine motion, which is all that such a block feels: Σ f xᵀ per block.
fn moments(blocks: &BlockSet, position: &[Vec3], force: &[Vec3]) -> Vec<Mat3> {
    let of_block = |block| {
        let nodes = blocks.nodes_of(block);
        position[nodes.clone()].iter().zip(&force[nodes]).map(|(x, f)| f * x.transpose()).sum()
    };
    blocks.ids().map(of_block).collect()
}

fn input<'a>(
    blocks: &'a BlockSet,
    position: &'a [Vec3],
    velocity: &'a [Vec3],
    affine: &'a [bool],
) -> ContactInput<'a> {
    ContactInput { affine, ..ContactInput::new(blocks, position, velocity, 1e-3) }
}

/// Panics unless the two answers mean the same to blocks that move by affine maps.
fn compare(blocks: &BlockSet, position: &[Vec3], whole: &Answer, by_tets: &Answer) {
    let scale = PENALTY_PA;
    for ((f, t), (g, u)) in
        wrenches(blocks, position, &whole.force).iter().zip(wrenches(blocks, position, &by_tets.force))
    {
        assert!(
            (f - g).norm() <= 1e-13 * scale && (t - u).norm() <= 1e-13 * scale,
            "{f:?} {g:?}\n{t:?} {u:?}"
        );
    }
    for (m, n) in
        moments(blocks, position, &whole.force).iter().zip(moments(blocks, position, &by_tets.force))
    {
        assert!((m - n).norm() <= 1e-13 * scale, "{m:?} {n:?}");
    }
}

#[test]
fn a_whole_block_feels_what_its_tetrahedra_feel() {
    let mut random = Random(7);
    let (mut touching, mut fewer) = (0, 0);
    for case in 0..400 {
        let cells = [1 + case % 2, 1 + case / 2 % 2, 1];
        let apart = 0.55 * vector(&mut random);
        let meshes = vec![slanted(&mut random, cells, Vec3::zeros()), slanted(&mut random, [1, 1, 2], apart)];
        let blocks = test_set(meshes);
        // Affine motion since they were at rest.
        let strain = 0.05 * Mat3::from_fn(|_, _| 2.0 * random.unit() - 1.0);
        let place = |x: &Vec3| x + strain * x;
        let position: Vec<Vec3> = blocks.rest_position.iter().map(place).collect();
        let velocity: Vec<Vec3> = position.iter().map(|x| strain * x).collect();
        // Without friction whole faces are contactors; with a memory of their own triangles are.
        let answer = |affine: &[bool]| {
            let mut model = match case % 3 {
                0 => model().with_friction(Box::new(Coulomb::new(30.0, 1e9))),
                _ => model(),
            };
            let input = input(&blocks, &position, &velocity, affine);
            let mut history = ContactHistory::default();
            let answer = evaluate(&mut model, &input, &mut history);
            (answer, model.energy_j(&input, &history).unwrap())
        };
        let (by_tets, energy) = answer(&[]);
        for affine in [[true, true], [true, false], [false, true]] {
            let (whole, of_whole) = answer(&affine);
            compare(&blocks, &position, &whole, &by_tets);
            assert!((of_whole - energy).abs() <= 1e-12 * PENALTY_PA, "{of_whole} {energy}");
            touching += usize::from(whole.report.contact_pairs > 0);
            fewer += usize::from(whole.report.contact_pairs < by_tets.report.contact_pairs);
            assert!(whole.report.contact_pairs <= by_tets.report.contact_pairs);
            assert!(whole.report.action_reaction_error.is_some_and(|error| error <= 1e-12));
        }
    }
    assert!(touching > 900 && fewer > 800, "{touching} touch, {fewer} with fewer pairs");
}

#[test]
fn a_face_of_any_outline_presses_as_its_triangles_do() {
    let triangle = [[-0.6, -0.4], [0.6, -0.4], [0.1, 0.7]];
    let shapes = [
        prism(triangle, 0.8, [1, 1]),
        prism(triangle, 0.8, [2, 1]),
        cylinder(0.6, 0.8, [1, 1]),
        cylinder(0.6, 0.8, [1, 2]),
        // Its ends have more corners than a face may have as one contactor.
        cylinder(0.6, 0.8, [2, 1]),
    ];
    let shapes = shapes.map(|shape| shape.expect("a shape"));
    let (mut random, mut touching, mut fewer) = (Random(5), 0, 0);
    for case in 0..300 {
        let turned = |random: &mut Random, shape: &BlockMesh, at: Vec3| {
            shape.clone().placed(&nalgebra::Rotation3::new(3.0 * vector(random)).into_inner(), &at)
        };
        let first = turned(&mut random, &shapes[case % 5], Vec3::zeros());
        let apart = 0.6 * vector(&mut random);
        let second = turned(&mut random, &shapes[case / 5 % 5], apart);
        let blocks = test_set(vec![first, second]);
        let still = vec![Vec3::zeros(); blocks.rest_position.len()];
        let answer = |affine: &[bool]| {
            let input = input(&blocks, &blocks.rest_position, &still, affine);
            evaluate(&mut model(), &input, &mut ContactHistory::default())
        };
        let (whole, by_tets) = (answer(&[true, true]), answer(&[]));
        compare(&blocks, &blocks.rest_position, &whole, &by_tets);
        assert!(whole.report.action_reaction_error.is_some_and(|error| error <= 1e-12));
        touching += usize::from(whole.report.contact_pairs > 0);
        fewer += usize::from(2 * whole.report.contact_pairs < by_tets.report.contact_pairs);
    }
    assert!(touching > 250 && fewer > 200, "{touching} touch, {fewer} with fewer pairs");
}

#[test]
fn a_whole_block_is_as_stiff_as_its_tetrahedra_and_no_stiffer_than_it_says() {
    let mut random = Random(11);
    let mut touching = 0;
    for _ in 0..100 {
        let apart = 0.5 * vector(&mut random);
        let meshes =
            vec![slanted(&mut random, [1, 1, 1], Vec3::zeros()), slanted(&mut random, [1, 2, 1], apart)];
        let blocks = test_set(meshes);
        let (position, still) = (&blocks.rest_position, vec![Vec3::zeros(); blocks.rest_position.len()]);
        let found = |affine: &[bool]| {
            let (mut model, mut pairs) = (model(), Vec::new());
            let input = input(&blocks, position, &still, affine);
            let answer = evaluate(&mut model, &input, &mut ContactHistory::default());
            model.add_stiffness(&input, &ContactHistory::default(), &mut pairs).unwrap();
            let mut product = |u: &[Vec3]| {
                let mut out = still.clone();
                pairs.iter().for_each(|pair| pair.add_times(u, &mut out));
                out
            };
            (answer.stiffness, affine_stiffness(&blocks, &mut product))
        };
        let (_, by_tets) = found(&[]);
        let (bound, whole) = found(&[true, true]);
        assert!((&whole - &by_tets).amax() <= 1e-13 * PENALTY_PA, "{whole} {by_tets}");
        let fastest = whole.symmetric_eigen().eigenvalues.max();
        let shares = volume_shares(&blocks);
        let most = bound.iter().zip(&shares).map(|(k, m)| k / m).fold(0.0, f64::max);
        assert!(fastest <= most * (1.0 + 1e-12), "{fastest} beyond {most}");
        touching += usize::from(fastest > 0.0);
    }
    assert!(touching > 70, "{touching} touch");
}

/// A quarter of each tetrahedron's volume to each of its nodes [m³]: masses of unit density.
fn volume_shares(blocks: &BlockSet) -> Vec<f64> {
    let mut shares = vec![0.0; blocks.rest_position.len()];
    for nodes in &blocks.tets {
        let volume = ndda_mesh::geometry::tet_volume(&nodes.map(|n| blocks.rest_position[n.index()]));
        nodes.iter().for_each(|n| shares[n.index()] += 0.25 * volume);
    }
    shares
}

/// −Φᵀ K Φ of both blocks for affine motions Φ that are orthonormal by the nodes' masses: its eigenvalues are ω².
fn affine_stiffness(blocks: &BlockSet, product: &mut dyn FnMut(&[Vec3]) -> Vec<Vec3>) -> DMatrix<f64> {
    let shares = volume_shares(blocks);
    let mut motions: Vec<Vec<f64>> = Vec::new();
    for block in [0, 1].map(BlockId) {
        for shape in 0..4 {
            let at = |n: usize| if shape == 0 { 1.0 } else { blocks.rest_position[n][shape - 1] };
            let mut motion: Vec<f64> = (0..shares.len())
                .map(|n| if blocks.nodes_of(block).contains(&n) { at(n) } else { 0.0 })
                .collect();
            let dot =
                |a: &[f64], b: &[f64]| a.iter().zip(b).zip(&shares).map(|((a, b), m)| m * a * b).sum::<f64>();
            for _ in 0..2 {
                for other in &motions {
                    let along = dot(other, &motion);
                    motion.iter_mut().zip(other).for_each(|(m, o)| *m -= along * o);
                }
            }
            let size = dot(&motion, &motion).sqrt();
            motion.iter_mut().for_each(|m| *m /= size);
            motions.push(motion);
        }
    }
    let along = |motion: &[f64], axis: usize| -> Vec<Vec3> {
        motion.iter().map(|&m| m * Vec3::ith(axis, 1.0)).collect()
    };
    let columns: Vec<DVector<f64>> = (0..3 * motions.len())
        .map(|q| {
            let force = product(&along(&motions[q / 3], q % 3));
            DVector::from_fn(3 * motions.len(), |p, _| {
                -motions[p / 3].iter().zip(&force).map(|(m, f)| m * f[p % 3]).sum::<f64>()
            })
        })
        .collect();
    DMatrix::from_columns(&columns)
}

#[test]
fn glue_holds_a_whole_block_where_it_holds_its_tetrahedra() {
    let blocks = test_set(vec![
        test_box([0.0; 3], [2.0, 2.0, 1.0], [2, 2, 1]),
        test_box([0.4, 0.3, 1.0], [1.0, 1.0, 1.0], [1, 1, 1]),
    ]);
    let still = vec![Vec3::zeros(); blocks.rest_position.len()];
    let mut lifted = blocks.rest_position.clone();
    lifted[blocks.nodes_of(BlockId(1))].iter_mut().for_each(|x| x.z += 1e-5);
    let answer = |affine: &[bool]| {
        let mut model = model().with_friction(Box::new(MohrCoulomb::new(30.0, 1e9, 1e6, 1e6)));
        let mut history = ContactHistory::default();
        evaluate(&mut model, &input(&blocks, &blocks.rest_position, &still, affine), &mut history);
        (evaluate(&mut model, &input(&blocks, &lifted, &still, affine), &mut history), history.bonds.len())
    };
    let ((by_tets, bonds), (whole, of_whole)) = (answer(&[]), answer(&[true, true]));
    assert_eq!(bonds, of_whole);
    assert!(bonds > 0 && by_tets.force.iter().any(|f| f.norm() > 0.0));
    compare(&blocks, &lifted, &whole, &by_tets);
}

#[test]
fn memory_per_element_keeps_the_elements() {
    use ndda_contact::{FrictionLawTable, Memory};

    let mut random = Random(3);
    let blocks = test_set(vec![
        slanted(&mut random, [2, 2, 1], Vec3::zeros()),
        slanted(&mut random, [1, 1, 1], Vec3::repeat(0.3)),
    ]);
    let still = vec![Vec3::zeros(); blocks.rest_position.len()];
    let answer = |affine: &[bool]| {
        let mut joints = FrictionLawTable::everywhere(Box::new(Coulomb::new(30.0, 1e9)));
        joints.memory = Memory::Element;
        let mut model = model().with_law_table(joints);
        evaluate(
            &mut model,
            &input(&blocks, &blocks.rest_position, &still, affine),
            &mut ContactHistory::default(),
        )
    };
    assert_eq!(answer(&[]), answer(&[true, true]));
}
