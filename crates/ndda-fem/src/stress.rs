//! Stress and volume change of elements, recovered only when somebody asks.

use ndda_mesh::geometry::tet_volume;
use ndda_mesh::{Mat3, Vec3};

use crate::block_operator::BlockOperator;
use crate::material::{Material, Voigt};
use crate::tet4::Tet4;

/// Cauchy stress per element in global axes, σ = R (D ε + σ₀) Rᵀ as (xx, yy, zz, xy, yz, zx) [Pa].
///
/// `displacement` is w = Rᵀ (x − c) − X per node, in the block's frame [m]; σ₀ is per element, or empty.
pub fn cauchy_stress(
    operator: &BlockOperator,
    material: &dyn Material,
    initial_pa: &[Voigt],
    rotation: &Mat3,
    displacement: &[Vec3],
    out: &mut [[f64; 6]],
) {
    for (e, (tet, out)) in operator.tets.iter().zip(out).enumerate() {
        let element = Tet4::new(&tet.map(|n| operator.rest[n as usize]));
        let mut stress = material.stress(&element.strain(&tet.map(|n| displacement[n as usize])));
        if let Some(initial) = initial_pa.get(e) {
            stress += initial;
        }
        *out = rotated(&stress, rotation);
    }
}

/// The von Mises stress √(½ [(xx − yy)² + (yy − zz)² + (zz − xx)²] + 3 [xy² + yz² + zx²]) \[Pa\].
pub fn von_mises_pa(stress_pa: &[f64; 6]) -> f64 {
    let [xx, yy, zz, xy, yz, zx] = *stress_pa;
    let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    let shear = xy * xy + yz * yz + zx * zx;
    (0.5 * normal + 3.0 * shear).sqrt()
}

/// Adds ∫Bᵀ σ dV of a stress that is a function of the strain, w being in the block's frame [m].
pub fn add_stress_force(
    operator: &BlockOperator,
    stress_pa: impl Fn(&Voigt) -> Voigt,
    displacement: &[Vec3],
    force: &mut [Vec3],
) {
    for tet in &operator.tets {
        let element = Tet4::new(&tet.map(|n| operator.rest[n as usize]));
        let stress_pa = stress_pa(&element.strain(&tet.map(|n| displacement[n as usize])));
        for (a, &n) in tet.iter().enumerate() {
            force[n as usize] += element.stress_force(&stress_pa, a);
        }
    }
}

/// ∫ ψ dV of an energy density that is a function of the strain [J].
pub fn energy_of_strain(
    operator: &BlockOperator,
    density_j_m3: impl Fn(&Voigt) -> f64,
    displacement: &[Vec3],
) -> f64 {
    let energy = |tet: &[u32; 4]| {
        let element = Tet4::new(&tet.map(|n| operator.rest[n as usize]));
        element.volume_m3 * density_j_m3(&element.strain(&tet.map(|n| displacement[n as usize])))
    };
    operator.tets.iter().map(energy).sum()
}

/// R σ Rᵀ in Voigt order.
fn rotated(stress: &Voigt, rotation: &Mat3) -> [f64; 6] {
    let [xx, yy, zz, xy, yz, zx] = *stress.as_ref();
    let turned = rotation * Mat3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz) * rotation.transpose();
    [turned[(0, 0)], turned[(1, 1)], turned[(2, 2)], turned[(0, 1)], turned[(1, 2)], turned[(2, 0)]]
}

/// Smallest det F over the elements, and the element that has it.
pub fn smallest_volume_ratio(operator: &BlockOperator, position: &[Vec3]) -> (f64, usize) {
    let ratio = |tet: &[u32; 4]| {
        let rest = tet_volume(&tet.map(|n| operator.rest[n as usize]));
        tet_volume(&tet.map(|n| position[n as usize])) / rest
    };
    let smaller = |best: (f64, usize), next: (f64, usize)| if next.0 < best.0 { next } else { best };
    let ratios = operator.tets.iter().enumerate().map(|(i, tet)| (ratio(tet), i));
    ratios.fold((f64::INFINITY, 0), smaller)
}

/// Largest principal strain, by absolute value, over the elements: an eigenvalue of ½ (∇w + ∇wᵀ) for w in the block's frame [m]. Parts that turn by θ
/// against the frame show 1 − cos θ.
pub fn largest_strain(operator: &BlockOperator, displacement: &[Vec3]) -> f64 {
    let strain = |tet: &[u32; 4]| {
        let element = Tet4::new(&tet.map(|n| operator.rest[n as usize]));
        let [xx, yy, zz, xy, yz, zx] = *element.strain(&tet.map(|n| displacement[n as usize])).as_ref();
        let (xy, yz, zx) = (0.5 * xy, 0.5 * yz, 0.5 * zx);
        Mat3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz).symmetric_eigenvalues().amax()
    };
    operator.tets.iter().map(strain).fold(0.0, f64::max)
}

/// Volume of the block at these positions [m³].
pub fn volume_m3(operator: &BlockOperator, position: &[Vec3]) -> f64 {
    let center = operator.center(position);
    operator.tets.iter().map(|tet| tet_volume(&tet.map(|n| position[n as usize] - center))).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear_elastic::LinearElastic;

    #[test]
    fn stress_turns_with_the_block_and_volume_ratio_sees_compression() {
        let nodes = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
        let rock = LinearElastic::new(1e9, 0.0, 2e3).unwrap();
        let operator = BlockOperator::new(&nodes, vec![[0, 1, 2, 3]], &rock);
        let w: Vec<Vec3> = operator.rest.iter().map(|x| Vec3::new(1e-3 * x.x, 0.0, 0.0)).collect();
        let quarter = Mat3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
        let mut stress = [[0.0; 6]];
        let initial = Voigt::new(0.0, 0.0, 5.0, 0.0, 0.0, 0.0);
        cauchy_stress(&operator, &rock, &[initial], &quarter, &w, &mut stress);
        assert!((stress[0][1] - 1e6).abs() < 1e-6 && stress[0][0].abs() < 1e-6 && stress[0][2] == 5.0);

        assert!((largest_strain(&operator, &w) - 1e-3).abs() < 1e-15);
        // Pure shear: γ = 2e-3 has the principal strains ± 1e-3.
        let w: Vec<Vec3> = operator.rest.iter().map(|x| Vec3::new(2e-3 * x.y, 0.0, 0.0)).collect();
        assert!((largest_strain(&operator, &w) - 1e-3).abs() < 1e-15);

        let half: Vec<Vec3> = nodes.iter().map(|x| Vec3::new(x.x, 0.5 * x.y, x.z)).collect();
        assert_eq!(smallest_volume_ratio(&operator, &half), (0.5, 0));
        assert!((volume_m3(&operator, &half) - 1.0 / 12.0).abs() < 1e-16);
    }

    #[test]
    fn von_mises_is_the_axial_stress_in_tension_and_root_three_times_pure_shear() {
        assert_eq!(von_mises_pa(&[7.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 7.0);
        assert_eq!(von_mises_pa(&[5.0, 5.0, 5.0, 0.0, 0.0, 0.0]), 0.0);
        assert!((von_mises_pa(&[0.0, 0.0, 0.0, 0.0, 2.0, 0.0]) - 2.0 * 3f64.sqrt()).abs() < 1e-15);
    }
}
