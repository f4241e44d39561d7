//! Isotropic linear elasticity.

use nalgebra::Matrix6;

use crate::material::Material;

/// Hooke's law, σ = λ tr(ε) I + 2 μ ε with λ = E ν / ((1 + ν)(1 − 2ν)), μ = E / (2 (1 + ν)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearElastic {
    young_pa: f64,
    poisson: f64,
    density_kg_m3: f64,
}

/// Why a material is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// Young's modulus must be positive.
    #[error("young_pa = {0} Pa: must be positive")]
    Young(f64),
    /// Poisson's ratio must leave bulk and shear modulus positive.
    #[error("poisson = {0}: must lie between −1 and 0.5, both excluded")]
    Poisson(f64),
    /// Density must be positive.
    #[error("density_kg_m3 = {0} kg/m³: must be positive")]
    Density(f64),
    /// Young's modulus across the beds must be positive.
    #[error("young_across_pa = {0} Pa: must be positive")]
    YoungAcross(f64),
    /// The shear modulus across the beds must be positive.
    #[error("shear_across_pa = {0} Pa: must be positive")]
    ShearAcross(f64),
    /// The beds need a normal.
    #[error("the normal of the bedding is zero: give a direction, such as (0, 0, 1) for level beds")]
    BeddingNormal,
    /// Some strain would give energy back.
    #[error(
        "poisson_across = {poisson_across}: its square must be below (1 − poisson) young_across_pa / (2 young_pa)"
    )]
    Unstable {
        /// ν′.
        poisson_across: f64,
    },
}

impl LinearElastic {
    /// A material with modulus E [Pa], Poisson's ratio ν and density ρ [kg/m³].
    ///
    /// # Errors
    /// [`MaterialError`] when a value is outside its range or not finite.
    pub fn new(young_pa: f64, poisson: f64, density_kg_m3: f64) -> Result<Self, MaterialError> {
        if !(young_pa > 0.0 && young_pa.is_finite()) {
            return Err(MaterialError::Young(young_pa));
        }
        if !(-1.0 < poisson && poisson < 0.5) {
            return Err(MaterialError::Poisson(poisson));
        }
        if !(density_kg_m3 > 0.0 && density_kg_m3.is_finite()) {
            return Err(MaterialError::Density(density_kg_m3));
        }
        Ok(Self { young_pa, poisson, density_kg_m3 })
    }

    /// Young's modulus E [Pa].
    pub fn young_pa(&self) -> f64 {
        self.young_pa
    }

    /// Poisson's ratio ν.
    pub fn poisson(&self) -> f64 {
        self.poisson
    }
}

impl Material for LinearElastic {
    fn density_kg_m3(&self) -> f64 {
        self.density_kg_m3
    }

    fn moduli(&self) -> Matrix6<f64> {
        let lame = self.young_pa * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson));
        let shear = self.young_pa / (2.0 * (1.0 + self.poisson));
        let mut moduli = Matrix6::zeros();
        for i in 0..3 {
            for j in 0..3 {
                moduli[(i, j)] = lame;
            }
            moduli[(i, i)] = lame + 2.0 * shear;
            moduli[(i + 3, i + 3)] = shear;
        }
        moduli
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Voigt;
    use crate::testing::check_material;

    #[test]
    fn it_keeps_the_contract_of_a_material() {
        check_material(&LinearElastic::new(200e9, 0.25, 2650.0).unwrap());
        check_material(&LinearElastic::new(1.0, -0.9, 1e-3).unwrap());
    }

    #[test]
    fn uniaxial_stress_gives_young_and_poisson_back() {
        let rock = LinearElastic::new(20e9, 0.3, 2650.0).unwrap();
        let strain = Voigt::new(1e-6, -0.3e-6, -0.3e-6, 0.0, 0.0, 0.0);
        let stress = rock.stress(&strain);
        assert!((stress[0] - 20e3).abs() < 1e-8 * 20e3);
        assert!(stress.rows(1, 5).amax() < 1e-8 * 20e3);
    }

    #[test]
    fn values_out_of_range_are_named() {
        assert_eq!(LinearElastic::new(0.0, 0.25, 1.0), Err(MaterialError::Young(0.0)));
        assert_eq!(LinearElastic::new(1.0, 0.5, 1.0), Err(MaterialError::Poisson(0.5)));
        assert!(LinearElastic::new(1.0, f64::NAN, 1.0).is_err());
        assert!(LinearElastic::new(1.0, 0.2, f64::INFINITY).is_err());
    }
}
