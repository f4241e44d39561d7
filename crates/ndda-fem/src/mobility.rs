//! How much contact can accelerate the nodes of a block that moves as a whole.

use ndda_mesh::geometry::tet_volume;
use ndda_mesh::{Mat3, Vec3};

/// Mobility of the nodes of a block that moves by a rigid motion or an affine map, wᵢ = 1/m + Xᵢ·G⁻¹ Xᵢ [1/kg], with the arm X from the mass centre and
/// G = ∫ρ X Xᵀ dV: a force f on node i makes that node, and with it the block, faster by wᵢ f at most.
///
/// Springs kᵢ at the nodes then give the block oscillations of ω² ≤ Σᵢ kᵢ wᵢ, the trace of M⁻¹ K, which is at most four times the largest ω². Masses of
/// single nodes give the bound max kᵢ/mᵢ, which is far too large where an element is small.
pub fn mobility(position: &[Vec3], tets: &[[u32; 4]], mass_kg: f64) -> Vec<f64> {
    let corners = |tet: &[u32; 4]| tet.map(|n| position[n as usize]);
    let volumes: Vec<f64> = tets.iter().map(|tet| tet_volume(&corners(tet))).collect();
    let volume: f64 = volumes.iter().sum();
    let sum = |tet: &[u32; 4]| corners(tet).iter().sum::<Vec3>();
    let center = tets.iter().zip(&volumes).map(|(tet, v)| 0.25 * *v * sum(tet)).sum::<Vec3>() / volume;
    let mut second = Mat3::zeros();
    for (tet, v) in tets.iter().zip(&volumes) {
        let arms = corners(tet).map(|x| x - center);
        let sum: Vec3 = arms.iter().sum();
        let squares: Mat3 = arms.iter().map(|arm| arm * arm.transpose()).sum();
        second += *v / 20.0 * (squares + sum * sum.transpose());
    }
    let inverse = (mass_kg / volume * second).try_inverse().unwrap_or_else(Mat3::zeros);
    position.iter().map(|x| x - center).map(|arm| 1.0 / mass_kg + arm.dot(&(inverse * arm))).collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix4, Vector4};
    use ndda_mesh::generate::{BoxPattern, box_block};

    use super::*;
    use crate::{BlockOperator, LinearElastic};

    #[test]
    fn the_bound_is_between_the_largest_frequency_and_four_times_its_square() {
        let mesh = box_block([3.0, 1.0, 0.4], [3, 2, 1], BoxPattern::Six).unwrap();
        let rock = LinearElastic::new(1e9, 0.25, 2500.0).unwrap();
        let operator = BlockOperator::new(&mesh.nodes, mesh.tets.clone(), &rock);
        let w = mobility(&mesh.nodes, &mesh.tets, operator.mass_kg);
        for seed in 0..20u32 {
            let k = |i: usize| f64::from((i as u32 * 7919 + seed * 40_503) % 1009);
            // Of each component: K = Σ k (1, X)(1, X)ᵀ and the consistent mass of affine maps.
            let basis =
                |i: usize| Vector4::new(1.0, operator.rest[i].x, operator.rest[i].y, operator.rest[i].z);
            let mut stiffness = Matrix4::zeros();
            let mut mass = Matrix4::zeros();
            for i in 0..operator.nodes() {
                stiffness += k(i) * basis(i) * basis(i).transpose();
                for (j, _, m) in operator.row(i) {
                    mass += m * basis(i) * basis(j).transpose();
                }
            }
            let root = mass.cholesky().unwrap().l().try_inverse().unwrap();
            let largest = (root * stiffness * root.transpose()).symmetric_eigenvalues().max();
            let bound: f64 = w.iter().enumerate().map(|(i, w)| k(i) * w).sum();
            assert!(
                largest <= bound * (1.0 + 1e-9) && bound <= 4.0 * largest * (1.0 + 1e-9),
                "{largest} {bound}"
            );
        }
    }
}
