//! Potentials that are any function within an element, integrated by quadrature.

use std::fmt;
use std::sync::Arc;

use ndda_mesh::TetId;

use crate::integration::quadrature::Quadrature;
use crate::potential::piece_table::PieceTable;

/// φ as any function of the barycentric coordinates of an element.
///
/// The pressure on a surface at depth φ is k_n φ and the energy is k_n ∫ φ dV, so a pressure law p(d) of another potential d is the function
/// φ = p(d)/k_n. φ is continuous within a block and zero on its surface.
pub trait PotentialFunction: Send + Sync {
    /// φ at a point of a tetrahedron.
    fn phi(&self, tet: TetId, lambda: &[f64; 4]) -> f64;

    /// ∂φ/∂λ_b there, each λ for itself.
    fn gradient(&self, tet: TetId, lambda: &[f64; 4]) -> [f64; 4];

    /// Largest φ in the tetrahedron: depth is reported as a part of it.
    fn most_in(&self, tet: TetId) -> f64;
}

/// A [`PotentialFunction`] for all blocks, the regions in which it is smooth, and the rule that integrates it there.
#[derive(Clone)]
pub struct FunctionField {
    /// Linear functions per tetrahedron: φ is smooth where one and the same of them is the smallest.
    pub(crate) regions: PieceTable,
    pub(crate) function: Arc<dyn PotentialFunction>,
    pub(crate) rule: Quadrature,
}

impl FunctionField {
    /// A function that is smooth within the regions of a table, integrated exactly where it is a polynomial of this degree in λ there.
    /// Functions of other kinds converge as the degree grows.
    pub fn new(regions: PieceTable, function: Arc<dyn PotentialFunction>, degree: usize) -> Self {
        // Forces weight φ by linear shape functions.
        Self { regions, function, rule: Quadrature::exact_to(degree + 1) }
    }
}

impl fmt::Debug for FunctionField {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("FunctionField")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::potential::contact_potential::{ContactPotential, OverlapLaw, PotentialError, PotentialField};
    use crate::potential::element::ElementPotential;
    use crate::potential::testing::check_potential;
    use crate::testing::{evaluate, test_box, test_set};
    use crate::{ContactHistory, ContactInput, PotentialContact, SmoothPotential};
    use ndda_mesh::{BlockSet, Vec3};

    /// p(4 min λ) of each element.
    #[derive(Clone)]
    struct OfDepth {
        pressure: fn(f64) -> f64,
        slope: fn(f64) -> f64,
        degree: usize,
        law: OverlapLaw,
    }

    impl OfDepth {
        fn deepest(lambda: &[f64; 4]) -> (usize, f64) {
            let least = (0..4).min_by(|&i, &j| lambda[i].total_cmp(&lambda[j])).expect("four coordinates");
            (least, 4.0 * lambda[least])
        }
    }

    impl PotentialFunction for OfDepth {
        fn phi(&self, _: TetId, lambda: &[f64; 4]) -> f64 {
            (self.pressure)(Self::deepest(lambda).1)
        }

        fn gradient(&self, _: TetId, lambda: &[f64; 4]) -> [f64; 4] {
            let (least, depth) = Self::deepest(lambda);
            let mut gradient = [0.0; 4];
            gradient[least] = 4.0 * (self.slope)(depth);
            gradient
        }

        fn most_in(&self, _: TetId) -> f64 {
            (self.pressure)(1.0)
        }
    }

    impl ContactPotential for OfDepth {
        fn name(&self) -> &'static str {
            "of depth"
        }

        fn field(&self, blocks: &BlockSet) -> Result<PotentialField, PotentialError> {
            let mut regions = PieceTable::new();
            let own = [0, 1, 2, 3].map(|b| [0, 1, 2, 3].map(|c| f64::from(b == c)));
            blocks.tets.iter().for_each(|_| regions.push(&own));
            let function = Arc::new(self.clone());
            Ok(PotentialField::Function(FunctionField::new(regions, function, self.degree)))
        }

