//! Any material with Rayleigh damping.

use std::sync::Arc;

use nalgebra::Matrix6;

use crate::material::{Damping, Material, Voigt};

/// A material that loses energy to damping.
pub struct Damped {
    /// The material without damping.
    pub material: Arc<dyn Material>,
    /// Its damping.
    pub damping: Damping,
}

impl Material for Damped {
    fn density_kg_m3(&self) -> f64 {
        self.material.density_kg_m3()
    }

    fn moduli(&self) -> Matrix6<f64> {
        self.material.moduli()
    }

    fn stress(&self, strain: &Voigt) -> Voigt {
        self.material.stress(strain)
    }

    fn energy_density(&self, strain: &Voigt) -> f64 {
        self.material.energy_density(strain)
    }

    fn is_linear(&self) -> bool {
        self.material.is_linear()
    }

    fn is_isotropic(&self) -> bool {
        self.material.is_isotropic()
    }

    fn damping(&self) -> Damping {
        self.damping
    }
}
