//! Contract suites that a fork can run on its own laws, and blocks to run them on.

use std::collections::{BTreeMap, BTreeSet};

use ndda_mesh::generate::{BoxPattern, box_block};
use ndda_mesh::{BlockId, BlockMesh, BlockSet, Mat3, Vec3};

#[cfg(feature = "potential")]
pub use crate::broad_scenes::{BroadCounts, check_broad_phase};
use crate::model::{ContactHistory, ContactInput, ContactModel, ContactOutput, ContactReport};

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

/// What a model gave for one input.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Total force per node [N].
    pub force: Vec<Vec3>,
    /// Friction's part [N].
    pub friction_force: Vec<Vec3>,
    /// Stiffness bound per node [N/m].
    pub stiffness: Vec<f64>,
    /// The report.
    pub report: ContactReport,
}

/// Evaluates a model into fresh arrays.
pub fn evaluate(model: &mut dyn ContactModel, input: &ContactInput, history: &mut ContactHistory) -> Answer {
    let nodes = input.position.len();
    let mut answer = Answer {
        force: vec![Vec3::zeros(); nodes],
        friction_force: vec![Vec3::zeros(); if model.has_friction() { nodes } else { 0 }],
        stiffness: vec![0.0; nodes],
        report: ContactReport::default(),
    };
    let mut output = ContactOutput {
        force: &mut answer.force,
        friction_force: &mut answer.friction_force,
        stiffness: &mut answer.stiffness,
    };
    answer.report = model.add_forces(input, history, &mut output).expect("forces of a sound scene");
    let mut forces = answer.force.iter().chain(&answer.friction_force);
    let is_still = forces.all(|f| *f == Vec3::zeros()) && answer.stiffness.iter().all(|k| *k == 0.0);
    assert!(is_still || model.has_acted(), "a model that adds forces says that it has not acted");
    answer
}

/// Panics unless `model` keeps the contract of [`ContactModel`]: action equals reaction and torque balances, forces
/// turn and move with the blocks, they are minus the gradient of the energy in rigid motion, they vanish beyond
/// reach, and the same input gives the same bits.
pub fn check_model(model: &mut dyn ContactModel) {
    let lower = test_box([0.0, 0.0, 0.0], [2.0, 1.5, 1.0], [3, 2, 2]);
    let upper = test_box([0.33, 0.21, 0.96], [1.1, 0.9, 0.7], [2, 2, 1]);
    let blocks = test_set(vec![lower, upper]);
    let place = |turn: &Mat3, shift: &Vec3| -> Vec<Vec3> {
        let moved = |(i, x): (usize, &Vec3)| {
            if i >= blocks.nodes_of(BlockId(1)).start { turn * x + shift } else { *x }
        };
        blocks.rest_position.iter().enumerate().map(moved).collect()
    };
    let tilt = nalgebra::Rotation3::new(Vec3::new(0.02, -0.03, 0.05)).into_inner();
    let position = place(&tilt, &Vec3::zeros());
    let velocity = vec![Vec3::zeros(); position.len()];
    let input = ContactInput::new(&blocks, &position, &velocity, 1e-3);
    let answer = evaluate(model, &input, &mut ContactHistory::default());
    let scale: f64 = answer.force.iter().map(|f| f.norm()).sum();
    assert!(scale > 0.0, "overlapping blocks feel no force");

    let sum: Vec3 = answer.force.iter().sum();
    assert!(sum.norm() <= 1e-12 * scale, "forces do not balance: {sum:?} of {scale}");
    let torque: Vec3 = position.iter().zip(&answer.force).map(|(x, f)| x.cross(f)).sum();
    assert!(torque.norm() <= 1e-11 * scale, "torques do not balance: {torque:?} of {scale}");

    let again = evaluate(model, &input, &mut ContactHistory::default());
    assert_eq!(answer, again, "the same input gives other bits");

    check_rigid_motion(model, &input, &answer, scale);
    check_energy(model, &input, &answer, place, &tilt);

    let apart = place(&tilt, &Vec3::new(0.0, 0.0, 0.2));
    let far = ContactInput { position: &apart, ..input };
    let nothing = evaluate(model, &far, &mut ContactHistory::default());
    assert!(nothing.force.iter().all(|f| *f == Vec3::zeros()), "blocks apart feel a force");
    assert_eq!(
        model.energy_j(&far, &ContactHistory::default()).expect("an energy"),
        0.0,
        "blocks apart have contact energy"
    );
}