        fn law(&self) -> OverlapLaw {
            self.law
        }
    }

    const LINEAR: OfDepth = OfDepth { pressure: |d| d, slope: |_| 1.0, degree: 1, law: OverlapLaw::Linear };

    #[test]
    fn they_keep_the_contract_of_a_potential() {
        check_potential(&OfDepth { pressure: |d| d * d, slope: |d| 2.0 * d, degree: 2, ..LINEAR });
        let stiff = OfDepth {
            pressure: |d| (3.0 * d).exp_m1() / 3.0,
            slope: |d| (3.0 * d).exp(),
            degree: 8,
            ..LINEAR
        };
        check_potential(&stiff);
        check_potential(&OfDepth { law: OverlapLaw::Power { exponent: 1.5, reference_m3: 1e-3 }, ..LINEAR });
    }

    #[test]
    fn a_power_of_the_overlap_is_that_of_the_integral_of_phi() {
        #[derive(Clone)]
        struct PowerOfSmooth;
        impl ContactPotential for PowerOfSmooth {
            fn name(&self) -> &'static str {
                "power of smooth"
            }

            fn field(&self, blocks: &BlockSet) -> Result<PotentialField, PotentialError> {
                SmoothPotential { reference_m: 1.0 }.field(blocks)
            }

            fn law(&self) -> OverlapLaw {
                OverlapLaw::Power { exponent: 2.0, reference_m3: 1e-2 }
            }
        }
        check_potential(&PowerOfSmooth);
    }

    #[test]
    fn a_linear_function_has_the_forces_energy_and_stiffness_of_the_exact_integrals() {
        let blocks = test_set(vec![
            test_box([0.0; 3], [2.0, 1.5, 1.0], [3, 2, 2]),
            test_box([0.33, 0.21, 0.96], [1.1, 0.9, 0.7], [2, 2, 1]),
        ]);
        let velocity = vec![Vec3::zeros(); blocks.rest_position.len()];
        let input = ContactInput::new(&blocks, &blocks.rest_position, &velocity, 1e-3);
        let history = ContactHistory::default();
        let answer = |potential: Box<dyn ContactPotential>| {
            let mut model = PotentialContact::new(1e9).with_potential(potential);
            let forces = evaluate(&mut model, &input, &mut ContactHistory::default());
            let mut tangent = Vec::new();
            crate::ContactModel::add_stiffness(&mut model, &input, &history, &mut tangent)
                .expect("a tangent");
            let mut change = vec![Vec3::zeros(); velocity.len()];
            let bent: Vec<Vec3> = blocks.rest_position.iter().map(|x| x.component_mul(x)).collect();
            tangent.iter().for_each(|pair| pair.add_times(&bent, &mut change));
            (forces, crate::ContactModel::energy_j(&mut model, &input, &history).expect("an energy"), change)
        };
        let (exact, function) = (answer(Box::new(ElementPotential)), answer(Box::new(LINEAR)));
        let size: f64 = exact.0.force.iter().map(|f| f.norm()).sum();
        for (a, b) in exact.0.force.iter().zip(&function.0.force) {
            assert!((a - b).norm() <= 1e-13 * size, "{a:?} and {b:?} of {size}");
        }
        let most = exact.0.stiffness.iter().copied().fold(0.0, f64::max);
        for (a, b) in exact.0.stiffness.iter().zip(&function.0.stiffness) {
            assert!((a - b).abs() <= 1e-12 * most, "{a} and {b}");
        }
        let most = exact.2.iter().map(|f| f.norm()).fold(0.0, f64::max);
        for (a, b) in exact.2.iter().zip(&function.2) {
            assert!((a - b).norm() <= 1e-12 * most, "{a:?} and {b:?}");
        }
        assert!((exact.1 / function.1 - 1.0).abs() < 1e-12, "{} and {}", exact.1, function.1);
    }
}
