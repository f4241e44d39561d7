//! Hyperbolic closure of joints.

use std::sync::Arc;

use ndda_mesh::{BlockSet, TetId};

use crate::potential::contact_potential::{ContactPotential, PotentialError, PotentialField};
use crate::potential::function::{FunctionField, PotentialFunction};
use crate::potential::piece_table::PieceTable;
use crate::potential::smooth::SmoothPotential;

/// Part of the largest closure beyond which stress grows along its tangent, so that it is finite at any depth.
const STEEPEST: f64 = 0.99;

/// Degree of the rule that integrates the pressure.
const DEGREE: usize = 12;

/// σ = k_ni V/(1 − V/V_m): a joint that stiffens while it closes (Bandis, Lumsden & Barton 1983; Brady & Brown, Rock Mechanics).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HyperbolicClosure {
    /// Initial stiffness k_ni [Pa/m].
    pub initial_pa_m: f64,
    /// Largest closure V_m [m].
    pub most_m: f64,
}

impl HyperbolicClosure {
    /// Stress at a closure [Pa]; from 0.99 V_m on along the tangent there.
    pub fn stress_pa(&self, closure_m: f64) -> f64 {
        let bent_m = closure_m.min(STEEPEST * self.most_m);
        let bent_pa = self.initial_pa_m * bent_m / (1.0 - bent_m / self.most_m);
        bent_pa + self.tangent_pa_m(closure_m) * (closure_m - bent_m)
    }

    /// Tangent stiffness k_ni/(1 − V/V_m)² [Pa/m], which is k_ni [1 − σ/(V_m k_ni + σ)]⁻².
    pub fn tangent_pa_m(&self, closure_m: f64) -> f64 {
        let open = 1.0 - (closure_m / self.most_m).min(STEEPEST);
        self.initial_pa_m / (open * open)
    }

    /// Closure under a stress V_m σ/(k_ni V_m + σ) [m].
    pub fn closure_m(&self, stress_pa: f64) -> f64 {
        let bent_m = self.most_m * stress_pa / (self.initial_pa_m * self.most_m + stress_pa);
        let last_m = STEEPEST * self.most_m;
        if bent_m <= last_m {
            return bent_m;
        }
        last_m + (stress_pa - self.stress_pa(last_m)) / self.tangent_pa_m(last_m)
    }

    /// Energy ∫ σ dV = −k_ni V_m² [ln(1 − V/V_m) + V/V_m] [J/m²].
    pub fn energy_j_m2(&self, closure_m: f64) -> f64 {
        let bent_m = closure_m.min(STEEPEST * self.most_m);
        let (part, more_m) = (bent_m / self.most_m, closure_m - bent_m);
        let bent = -self.initial_pa_m * self.most_m * self.most_m * ((-part).ln_1p() + part);
        bent + more_m * (self.stress_pa(bent_m) + 0.5 * self.tangent_pa_m(closure_m) * more_m)
    }
}

/// The pressure of a joint that closes by a hyperbola, of the depth below the nearest face as in [`SmoothPotential`]. Both sides of a joint bear half: together σ = k_ni d/(1 −
/// d/V_m) at an overlap d, k_ni = 2 k_n/L₀.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosurePotential {
    /// L₀ [m].
    pub reference_m: f64,
    /// Largest closure V_m [m].
    pub most_m: f64,
}

impl ClosurePotential {
    /// φ of the depth: half of the stress over k_n.
    fn of_depth(&self) -> HyperbolicClosure {
        HyperbolicClosure { initial_pa_m: 1.0 / self.reference_m, most_m: self.most_m }
    }
}

/// The law on the blocks of a scene: the depth is the smallest of linear functions in each tetrahedron.
struct OnBlocks {
    law: HyperbolicClosure,
    /// By its nodal values [m].
    depth_m: PieceTable,
}

