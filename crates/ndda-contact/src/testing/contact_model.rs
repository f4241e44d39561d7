//! The contract suite of contact models.

use ndda_mesh::{BlockId, Mat3, Vec3};

use crate::contact_model::ContactModel;
use crate::model::{ContactHistory, ContactInput, ContactOutput, ContactReport};
use crate::testing::shapes::{test_box, test_set};

/// Output of a model for one input.
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
