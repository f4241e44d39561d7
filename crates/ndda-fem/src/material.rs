//! The contract of a material law.

use nalgebra::{Matrix6, Vector6};

/// Strain or stress as (xx, yy, zz, xy, yz, zx); shear strains are engineering strains, γ = 2 ε.
pub type Voigt = Vector6<f64>;

/// Rayleigh damping, C = a M + b K: a mode of frequency ω is damped by ζ = a/2ω + b ω/2 of critical.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damping {
    /// a [1/s]: drags on every motion, that of a block as a whole, too.
    pub mass_per_s: f64,
    /// b [s]: resists deformation.
    pub stiffness_s: f64,
}

/// A hyperelastic law for small strains in the block's frame.
///
/// Contract (checked by [`check_material`](crate::testing::check_material)): stress is the derivative of the
/// energy density, moduli are the derivative of the stress of the undeformed material, symmetric and positive definite; a law that says that
/// it is linear has σ = D ε at any strain. Others are iterated on in each step, which converges while no tangent modulus is above twice `moduli`.
pub trait Material: Send + Sync {
    /// Density ρ [kg/m³].
    fn density_kg_m3(&self) -> f64;

    /// Tangent moduli D of the undeformed material [Pa].
    fn moduli(&self) -> Matrix6<f64>;

    /// Stress at a strain [Pa].
    fn stress(&self, strain: &Voigt) -> Voigt {
        self.moduli() * strain
    }

    /// Elastic energy per volume at a strain [J/m³].
    fn energy_density(&self, strain: &Voigt) -> f64 {
        0.5 * strain.dot(&self.stress(strain))
    }

    /// Whether σ = D ε at any strain.
    fn is_linear(&self) -> bool {
        true
    }

    /// Whether the moduli are the same in all directions; where they are not, a block that is turned is another block.
    fn is_isotropic(&self) -> bool {
        true
    }

    /// Its damping.
    fn damping(&self) -> Damping {
        Damping::default()
    }

    /// Fastest wave, c = √(max Dᵢᵢ / ρ) over the normal components [m/s].
    fn wave_speed_m_s(&self) -> f64 {
        let moduli = self.moduli();
        let stiffest = (0..3).map(|i| moduli[(i, i)]).fold(0.0, f64::max);
        (stiffest / self.density_kg_m3()).sqrt()
    }
}
