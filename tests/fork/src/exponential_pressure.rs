//! A pressure that grows exponentially with the depth below the nearest face.

use std::sync::Arc;

use ndda_contact::{
    ContactPotential, FunctionField, PieceTable, PotentialError, PotentialField, PotentialFunction,
    SmoothPotential,
};
use ndda_mesh::{BlockSet, TetId};

/// p = k_n (s/L) (e^(d/s) − 1), d being the depth and L a reference length: p → k_n d/L as d → 0.
#[derive(Clone, Copy, Debug)]
pub struct ExponentialPressure {
    /// L [m].
    pub reference_m: f64,
    /// s [m].
    pub softness_m: f64,
}

/// The law on the blocks of a scene: d/L is the smallest of linear functions in each tetrahedron.
struct OnBlocks {
    law: ExponentialPressure,
    depth: PieceTable,
}

impl OnBlocks {
    /// The function that is the smallest, by its nodal values, and d/s there.
    fn depth(&self, tet: TetId, lambda: &[f64; 4]) -> ([f64; 4], f64) {
        let at = |values: &[f64; 4]| values.iter().zip(lambda).map(|(v, l)| v * l).sum::<f64>();
        let pieces = self.depth.of(tet);
        let least = pieces.iter().min_by(|a, b| at(a).total_cmp(&at(b))).copied().unwrap_or_default();
        (least, at(&least) * self.law.reference_m / self.law.softness_m)
    }
}

impl PotentialFunction for OnBlocks {
    fn phi(&self, tet: TetId, lambda: &[f64; 4]) -> f64 {
        self.law.softness_m / self.law.reference_m * self.depth(tet, lambda).1.exp_m1()
    }

    fn gradient(&self, tet: TetId, lambda: &[f64; 4]) -> [f64; 4] {
        let (values, depth) = self.depth(tet, lambda);
        values.map(|value| value * depth.exp())
    }

    fn most_in(&self, tet: TetId) -> f64 {
        let deepest = self.depth.most_in(tet) * self.law.reference_m / self.law.softness_m;
        self.law.softness_m / self.law.reference_m * deepest.exp_m1()
    }
}

impl ContactPotential for ExponentialPressure {
    fn name(&self) -> &'static str {
        "exponential"
    }

    fn field(&self, blocks: &BlockSet) -> Result<PotentialField, PotentialError> {
        match (SmoothPotential { reference_m: self.reference_m }).field(blocks)? {
            PotentialField::Pieces(depth) => {
                let function = Arc::new(OnBlocks { law: *self, depth: depth.clone() });
                Ok(PotentialField::Function(FunctionField::new(depth, function, 12)))
            }
            other => Ok(other),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda_contact::potential::testing::check_potential;

    #[test]
    fn it_keeps_the_contract_of_a_potential() {
        check_potential(&ExponentialPressure { reference_m: 1.0, softness_m: 0.05 });
        check_potential(&ExponentialPressure { reference_m: 0.1, softness_m: 1.0 });
    }

    #[test]
    fn deep_contact_presses_as_the_exponential_says() {
        use ndda_contact::testing::{evaluate, test_box, test_set};
        use ndda_contact::{ContactHistory, ContactInput, PotentialContact};
        let depth_m = 0.02;
        let lower = test_box([0.0; 3], [3.0, 3.0, 1.0], [1, 1, 1]);
        let upper = test_box([1.0, 1.0, 1.0 - depth_m], [1.0, 1.0, 0.5], [2, 2, 2]);
        let blocks = test_set(vec![lower, upper]);
        let velocity = vec![ndda_mesh::Vec3::zeros(); blocks.rest_position.len()];
        let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, 1.0);
        let law = ExponentialPressure { reference_m: 1.0, softness_m: 0.01 };
        let mut model = PotentialContact::new(1e9).with_potential(Box::new(law));
        let answer = evaluate(&mut model, &input, &mut ContactHistory::default());
        let on_upper = blocks.nodes_of(ndda_mesh::BlockId(1));
        let lift_n: f64 = answer.force[on_upper].iter().map(|f| f.z).sum();
        // The face of the upper block in the lower one, and that of the lower one in the upper, less its rim, where sides are nearer.
        let pressure = |d: f64| 1e9 * 0.01 * (d / 0.01f64).exp_m1();
        assert!(lift_n < 2.0 * pressure(depth_m) && lift_n > 1.8 * pressure(depth_m), "{lift_n:e}");
    }

    /// The slope of the depth, without that of the exponential.
    #[test]
    #[should_panic(expected = "the gradient of φ is off")]
    fn a_wrong_gradient_is_found_out() {
        #[derive(Clone)]
        struct Flat(ExponentialPressure);
        struct FlatOnBlocks(OnBlocks);
        impl PotentialFunction for FlatOnBlocks {
            fn phi(&self, tet: TetId, lambda: &[f64; 4]) -> f64 {
                self.0.phi(tet, lambda)
            }

            fn gradient(&self, tet: TetId, lambda: &[f64; 4]) -> [f64; 4] {
                self.0.depth(tet, lambda).0
            }

            fn most_in(&self, tet: TetId) -> f64 {
                self.0.most_in(tet)
            }
        }
        impl ContactPotential for Flat {
            fn name(&self) -> &'static str {
                "flat"
            }

            fn field(&self, blocks: &BlockSet) -> Result<PotentialField, PotentialError> {
                let smooth = SmoothPotential { reference_m: self.0.reference_m }.field(blocks)?;
                let PotentialField::Pieces(depth) = smooth else { return Ok(smooth) };
                let function = Arc::new(FlatOnBlocks(OnBlocks { law: self.0, depth: depth.clone() }));
                Ok(PotentialField::Function(FunctionField::new(depth, function, 12)))
            }
        }
        check_potential(&Flat(ExponentialPressure { reference_m: 1.0, softness_m: 0.05 }));
    }
}