fn check_rigid_motion(model: &mut dyn ContactModel, input: &ContactInput, answer: &Answer, scale: f64) {
    let turn = nalgebra::Rotation3::new(Vec3::new(0.4, 1.1, -0.7)).into_inner();
    let position: Vec<Vec3> = input.position.iter().map(|x| turn * x + Vec3::new(3.0, -5.0, 2.0)).collect();
    let moved = ContactInput { position: &position, ..*input };
    let turned = evaluate(model, &moved, &mut ContactHistory::default());
    for (f, g) in answer.force.iter().zip(&turned.force) {
        assert!((turn * f - g).norm() <= 1e-9 * scale, "forces do not turn with the blocks: {f:?}, {g:?}");
    }
}

fn check_energy(
    model: &mut dyn ContactModel,
    input: &ContactInput,
    answer: &Answer,
    place: impl Fn(&Mat3, &Vec3) -> Vec<Vec3>,
    tilt: &Mat3,
) {
    let step = 1e-5;
    let mut energy = |turn: &Mat3, shift: &Vec3| {
        let position = place(&(turn * tilt), shift);
        model
            .energy_j(&ContactInput { position: &position, ..*input }, &ContactHistory::default())
            .expect("an energy")
    };
    let upper = input.blocks.nodes_of(BlockId(1));
    let force: Vec3 = answer.force[upper.clone()].iter().sum();
    let arms = input.position[upper.clone()].iter().zip(&answer.force[upper]);
    let torque: Vec3 = arms.map(|(x, f)| x.cross(f)).sum();
    for axis in [Vec3::x(), Vec3::y(), Vec3::z()] {
        let still = Mat3::identity();
        let slope = (energy(&still, &(step * axis)) - energy(&still, &(-step * axis))) / (2.0 * step);
        let error = (slope + force.dot(&axis)).abs();
        assert!(error <= 1e-5 * force.norm(), "force along {axis:?} is not −∂W/∂x: {slope} and {force:?}");
        let turned = |angle: f64| nalgebra::Rotation3::new(angle * axis).into_inner();
        let slope =
            (energy(&turned(step), &Vec3::zeros()) - energy(&turned(-step), &Vec3::zeros())) / (2.0 * step);
        let error = (slope + torque.dot(&axis)).abs();
        assert!(error <= 1e-5 * torque.norm(), "torque about {axis:?} is not −∂W/∂θ: {slope} and {torque:?}");
    }
}

/// Panics unless `potential` keeps the contract of [`ContactPotential`](crate::potential::ContactPotential) in the
/// default contact model.
#[cfg(feature = "potential")]
pub fn check_potential<P: crate::potential::ContactPotential + Clone + 'static>(potential: &P) {
    check_model(&mut crate::PotentialContact::new(1e9).with_potential(Box::new(potential.clone())));
}

/// Panics unless `law` keeps the contract of [`FrictionLaw`](crate::friction::FrictionLaw).
#[cfg(feature = "potential")]
pub fn check_friction(law: &dyn crate::friction::FrictionLaw) {
    use crate::friction::{FacetSlip, ShearMemory};

    let along = [1e-3, -2e-3];
    let slip = |normal_n: f64| FacetSlip {
        normal_n,
        area_m2: 1.0,
        mean_area_m2: 1.0,
        slip_m: along,
        stopping_n: along.map(|s| -1e2 * s),
    };
    let size = |memory: &ShearMemory| memory.shear_n[0].hypot(memory.shear_n[1]);
    let mut stuck = ShearMemory { shear_n: [5.0, 5.0], ..ShearMemory::default() };
    law.advance(&slip(0.0), &mut stuck);
    assert_eq!(stuck.shear_n, [0.0, 0.0], "shear without a normal force");

    let (mut once, mut last) = (ShearMemory::default(), 0.0);
    for _ in 0..1000 {
        law.advance(&slip(1.0), &mut once);
        let power = once.shear_n[0] * along[0] + once.shear_n[1] * along[1];
        assert!(power <= 0.0, "friction pushes along the slip");
        let reached = size(&once);
        assert!(reached.is_finite() && reached >= last * (1.0 - 1e-12), "a steady slip lets the force sink");
        assert!(reached <= law.capacity_n(&slip(1.0), &once) * (1.0 + 1e-12), "more than the law carries");
        last = reached;
    }
    let mut double = ShearMemory::default();
    for _ in 0..1000 {
        law.advance(&slip(2.0), &mut double);
    }
    assert!(size(&double) <= 2.0 * last * (1.0 + 1e-12), "the cap grows faster than the normal force");
    let kept = double;
    let rest = FacetSlip { slip_m: [0.0; 2], stopping_n: [0.0; 2], ..slip(2.0) };
    law.advance(&rest, &mut double);
    let lost = (kept.shear_n[0] - double.shear_n[0]).hypot(kept.shear_n[1] - double.shear_n[1]);
    assert!(lost <= 1e-12 * size(&kept), "a block at rest loses its hold");
}
