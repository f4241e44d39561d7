//! A cube slides over the element borders of a plate of unlike mesh at constant depth: ripple of the contact force.

use ndda_contact::testing::{evaluate, test_box, test_set};
use ndda_contact::{
    ContactHistory, ContactInput, ContactPotential, ElementPotential, PotentialContact, SmoothPotential,
    VolumePotential,
};
use ndda_mesh::{BlockId, Vec3};

const DEPTH_M: f64 = 1e-3;

/// Standard deviation over mean of the normal force, and of the force along the path over the mean normal force.
fn ripple(potential: Box<dyn ContactPotential>) -> (f64, f64) {
    let plate = test_box([0.0; 3], [4.0, 4.0, 0.5], [8, 7, 1]);
    let cube = test_box([0.5, 1.3, 0.5 - DEPTH_M], [1.0, 1.0, 1.0], [3, 2, 2]);
    let blocks = test_set(vec![plate, cube]);
    let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
    let mut model = PotentialContact::new(1e9).with_potential(potential);
    let moving = blocks.nodes_of(BlockId(1));
    let mut forces = Vec::new();
    for step in 0..400 {
        let along = Vec3::new(0.9, 0.35, 0.0) * (f64::from(step) / 200.0);
        let mut position = blocks.rest_position.clone();
        position[moving.clone()].iter_mut().for_each(|x| *x += along);
        let input = ContactInput::new(&blocks, &position, &velocity, 1.0);
        let answer = evaluate(&mut model, &input, &mut ContactHistory::default());
        forces.push(answer.force[moving.clone()].iter().sum::<Vec3>());
    }
    let count = forces.len() as f64;
    let mean = forces.iter().map(|f| f.z).sum::<f64>() / count;
    let path = Vec3::new(0.9, 0.35, 0.0).normalize();
    let spread = |value: &dyn Fn(&Vec3) -> f64| {
        let middle = forces.iter().map(value).sum::<f64>() / count;
        (forces.iter().map(|f| (value(f) - middle).powi(2)).sum::<f64>() / count).sqrt() / mean
    };
    (spread(&|f| f.z), spread(&|f| f.dot(&path)))
}

#[test]
fn a_smooth_potential_ripples_a_twentieth_of_the_element_potential_or_less() {
    let element = ripple(Box::new(ElementPotential));
    let smooth = ripple(Box::new(SmoothPotential { reference_m: 1.0 }));
    let volume = ripple(Box::new(VolumePotential { exponent: 2.0, reference_m3: 1.0 }));
    for (name, (normal, tangential)) in [("element", element), ("smooth", smooth), ("volume", volume)] {
        println!("{name}: normal ripple {normal:.1e}, tangential ripple {tangential:.1e}");
    }
    assert!(smooth.0 <= element.0 / 20.0 && smooth.1 <= element.1 / 20.0, "{smooth:?} and {element:?}");
}
