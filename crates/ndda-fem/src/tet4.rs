//! The four-node tetrahedron: constant strain, consistent mass (the paper's eqs 1–6).

use nalgebra::Matrix6;
use ndda_mesh::{Mat3, Vec3};

use crate::material::Voigt;

/// Gradients of the shape functions and the volume, both constant over the element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tet4 {
    /// ∇Nₐ per node [1/m].
    pub gradients: [Vec3; 4],
    /// Volume [m³].
    pub volume_m3: f64,
}

impl Tet4 {
    /// The element with these corners [m]; its volume must be positive.
    #[inline]
    pub fn new(corners: &[Vec3; 4]) -> Self {
        let edges = Mat3::from_columns(&[1, 2, 3].map(|i| corners[i] - corners[0]));
        let volume_m3 = edges.determinant() / 6.0;
        assert!(volume_m3 > 0.0, "element with volume {volume_m3} m³: the mesh was not validated");
        // Rows of the inverse are ∇N₁, ∇N₂, ∇N₃; the gradients sum to zero.
        let (a, b, c) = (edges.column(0), edges.column(1), edges.column(2));
        let scale = 1.0 / (6.0 * volume_m3);
        let (g1, g2, g3) = (b.cross(&c) * scale, c.cross(&a) * scale, a.cross(&b) * scale);
        Self { gradients: [-(g1 + g2 + g3), g1, g2, g3], volume_m3 }
    }

    /// Small strain of nodal displacements, ε = Σ Bₐ uₐ, with engineering shears.
    #[inline]
    pub fn strain(&self, displacement: &[Vec3; 4]) -> Voigt {
        let mut gradient = Mat3::zeros();
        for (u, g) in displacement.iter().zip(&self.gradients) {
            gradient += u * g.transpose();
        }
        Voigt::new(
            gradient[(0, 0)],
            gradient[(1, 1)],
            gradient[(2, 2)],
            gradient[(0, 1)] + gradient[(1, 0)],
            gradient[(1, 2)] + gradient[(2, 1)],
            gradient[(2, 0)] + gradient[(0, 2)],
        )
    }

    /// Stiffness between nodes a and b, V Bₐᵀ D B_b [N/m].
    #[inline]
    pub fn stiffness(&self, moduli: &Matrix6<f64>, a: usize, b: usize) -> Mat3 {
        let (ba, bb) = (strain_operator(&self.gradients[a]), strain_operator(&self.gradients[b]));
        self.volume_m3 * ba.transpose() * moduli * bb
    }

    /// Consistent mass between nodes a and b, ρ V (1 + δ_ab) / 20 [kg].
    #[inline]
    pub fn mass(&self, density_kg_m3: f64, a: usize, b: usize) -> f64 {
        density_kg_m3 * self.volume_m3 * if a == b { 0.1 } else { 0.05 }
    }

    /// Nodal force that balances a stress, V Bₐᵀ σ [N].
    #[inline]
    pub fn stress_force(&self, stress: &Voigt, a: usize) -> Vec3 {
        self.volume_m3 * strain_operator(&self.gradients[a]).transpose() * stress
    }
}

/// B of one node: (εxx, εyy, εzz, γxy, γyz, γzx) from its displacement.
#[rustfmt::skip]
fn strain_operator(g: &Vec3) -> nalgebra::Matrix6x3<f64> {
    nalgebra::Matrix6x3::new(
        g.x, 0.0, 0.0,
        0.0, g.y, 0.0,
        0.0, 0.0, g.z,
        g.y, g.x, 0.0,
        0.0, g.z, g.y,
        g.z, 0.0, g.x,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear_elastic::LinearElastic;
    use crate::material::Material;

    fn skewed() -> Tet4 {
        Tet4::new(&[
            Vec3::new(0.1, 0.0, 0.2),
            Vec3::new(1.0, 0.2, 0.0),
            Vec3::new(0.0, 1.3, 0.1),
            Vec3::new(0.2, 0.1, 0.9),
        ])
    }

    #[test]
    fn a_linear_displacement_gives_its_strain() {
        let corners = [
            Vec3::new(0.1, 0.0, 0.2),
            Vec3::new(1.0, 0.2, 0.0),
            Vec3::new(0.0, 1.3, 0.1),
            Vec3::new(0.2, 0.1, 0.9),
        ];
        let gradient = Mat3::new(1.0, 2.0, 3.0, -1.0, 0.5, 0.2, 0.7, 0.1, -2.0);
        let strain = skewed().strain(&corners.map(|x| gradient * x));
        assert!((strain - Voigt::new(1.0, 0.5, -2.0, 1.0, 0.3, 3.7)).amax() < 1e-13);
    }

    #[test]
    fn stiffness_does_not_resist_rigid_motion_and_is_symmetric() {
        let (element, moduli) = (skewed(), LinearElastic::new(1.0, 0.25, 1.0).unwrap().moduli());
        for a in 0..4 {
            let row_sum: Mat3 = (0..4).map(|b| element.stiffness(&moduli, a, b)).sum();
            assert!(row_sum.amax() < 1e-14);
            for b in 0..4 {
                let k_ab = element.stiffness(&moduli, a, b);
                assert!((k_ab - element.stiffness(&moduli, b, a).transpose()).amax() < 1e-15);
            }
        }
    }

    #[test]
    fn the_element_carries_its_mass() {
        let element = skewed();
        let total: f64 = (0..16).map(|i| element.mass(2650.0, i / 4, i % 4)).sum();
        assert!((total - 2650.0 * element.volume_m3).abs() < 1e-12 * total);
    }
}
