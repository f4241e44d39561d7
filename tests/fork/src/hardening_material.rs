//! A nonlinear elastic rock that stiffens as it is strained.

use nalgebra::Matrix6;
use ndda_fem::{LinearElastic, Material, Voigt};

/// ψ = ½ q + ¼ b q² with q = ε·D ε, so that σ = (1 + b q) D ε; softening for b < 0.
pub struct HardeningRock {
    linear: LinearElastic,
    hardening_per_pa: f64,
}

impl HardeningRock {
    /// Density [kg/m³], Young's modulus [Pa] and Poisson's ratio of the undeformed rock, and b [1/Pa].
    ///
    /// # Panics
    /// When these are no elastic constants.
    pub fn new(density_kg_m3: f64, young_pa: f64, poisson: f64, hardening_per_pa: f64) -> Self {
        let linear = LinearElastic::new(young_pa, poisson, density_kg_m3).expect("elastic constants");
        Self { linear, hardening_per_pa }
    }

    /// 1 + b q.
    fn stiffening(&self, strain: &Voigt) -> f64 {
        1.0 + self.hardening_per_pa * strain.dot(&(self.linear.moduli() * strain))
    }
}

impl Material for HardeningRock {
    fn density_kg_m3(&self) -> f64 {
        self.linear.density_kg_m3()
    }

    fn moduli(&self) -> Matrix6<f64> {
        self.linear.moduli()
    }

    fn is_linear(&self) -> bool {
        false
    }

    fn stress(&self, strain: &Voigt) -> Voigt {
        self.stiffening(strain) * (self.linear.moduli() * strain)
    }

    fn energy_density(&self, strain: &Voigt) -> f64 {
        let q = strain.dot(&(self.linear.moduli() * strain));
        0.5 * q + 0.25 * self.hardening_per_pa * q * q
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndda::build::Choices;
    use ndda::{Model, Run};
    use ndda_fem::testing::check_material;
    use std::path::Path;
    use std::sync::Arc;

    const BAR: &str = r#"Scene(
        title: "A bar under tension, damped to rest",
        time: (step_s: 1e-4, end_s: 0.3), gravity_m_s2: (0, 0, 0), contact: Off,
        materials: [(name: "rock", density_kg_m3: 2650, young_pa: 20e9, poisson: 0, damping: (mass_per_s: 600))],
        blocks: [(name: "bar", material: "rock", shape: Box(size_m: (2, 1, 1), cells: (2, 1, 1)))],
        supports: [(block: "bar", on: Plane(point_m: (0, 0, 0), normal: (1, 0, 0)), hold: Fixed)],
        tractions: [(block: "bar", on: Plane(point_m: (2, 0, 0), normal: (1, 0, 0)), traction_pa: (2e8, 0, 0))],
        monitors: [(name: "end", block: "bar", at: Point((2, 0.5, 0.5)))],
    )"#;

    #[test]
    fn it_keeps_the_contract_of_a_material() {
        check_material(&HardeningRock::new(2650.0, 20e9, 0.25, 1e-6));
        check_material(&HardeningRock::new(2650.0, 20e9, 0.25, -1e-6));
    }

    /// Without Poisson's ratio the bar is in uniaxial strain: σ = (1 + b E ε²) E ε.
    #[test]
    fn a_bar_is_stretched_as_its_law_says() {
        for b in [0.0, 2e-7, -2e-8] {
            let loaded = ndda_io::read::load_text("bar.ron", BAR, &[], None).unwrap();
            let rock: Arc<dyn Material> = Arc::new(ndda_fem::Damped {
                material: Arc::new(HardeningRock::new(2650.0, 20e9, 0.0, b)),
                damping: ndda_fem::Damping { mass_per_s: 600.0, stiffness_s: 0.0 },
            });
            let choices = Choices { materials: vec![("rock".into(), rock)], ..Choices::default() };
            let outcome =
                Run::new(Model::with(loaded, Path::new("."), choices).unwrap()).finish(&mut []).unwrap();
            let strain = outcome.monitor("end").unwrap().displacement[0] / 2.0;
            let stress_pa = (1.0 + b * 20e9 * strain * strain) * 20e9 * strain;
            assert!((stress_pa / 2e8 - 1.0).abs() < 1e-6, "b = {b}: {strain} bears {stress_pa:e} Pa");
        }
    }

    /// A law that stiffens and does not say so would be silently linear.
    #[test]
    #[should_panic(expected = "it says that it is linear")]
    fn a_nonlinear_law_that_says_it_is_linear_is_found_out() {
        struct Silent(HardeningRock);
        impl Material for Silent {
            fn density_kg_m3(&self) -> f64 {
                self.0.density_kg_m3()
            }

            fn moduli(&self) -> Matrix6<f64> {
                self.0.moduli()
            }

            fn stress(&self, strain: &Voigt) -> Voigt {
                self.0.stress(strain)
            }

            fn energy_density(&self, strain: &Voigt) -> f64 {
                self.0.energy_density(strain)
            }
        }
        check_material(&Silent(HardeningRock::new(2650.0, 20e9, 0.25, 1e-6)));
    }
}
