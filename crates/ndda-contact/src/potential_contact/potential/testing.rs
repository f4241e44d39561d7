//! The contract suite of contact potentials.

use std::collections::BTreeMap;

use ndda_mesh::geometry::TET_FACES;
use ndda_mesh::{BlockSet, TetId};

use crate::PotentialContact;
use crate::potential::contact_potential::{ContactPotential, OverlapLaw, PotentialField};
use crate::potential::function::FunctionField;
use crate::testing::{Random, check_model, test_box, test_set};

/// Differences below this part of the largest φ are rounding.
const ROUNDING: f64 = 1e-9;

/// Panics unless `potential` keeps the contract of [`ContactPotential`]: φ is continuous from element to element and zero on the surface, a
/// function has the gradient that it says, and the default contact model keeps the contract of a contact model with it.
pub fn check_potential<P: ContactPotential + Clone + 'static>(potential: &P) {
    let blocks = test_set(vec![test_box([0.0; 3], [2.0, 1.5, 1.0], [3, 2, 2])]);
    let field = potential.field(&blocks).expect("a potential of a box");
    check_faces(&blocks, &field, potential.law());
    if let PotentialField::Function(function) = &field {
        check_gradient(&blocks, function);
    }
    check_model(&mut PotentialContact::new(1e9).with_potential(Box::new(potential.clone())));
}

/// φ at a point of a tetrahedron, and its scale there.
fn phi(field: &PotentialField, tet: TetId, lambda: &[f64; 4]) -> (f64, f64) {
    let at = |values: &[f64; 4]| values.iter().zip(lambda).map(|(v, l)| v * l).sum::<f64>();
    match field {
        PotentialField::Element => (4.0 * lambda.iter().copied().fold(f64::INFINITY, f64::min), 1.0),
        PotentialField::Pieces(table) => {
            (table.of(tet).iter().map(at).fold(f64::INFINITY, f64::min), table.most_in(tet))
        }
        PotentialField::Function(field) => {
            (field.function.phi(tet, lambda), field.function.most_in(tet).abs())
        }
    }
}

/// Looks at points of all faces: within the block from both sides, on the surface at what a potential without a law of its own must be.
fn check_faces(blocks: &BlockSet, field: &PotentialField, law: OverlapLaw) {
    let mut seen: BTreeMap<[u32; 3], (TetId, Vec<f64>, f64)> = BTreeMap::new();
    for (index, nodes) in blocks.tets.iter().enumerate() {
        for face in TET_FACES {
            let tet = TetId(index as u32);
            let mut corners = face.map(|i| (nodes[i].0, i));
            corners.sort_unstable();
            let values = [[0.2, 0.3, 0.5], [0.6, 0.3, 0.1], [1.0, 1.0, 1.0]].map(|weights| {
                let total: f64 = weights.iter().sum();
                let mut lambda = [0.0; 4];
                corners.iter().zip(weights).for_each(|((_, i), weight)| lambda[*i] = weight / total);
                phi(field, tet, &lambda)
            });
            let most = values.iter().map(|v| v.1).fold(0.0, f64::max);
            let values: Vec<f64> = values.iter().map(|v| v.0).collect();
            match seen.remove(&corners.map(|c| c.0)) {
                Some((other, theirs, their_most)) => {
                    let off = values.iter().zip(&theirs).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                    let is_same = off <= ROUNDING * most.max(their_most);
                    assert!(is_same, "φ jumps by {off:e} between the elements {} and {index}", other.0);
                }
                None => {
                    seen.insert(corners.map(|c| c.0), (tet, values, most));
                }
            }
        }
    }
    if law == OverlapLaw::Linear {
        for (tet, values, most) in seen.values() {
            let off = values.iter().map(|v| v.abs()).fold(0.0, f64::max);
            assert!(off <= ROUNDING * most, "φ is {off:e} on the surface of the block, in element {}", tet.0);
        }
    }
}

/// Compares the gradient with differences of φ along the edges of elements.
fn check_gradient(blocks: &BlockSet, field: &FunctionField) {
    let (mut random, step) = (Random(7), 1e-6);
    for index in 0..blocks.tets.len() {
        let tet = TetId(index as u32);
        let shares = [(); 4].map(|()| 0.05 + random.unit());
        let total: f64 = shares.iter().sum();
        let lambda = shares.map(|share| share / total);
        let gradient = field.function.gradient(tet, &lambda);
        let size = gradient.iter().map(|g| g.abs()).fold(0.0, f64::max);
        for (b, c) in [(0, 1), (1, 2), (2, 3), (3, 0)] {
            let moved = |by: f64| {
                let mut at = lambda;
                (at[b], at[c]) = (at[b] + by, at[c] - by);
                field.function.phi(tet, &at)
            };
            let slope = (moved(step) - moved(-step)) / (2.0 * step);
            let off = (slope - gradient[b] + gradient[c]).abs();
            assert!(off <= 1e-4 * size, "the gradient of φ is off by {off:e} of {size:e} in element {index}");
        }
    }
}
