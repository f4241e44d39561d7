//! A cube slides over the element borders of a plate of unlike mesh at constant depth: ripple of the contact force.

use ndda_contact::testing::{evaluate, test_box, test_set};
use ndda_contact::{
    ContactHistory, ContactInput, ContactPotential, Coulomb, ElementPotential, FrictionLawTable, Memory,
    PotentialContact, SmoothPotential, VolumePotential,
};
use ndda_mesh::{BlockId, Vec3};

use crate::evidence::Answer::{AtLeast, AtMost};
use crate::evidence::{rounding, row};

const DEPTH_M: f64 = 1e-3;

/// The path of the cube, and the plate and the cube.
const PATH_M: Vec3 = Vec3::new(1.8, 0.7, 0.0);

fn plate_and_cube() -> ndda_mesh::BlockSet {
    let plate = test_box([0.0; 3], [4.0, 4.0, 0.5], [8, 7, 1]);
    let cube = test_box([0.5, 1.3, 0.5 - DEPTH_M], [1.0, 1.0, 1.0], [3, 2, 2]);
    test_set(vec![plate, cube])
}

/// Standard deviation over mean of the normal force, and of the force along the path over the mean normal force.
fn ripple(potential: Box<dyn ContactPotential>) -> (f64, f64) {
    let blocks = plate_and_cube();
    let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
    let mut model = PotentialContact::new(1e9).with_potential(potential);
    let moving = blocks.nodes_of(BlockId(1));
    let mut forces = Vec::new();
    for step in 0..400 {
        let along = PATH_M * (f64::from(step) / 400.0);
        let mut position = blocks.rest_position.clone();
        position[moving.clone()].iter_mut().for_each(|x| *x += along);
        let input = ContactInput::new(&blocks, &position, &velocity, 1.0);
        let answer = evaluate(&mut model, &input, &mut ContactHistory::default());
        forces.push(answer.force[moving.clone()].iter().sum::<Vec3>());
    }
    let count = forces.len() as f64;
    let mean = forces.iter().map(|f| f.z).sum::<f64>() / count;
    let path = PATH_M.normalize();
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
    // These know nothing of borders: rounding of a sum over a thousand pairs of tetrahedra. Along the path only the overlap is pushed, which is
    // as high as the depth; the cube is 1 m wide.
    let pairs = rounding(1000);
    let limit = ((element.0 / 20.0).min(pairs), (element.1 / 20.0).min(pairs * DEPTH_M));
    for (name, (normal, along), most) in
        [("Element", element, (1e-2, 1e-4)), ("Smooth", smooth, limit), ("Volume", volume, limit)]
    {
        row(
            "borders",
            &format!("std/mean of the normal force over element borders, {name}"),
            normal,
            AtMost(most.0),
        );
        row("borders", &format!("std/mean of the force along the path, {name}"), along, AtMost(most.1));
    }
}

/// Friction over μ N, mean over the path, where a shear spring needs a slip of `mobilised_m` to reach it.
fn friction_kept(memory: Memory, mobilised_m: f64) -> f64 {
    let (friction_deg, penalty_pa, steps) = (30f64, 1e9, 2000);
    let blocks = plate_and_cube();
    let step = PATH_M / f64::from(steps);
    let mut velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
    let moving = blocks.nodes_of(BlockId(1));
    velocity[moving.clone()].fill(step);
    let friction = friction_deg.to_radians().tan();
    let mut joints = FrictionLawTable::everywhere(Box::new(Coulomb::new(
        friction_deg,
        friction * PRESSURE_PA / mobilised_m,
    )));
    joints.memory = memory;
    let mut model = PotentialContact::new(penalty_pa)
        .with_potential(Box::new(SmoothPotential { reference_m: 1.0 }))
        .with_law_table(joints);
    let (mut history, mut sum) = (ContactHistory::default(), 0.0);
    for k in 0..steps {
        let mut position = blocks.rest_position.clone();
        position[moving.clone()].iter_mut().for_each(|x| *x += f64::from(k) * step);
        let input = ContactInput::new(&blocks, &position, &velocity, 1.0);
        let answer = evaluate(&mut model, &input, &mut history);
        let shear: Vec3 = answer.friction_force[moving.clone()].iter().sum();
        let normal = answer.force[moving.clone()].iter().sum::<Vec3>() - shear;
        sum -= shear.dot(&PATH_M.normalize()) / (friction * normal.z);
    }
    sum / f64::from(steps)
}

/// p = 2 k_n h / L₀ of the smooth potential, one side's share doubled.
const PRESSURE_PA: f64 = 2.0 * 1e9 * DEPTH_M;

#[test]
fn friction_that_is_remembered_per_element_is_lost_at_every_border() {
    // A cube that slides 1.9 m over elements of half a metre.
    for mobilised_m in [1e-3, 1e-2, 1e-1] {
        let [body, element] = [Memory::Body, Memory::Element].map(|m| friction_kept(m, mobilised_m));
        // The first mobilisation is missing from both.
        let named =
            |whose: &str| format!("friction over μN, mobilised by {mobilised_m} m, remembered per {whose}");
        row("borders", &named("body"), body, AtLeast(1.0 - mobilised_m));
        row("borders", &named("element"), element, AtMost(body));
    }
}