impl OnBlocks {
    /// The function that is the smallest, by its nodal values, and its value there.
    fn depth_m(&self, tet: TetId, lambda: &[f64; 4]) -> ([f64; 4], f64) {
        let at = |values: &[f64; 4]| values.iter().zip(lambda).map(|(v, l)| v * l).sum::<f64>();
        let pieces = self.depth_m.of(tet);
        let least = pieces.iter().min_by(|a, b| at(a).total_cmp(&at(b))).copied().unwrap_or_default();
        (least, at(&least))
    }
}

impl PotentialFunction for OnBlocks {
    fn phi(&self, tet: TetId, lambda: &[f64; 4]) -> f64 {
        self.law.stress_pa(self.depth_m(tet, lambda).1)
    }

    fn gradient(&self, tet: TetId, lambda: &[f64; 4]) -> [f64; 4] {
        let (values, depth_m) = self.depth_m(tet, lambda);
        values.map(|value| value * self.law.tangent_pa_m(depth_m))
    }

    fn most_in(&self, tet: TetId) -> f64 {
        self.law.stress_pa(self.depth_m.most_in(tet))
    }
}

impl ContactPotential for ClosurePotential {
    fn name(&self) -> &'static str {
        "Closure"
    }

    fn field(&self, blocks: &BlockSet) -> Result<PotentialField, PotentialError> {
        match (SmoothPotential { reference_m: 1.0 }).field(blocks)? {
            PotentialField::Pieces(depth_m) => {
                let function = Arc::new(OnBlocks { law: self.of_depth(), depth_m: depth_m.clone() });
                Ok(PotentialField::Function(FunctionField::new(depth_m, function, DEGREE)))
            }
            other => Ok(other),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::potential::testing::check_potential;

    const JOINT: HyperbolicClosure = HyperbolicClosure { initial_pa_m: 20e9, most_m: 0.3e-3 };

    #[test]
    fn it_keeps_the_contract_of_a_potential() {
        check_potential(&ClosurePotential { reference_m: 1.0, most_m: 2.0 });
        check_potential(&ClosurePotential { reference_m: 0.5, most_m: 50.0 });
    }

    #[test]
    fn closure_stiffness_and_energy_are_those_of_the_hyperbola() {
        let rows = [
            (1e6, 0.042_857_142_857e-3, 27.222_222e9, 20.328),
            (2e6, 0.075e-3, 35.555_556e9, 67.828),
            (10e6, 0.1875e-3, 142.222_22e9, 640.49),
        ];
        for (stress_pa, closure_m, tangent_pa_m, energy_j_m2) in rows {
            let found_m = JOINT.closure_m(stress_pa);
            assert!((found_m / closure_m - 1.0).abs() < 1e-9, "{found_m} for {closure_m}");
            assert!((JOINT.stress_pa(found_m) / stress_pa - 1.0).abs() < 1e-12);
            let tangent = JOINT.tangent_pa_m(found_m);
            assert!((tangent / tangent_pa_m - 1.0).abs() < 1e-7, "{tangent} for {tangent_pa_m}");
            let brady = 20e9 * (1.0 - stress_pa / (0.3e-3 * 20e9 + stress_pa)).powi(-2);
            assert!((tangent / brady - 1.0).abs() < 1e-12);
            let energy = JOINT.energy_j_m2(found_m);
            assert!((energy / energy_j_m2 - 1.0).abs() < 2e-5, "{energy} for {energy_j_m2}");
        }
    }

    #[test]
    fn beyond_the_hyperbola_stress_and_energy_go_on_smoothly() {
        for closure_m in [0.9, 0.99, 1.0, 5.0].map(|part| part * JOINT.most_m) {
            let step_m = 1e-6 * JOINT.most_m;
            let energy = |at: f64| JOINT.energy_j_m2(at);
            let slope = (energy(closure_m + step_m) - energy(closure_m - step_m)) / (2.0 * step_m);
            assert!((slope / JOINT.stress_pa(closure_m) - 1.0).abs() < 1e-6, "{closure_m}");
            assert!((JOINT.closure_m(JOINT.stress_pa(closure_m)) / closure_m - 1.0).abs() < 1e-12);
        }
    }
}
