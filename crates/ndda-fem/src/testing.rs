//! Contract suites that a fork can run on its own laws.

use crate::material::{Material, Voigt};

/// Panics unless `material` keeps the contract of [`Material`].
pub fn check_material(material: &dyn Material) {
    let moduli = material.moduli();
    assert!(material.density_kg_m3() > 0.0, "density must be positive");
    assert!((moduli - moduli.transpose()).amax() <= 1e-12 * moduli.amax(), "moduli are not symmetric");
    assert!(nalgebra::Cholesky::new(moduli).is_some(), "moduli are not positive definite");

    let strain = Voigt::new(1e-4, -2e-4, 3e-4, -1e-4, 2e-4, 5e-5);
    let stress = material.stress(&strain);
    let step = 1e-4 * strain.amax();
    for i in 0..6 {
        let moved = |by: f64| {
            let mut shifted = strain;
            shifted[i] += by;
            shifted
        };
        let energy_slope =
            (material.energy_density(&moved(step)) - material.energy_density(&moved(-step))) / (2.0 * step);
        assert!((energy_slope - stress[i]).abs() <= 1e-6 * stress.amax(), "stress {i} is not ∂ψ/∂ε");
        let mut small = Voigt::zeros();
        small[i] = 1e-9;
        let stress_slope = (material.stress(&small) - material.stress(&-small)) / 2e-9;
        assert!((stress_slope - moduli.column(i)).amax() <= 1e-6 * moduli.amax(), "moduli {i} are not ∂σ/∂ε");
    }
    assert!(material.stress(&Voigt::zeros()).amax() == 0.0, "the undeformed material is under stress");
    if material.is_linear() {
        for factor in [1.0, 1e2, -1e2] {
            let off = (material.stress(&(factor * strain)) - factor * moduli * strain).amax();
            let size = factor.abs() * stress.amax();
            assert!(
                off <= 1e-12 * size,
                "it says that it is linear, and σ is not D ε: off by {off:e} of {size:e} Pa"
            );
        }
    }
    assert!(material.wave_speed_m_s() > 0.0);
}
