//! Contact patch test: a uniform pressure through a flat interface between unlike meshes.
//!
//! A block of 2 × 2 × 1 cells is pressed by a depth h into one of 5 × 3 × 2; both are 1 m wide. The pressure is the
//! nodal force that a facet gets over what its part of a uniform one would be.

use ndda_contact::testing::{evaluate, test_box, test_set};
use ndda_contact::{
    ContactHistory, ContactInput, ContactPotential, ElementPotential, PotentialContact, SmoothPotential,
    VolumePotential,
};
use ndda_mesh::{BlockId, Vec3};

use crate::evidence::Answer::{AtLeast, AtMost, Near};
use crate::evidence::row;

const DEPTH_M: f64 = 1e-4;
/// Height of the cells of either block.
const HEIGHT_M: f64 = 0.5;
const PENALTY_PA: f64 = 1e9;

/// Largest deviation of a nodal force from that of a uniform pressure, over the force of the whole pressure on one
/// node's share of the face.
fn deviation(potential: Box<dyn ContactPotential>, depth_m: f64) -> f64 {
    let mut lower = test_box([0.0; 3], [1.0, 1.0, 1.0], [5, 3, 2]);
    // Inner nodes off their grid: tetrahedra of different heights meet the interface.
    for (i, x) in lower.nodes.iter_mut().enumerate() {
        if x.iter().all(|&c| c > 1e-9 && c < 1.0 - 1e-9) {
            *x += Vec3::from_fn(|k, _| 0.06 * f64::from((i * 7 + k * 5) as u32 % 11) / 11.0 - 0.03);
            x.z += if i % 2 == 0 { 0.2 } else { -0.1 };
        }
    }
    let upper = test_box([0.0, 0.0, 1.0 - depth_m], [1.0, 1.0, 0.5], [2, 2, 1]);
    let blocks = test_set(vec![lower, upper]);
    let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
    let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, 1.0);
    let mut model = PotentialContact::new(PENALTY_PA).with_potential(potential);
    let answer = evaluate(&mut model, &input, &mut ContactHistory::default());
    let upper = blocks.nodes_of(BlockId(1));
    let total: f64 = answer.force[upper.clone()].iter().map(|f| f.z).sum();
    // Consistent share of a uniform pressure: a third of the triangles around a node.
    let mut share = vec![0.0; blocks.rest_position.len()];
    for triangle in blocks.triangles_of(BlockId(1)).map(|t| blocks.triangles[t]) {
        let corners = triangle.map(|n| blocks.rest_position[n.index()]);
        if corners.iter().all(|x| (x.z - (1.0 - depth_m)).abs() < 1e-9) {
            let area = ndda_mesh::geometry::triangle_area_vector(&corners).norm();
            triangle.iter().for_each(|n| share[n.index()] += area / 3.0);
        }
    }
    let touching = upper.filter(|&i| share[i] > 0.0);
    touching.map(|i| (answer.force[i].z / (share[i] * total) - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn a_smooth_potential_passes_the_contact_patch_test_and_the_element_potential_fails() {
    let element = deviation(Box::new(ElementPotential), DEPTH_M);
    let smooth = deviation(Box::new(SmoothPotential { reference_m: 1.0 }), DEPTH_M);
    let volume = deviation(Box::new(VolumePotential { exponent: 2.0, reference_m3: 1.0 }), DEPTH_M);
    // Nodes share the pressure by the shape functions of where it acts, which is up to the depth inside of the face: d/H of either block.
    let inside = 2.0 * DEPTH_M / HEIGHT_M;
    row("contact patch test", "deviation from a uniform pressure, Smooth", smooth, AtMost(inside));
    row("contact patch test", "deviation from a uniform pressure, Volume", volume, AtMost(inside));
    // The nature of the element potential, which is said wherever it is chosen: pressure follows the heights of tetrahedra, however shallow contact is.
    row("contact patch test", "deviation from a uniform pressure, Element", element, AtLeast(0.05));
    let shallow = deviation(Box::new(ElementPotential), 0.5 * DEPTH_M);
    row(
        "contact patch test",
        "the same at half of the depth, less that",
        shallow - element,
        Near(0.0, inside),
    );
}
