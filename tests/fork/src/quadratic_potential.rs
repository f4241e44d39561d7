//! A potential that is quadratic in the barycentric coordinates: soft where contact begins.

use std::sync::Arc;

use ndda_contact::{
    ContactPotential, FunctionField, PieceTable, PotentialError, PotentialField, PotentialFunction,
};
use ndda_mesh::{BlockSet, TetId};

/// φ = (4 min λ)² in every tetrahedron.
#[derive(Clone, Copy, Debug)]
pub struct QuadraticPotential;

/// The nearest face of the tetrahedron, and 4 λ there.
fn depth(lambda: &[f64; 4]) -> (usize, f64) {
    let nearest = (0..4).min_by(|&i, &j| lambda[i].total_cmp(&lambda[j])).unwrap_or(0);
    (nearest, 4.0 * lambda[nearest])
}

impl PotentialFunction for QuadraticPotential {
    fn phi(&self, _: TetId, lambda: &[f64; 4]) -> f64 {
        depth(lambda).1.powi(2)
    }

    fn gradient(&self, _: TetId, lambda: &[f64; 4]) -> [f64; 4] {
        let (nearest, depth) = depth(lambda);
        let mut gradient = [0.0; 4];
        gradient[nearest] = 8.0 * depth;
        gradient
    }

    fn most_in(&self, _: TetId) -> f64 {
        16.0
    }
}

impl ContactPotential for QuadraticPotential {
    fn name(&self) -> &'static str {
        "quadratic"
    }

    /// φ is smooth where one λ is the smallest.
    fn field(&self, blocks: &BlockSet) -> Result<PotentialField, PotentialError> {
        let mut regions = PieceTable::new();
        let own = [0, 1, 2, 3].map(|b| [0, 1, 2, 3].map(|c| f64::from(b == c)));
        blocks.tets.iter().for_each(|_| regions.push(&own));
        Ok(PotentialField::Function(FunctionField::new(regions, Arc::new(*self), 2)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_contact::potential::testing::check_potential;

    #[test]
    fn it_keeps_the_contract_of_a_potential() {
        check_potential(&QuadraticPotential);
    }

    /// λ₀ of each element, which is another one in its neighbour.
    #[derive(Clone)]
    struct Broken;

    impl PotentialFunction for Broken {
        fn phi(&self, _: TetId, lambda: &[f64; 4]) -> f64 {
            16.0 * lambda[0] * lambda[0]
        }

        fn gradient(&self, _: TetId, lambda: &[f64; 4]) -> [f64; 4] {
            [32.0 * lambda[0], 0.0, 0.0, 0.0]
        }

        fn most_in(&self, _: TetId) -> f64 {
            16.0
        }
    }

    impl ContactPotential for Broken {
        fn name(&self) -> &'static str {
            "broken"
        }

        fn field(&self, blocks: &BlockSet) -> Result<PotentialField, PotentialError> {
            let mut one_region = PieceTable::new();
            blocks.tets.iter().for_each(|_| one_region.push(&[[1.0, 0.0, 0.0, 0.0]]));
            Ok(PotentialField::Function(FunctionField::new(one_region, Arc::new(Broken), 2)))
        }
    }

    #[test]
    #[should_panic(expected = "φ jumps by")]
    fn a_potential_that_jumps_between_elements_is_found_out() {
        check_potential(&Broken);
    }
}
