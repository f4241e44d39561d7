//! Bedded rock: one stiffness along the beds, another across.

use nalgebra::{Cholesky, Matrix6};
use ndda_mesh::Vec3;

use crate::linear_elastic::{LinearElastic, MaterialError};
use crate::material::Material;

/// Linear elasticity with an axis n of symmetry, the normal of the beds (Lekhnitskii 1963; Amadei 1983).
///
/// ```text
/// ε_p = σ_p/E − ν σ_q/E − ν′ σ_n/E′      p, q in the beds
/// ε_n = σ_n/E′ − ν′ (σ_p + σ_q)/E′       γ_pn = τ_pn/G′,  γ_pq = 2 (1 + ν) τ_pq/E
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TransverselyIsotropic {
    moduli: Matrix6<f64>,
    density_kg_m3: f64,
}

/// Moduli of a bedded rock across its beds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bedding {
    /// Normal n of the beds in the axes of the scene at rest; its length does not matter.
    pub normal: Vec3,
    /// E′, Young's modulus across the beds [Pa].
    pub young_across_pa: f64,
    /// ν′: strain along the beds over that across, under a stress across.
    pub poisson_across: f64,
    /// G′, shear modulus across the beds [Pa].
    pub shear_across_pa: f64,
}

impl TransverselyIsotropic {
    /// A rock that is `along` in its beds and `bedding` across them.
    ///
    /// # Errors
    /// [`MaterialError`] naming the value that is out of its range, or that all of them together store no energy.
    pub fn new(along: &LinearElastic, bedding: &Bedding) -> Result<Self, MaterialError> {
        let Bedding { normal, young_across_pa, poisson_across, shear_across_pa } = *bedding;
        if !(young_across_pa > 0.0 && young_across_pa.is_finite()) {
            return Err(MaterialError::YoungAcross(young_across_pa));
        }
        if !(shear_across_pa > 0.0 && shear_across_pa.is_finite()) {
            return Err(MaterialError::ShearAcross(shear_across_pa));
        }
        if !(normal.norm() > 0.0 && normal.norm().is_finite()) {
            return Err(MaterialError::BeddingNormal);
        }
        let compliance = compliance(along, bedding);
        let unstable = MaterialError::Unstable { poisson_across };
        // In units of 1/E, so that the inverse is well scaled.
        let scaled = compliance * along.young_pa();
        let local = Cholesky::new(scaled).ok_or(unstable)?.inverse() * along.young_pa();
        let turn = voigt_rotation(&normal.normalize());
        let moduli = turn * local * turn.transpose();
        if Cholesky::new(moduli / along.young_pa()).is_none() {
            return Err(unstable);
        }
        Ok(Self { moduli: 0.5 * (moduli + moduli.transpose()), density_kg_m3: along.density_kg_m3() })
    }
}

/// ε = S σ with the third axis across the beds.
fn compliance(along: &LinearElastic, bedding: &Bedding) -> Matrix6<f64> {
    let (young, poisson) = (along.young_pa(), along.poisson());
    let mut s = Matrix6::zeros();
    (s[(0, 0)], s[(1, 1)], s[(2, 2)]) = (1.0 / young, 1.0 / young, 1.0 / bedding.young_across_pa);
    (s[(0, 1)], s[(1, 0)]) = (-poisson / young, -poisson / young);
    for p in 0..2 {
        let across = -bedding.poisson_across / bedding.young_across_pa;
        (s[(p, 2)], s[(2, p)]) = (across, across);
    }
    s[(3, 3)] = 2.0 * (1.0 + poisson) / young;
    (s[(4, 4)], s[(5, 5)]) = (1.0 / bedding.shear_across_pa, 1.0 / bedding.shear_across_pa);
    s
}

