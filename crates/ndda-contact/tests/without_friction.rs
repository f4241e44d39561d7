//! Friction that is switched off leaves no trace.

mod frictionless;

use frictionless::Frictionless;
use ndda_contact::testing::{evaluate, test_box, test_set};
use ndda_contact::{ContactHistory, ContactInput, ContactOutput, PotentialContact};
use ndda_mesh::{BlockId, Vec3};

#[test]
fn a_model_without_friction_gives_the_bits_of_one_that_has_no_friction_code() {
    let blocks = test_set(vec![
        test_box([0.0; 3], [2.0, 2.0, 0.5], [7, 6, 2]),
        test_box([0.31, 0.27, 0.49], [1.0, 1.1, 0.5], [4, 5, 2]),
        test_box([0.7, 0.5, 0.985], [0.5, 0.5, 0.5], [2, 2, 2]),
    ]);
    let nodes = blocks.rest_position.len();
    let (mut model, mut twin) = (PotentialContact::new(1e9), Frictionless::default());
    let mut history = ContactHistory::default();
    for step in 0..50 {
        let mut position = blocks.rest_position.clone();
        let shift = Vec3::new(0.011, -0.004, 1e-5) * f64::from(step);
        position[blocks.nodes_of(BlockId(1))].iter_mut().for_each(|x| *x += shift);
        let velocity = vec![shift; nodes];
        let input = ContactInput::new(&blocks, &position, &velocity, 1e-3);
        let answer = evaluate(&mut model, &input, &mut history);
        let (mut force, mut stiffness) = (vec![Vec3::zeros(); nodes], vec![0.0; nodes]);
        let mut output =
            ContactOutput { force: &mut force, friction_force: &mut [], stiffness: &mut stiffness };
        let report = twin.add_forces(&input, 1e9, &mut output);
        assert!(report.contact_pairs > 100);
        assert_eq!(report, answer.report);
        assert!(force.iter().zip(&answer.force).all(|(a, b)| a.map(f64::to_bits) == b.map(f64::to_bits)));
        assert!(stiffness.iter().zip(&answer.stiffness).all(|(a, b)| a.to_bits() == b.to_bits()));
    }
    assert_eq!(history, ContactHistory::default());
}
