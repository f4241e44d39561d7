//! Normal closure of one joint.

use serde::Serialize;

use super::path::steps;
use super::{Comparison, JointError, NormalStiffness, positive};

/// Points and weights of a rule on 0…1 that is exact to degree 9 (Gauss–Legendre).
const RULE: [[f64; 2]; 5] = [
    [0.046_910_077_030_668, 0.118_463_442_528_095],
    [0.230_765_344_947_158, 0.239_314_335_249_683],
    [0.5, 0.284_444_444_444_444],
    [0.769_234_655_052_842, 0.239_314_335_249_683],
    [0.953_089_922_969_332, 0.118_463_442_528_095],
];

/// A joint that is pressed to a normal stress in equal steps of closure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosureTest {
    /// Normal stress at the end [Pa].
    pub stress_pa: f64,
    /// How the joint closes.
    pub normal: NormalStiffness,
    /// Steps.
    pub steps: u32,
}

/// The joint after a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ClosureRow {
    /// Closure V [m].
    pub closure_m: f64,
    /// Normal stress σ [Pa].
    pub normal_pa: f64,
    /// Tangent stiffness by differences of the stress [Pa/m].
    pub tangent_pa_m: f64,
    /// Energy ∫ σ dV by quadrature [J/m²].
    pub energy_j_m2: f64,
}

impl ClosureTest {
    /// Presses the joint.
    ///
    /// # Errors
    /// [`JointError`]: numbers that a test cannot begin with, or a joint that does not close.
    pub fn run(&self) -> Result<Vec<ClosureRow>, JointError> {
        positive("the normal stress", self.stress_pa)?;
        steps(u64::from(self.steps))?;
        self.normal.check()?;
        if self.normal == NormalStiffness::Rigid {
            return Err(JointError::NoStiffness);
        }
        let most_m = self.normal.closure_m(self.stress_pa);
        let (step_m, mut energy_j_m2) = (most_m / f64::from(self.steps), 0.0);
        let row = |k: u32| {
            let closure_m = step_m * f64::from(k);
            if k > 0 {
                let at = |part: f64| self.normal.stress_pa(closure_m - (1.0 - part) * step_m);
                energy_j_m2 += step_m * RULE.iter().map(|[x, weight]| weight * at(*x)).sum::<f64>();
            }
            let near_m = 1e-4 * step_m;
            let ahead = self.normal.stress_pa(closure_m + near_m);
            let behind = self.normal.stress_pa(closure_m - near_m);
            let tangent_pa_m = (ahead - behind) / (2.0 * near_m);
            ClosureRow { closure_m, normal_pa: self.normal.stress_pa(closure_m), tangent_pa_m, energy_j_m2 }
        };
        Ok((0..=self.steps).map(row).collect())
    }
}

/// The end of a test beside its closed form.
pub fn comparisons(test: &ClosureTest, rows: &[ClosureRow]) -> Vec<Comparison> {
    let Some(end) = rows.last() else { return Vec::new() };
    let closure_m = test.normal.closure_m(test.stress_pa);
    vec![
        Comparison::new("normal stress at the end", "Pa", end.normal_pa, test.stress_pa),
        Comparison::new(
            "tangent stiffness there",
            "Pa/m",
            end.tangent_pa_m,
            test.normal.tangent_pa_m(test.stress_pa),
        ),
        Comparison::new("energy of the closure", "J/m²", end.energy_j_m2, test.normal.energy_j_m2(closure_m)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stress_stiffness_and_energy_of_a_test_are_those_of_the_closed_form() {
        let joint = NormalStiffness::Hyperbolic { initial_pa_m: 20e9, most_m: 0.3e-3 };
        for (stress_pa, closure_mm, energy_j_m2) in
            [(1e6, 0.042_857, 20.328), (2e6, 0.075, 67.828), (10e6, 0.1875, 640.49)]
        {
            let test = ClosureTest { stress_pa, normal: joint, steps: 50 };
            let rows = test.run().expect("a test");
            let end = rows[50];
            assert!((1e3 * end.closure_m / closure_mm - 1.0).abs() < 1e-5);
            assert!((end.energy_j_m2 / energy_j_m2 - 1.0).abs() < 2e-5);
            for found in comparisons(&test, &rows) {
                let limit = if found.what.contains("tangent") { 1e-6 } else { 1e-9 };
                assert!(found.error < limit, "{found:?}");
            }
        }
    }

    #[test]
    fn a_joint_that_does_not_close_is_refused() {
        let test = ClosureTest { stress_pa: 1e6, normal: NormalStiffness::Rigid, steps: 10 };
        assert_eq!(test.run(), Err(JointError::NoStiffness));
        let linear = NormalStiffness::Linear { stiffness_pa_m: 1e9 };
        assert!(ClosureTest { stress_pa: 0.0, normal: linear, ..test }.run().is_err());
        assert!(ClosureTest { normal: linear, steps: 0, ..test }.run().is_err());
    }
}