/// T with σ = T σ′ for a frame whose third axis is n: σ_ij = Σ R_ik R_jl σ′_kl.
fn voigt_rotation(n: &Vec3) -> Matrix6<f64> {
    const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)];
    let across = if n.x.abs() < 0.7 { Vec3::x() } else { Vec3::y() };
    let first = n.cross(&across).normalize();
    let axes = [first, n.cross(&first), *n];
    Matrix6::from_fn(|row, column| {
        let ((i, j), (k, l)) = (PAIRS[row], PAIRS[column]);
        let straight = axes[k][i] * axes[l][j];
        if k == l { straight } else { straight + axes[l][i] * axes[k][j] }
    })
}

impl Material for TransverselyIsotropic {
    fn density_kg_m3(&self) -> f64 {
        self.density_kg_m3
    }

    fn moduli(&self) -> Matrix6<f64> {
        self.moduli
    }

    fn is_isotropic(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::check_material;

    fn shale(normal: Vec3) -> (LinearElastic, Bedding) {
        let along = LinearElastic::new(30e9, 0.2, 2500.0).unwrap();
        (along, Bedding { normal, young_across_pa: 12e9, poisson_across: 0.15, shear_across_pa: 5e9 })
    }

    #[test]
    fn it_keeps_the_contract_of_a_material() {
        let (along, bedding) = shale(Vec3::new(0.3, -0.5, 0.8));
        check_material(&TransverselyIsotropic::new(&along, &bedding).unwrap());
    }

    #[test]
    fn equal_moduli_along_and_across_are_isotropic_whatever_the_normal() {
        let along = LinearElastic::new(20e9, 0.3, 2600.0).unwrap();
        let normal = Vec3::new(-0.2, 0.9, 0.4);
        let shear_across_pa = 20e9 / 2.6;
        let bedding = Bedding { normal, young_across_pa: 20e9, poisson_across: 0.3, shear_across_pa };
        let rock = TransverselyIsotropic::new(&along, &bedding).unwrap();
        assert!((rock.moduli() - along.moduli()).amax() < 1e-14 * along.moduli().amax() * 10.0);
    }

    #[test]
    fn a_core_at_an_angle_to_the_beds_has_the_modulus_of_the_closed_form() {
        // 1/E(β) = sin⁴β/E + cos⁴β/E′ + (1/G′ − 2ν′/E′) sin²β cos²β, β from the normal to the load.
        for degrees in [0.0f64, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0] {
            let (s, c) = degrees.to_radians().sin_cos();
            let (along, bedding) = shale(Vec3::new(c, 0.6 * s, 0.8 * s));
            let rock = TransverselyIsotropic::new(&along, &bedding).unwrap();
            let compliance = rock.moduli().try_inverse().unwrap();
            let mixed = 1.0 / 5e9 - 2.0 * 0.15 / 12e9;
            let expected = s.powi(4) / 30e9 + c.powi(4) / 12e9 + mixed * (s * c).powi(2);
            assert!((compliance[(0, 0)] / expected - 1.0).abs() < 1e-12, "{degrees}°");
        }
    }

    #[test]
    fn values_that_store_no_energy_are_refused() {
        let (along, bedding) = shale(Vec3::z());
        let with =
            |poisson_across: f64| TransverselyIsotropic::new(&along, &Bedding { poisson_across, ..bedding });
        // ν′² < (1 − ν) E′/2E is what a positive energy requires.
        let most = ((1.0 - 0.2) * 12.0 / 60.0f64).sqrt();
        assert!(with(0.999 * most).is_ok());
        assert_eq!(with(1.001 * most), Err(MaterialError::Unstable { poisson_across: 1.001 * most }));
        let soft = Bedding { young_across_pa: -1.0, ..bedding };
        assert_eq!(TransverselyIsotropic::new(&along, &soft), Err(MaterialError::YoungAcross(-1.0)));
        let nowhere = Bedding { normal: Vec3::zeros(), ..bedding };
        assert_eq!(TransverselyIsotropic::new(&along, &nowhere), Err(MaterialError::BeddingNormal));
    }
}
