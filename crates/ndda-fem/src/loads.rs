//! External loads on the nodes of a block, as consistent nodal forces (eq 6).

use ndda_mesh::Vec3;
use ndda_mesh::geometry::triangle_area_vector;

use crate::block_operator::BlockOperator;
use crate::material::Voigt;
use crate::tet4::Tet4;

/// Adds the weight, ∫ Nᵀ ρ g dV = mᵢ g [N].
pub fn add_gravity(operator: &BlockOperator, gravity_m_s2: &Vec3, force: &mut [Vec3]) {
    for (f, &m) in force.iter_mut().zip(&operator.node_mass) {
        *f += m * gravity_m_s2;
    }
}

/// Adds a traction on triangles, ∫ Nᵀ t dA = t A / 3 per corner [N]; areas are those of `rest`.
pub fn add_traction(triangles: &[[u32; 3]], rest: &[Vec3], traction_pa: &Vec3, force: &mut [Vec3]) {
    for triangle in triangles {
        let area = triangle_area_vector(&triangle.map(|n| rest[n as usize])).norm();
        for &n in triangle {
            force[n as usize] += traction_pa * (area / 3.0);
        }
    }
}

/// A stress that is there before anything moves, σ₀ = σ + G (x − at).
#[derive(Clone, Debug, PartialEq)]
pub struct InitialStress {
    /// σ [Pa].
    pub stress_pa: Voigt,
    /// Where it is that [m].
    pub at: Vec3,
    /// Its change per metre along x, y and z [Pa/m].
    pub gradient_pa_m: [Voigt; 3],
}

impl InitialStress {
    /// A uniform stress.
    pub fn uniform(stress_pa: Voigt) -> Self {
        Self { stress_pa, at: Vec3::zeros(), gradient_pa_m: [Voigt::zeros(); 3] }
    }

    /// Its value in each element of a block, at the centroid: exact in the mean.
    pub fn of_elements(&self, operator: &BlockOperator, position: &[Vec3]) -> Vec<Voigt> {
        let stress = |tet: &[u32; 4]| {
            let x = tet.iter().map(|&n| position[n as usize]).sum::<Vec3>() / 4.0 - self.at;
            (0..3).fold(self.stress_pa, |sum, i| sum + self.gradient_pa_m[i] * x[i])
        };
        operator.tets.iter().map(stress).collect()
    }
}

/// ∫ Bᵀ σ₀ dV per node in the block's frame [N], σ₀ being one stress per element.
///
/// With σ = D ε + σ₀ (tension positive) it stands on the side of K d, so the load is its negative: the sign that
/// eq (6) prints is wrong.
pub fn initial_stress_force(operator: &BlockOperator, stress_pa: &[Voigt]) -> Vec<Vec3> {
    let mut force = vec![Vec3::zeros(); operator.nodes()];
    for (tet, stress_pa) in operator.tets.iter().zip(stress_pa) {
        let element = Tet4::new(&tet.map(|n| operator.rest[n as usize]));
        for (a, &n) in tet.iter().enumerate() {
            force[n as usize] += element.stress_force(stress_pa, a);
        }
    }
    force
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear_elastic::LinearElastic;

    fn corner() -> BlockOperator {
        let nodes = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
        BlockOperator::new(&nodes, vec![[0, 1, 2, 3]], &LinearElastic::new(1e9, 0.2, 6e3).unwrap())
    }

    #[test]
    fn the_weight_is_the_mass_times_gravity() {
        let mut force = vec![Vec3::zeros(); 4];
        add_gravity(&corner(), &Vec3::new(0.0, 0.0, -10.0), &mut force);
        assert!((force.iter().sum::<Vec3>() - Vec3::new(0.0, 0.0, -1e4)).norm() < 1e-9);
    }

    #[test]
    fn a_tensile_initial_stress_pulls_the_faces_together() {
        // Free of supports, a block under tension σ₀ contracts: the load −∫Bᵀσ₀ points inward.
        let force = initial_stress_force(&corner(), &[Voigt::new(6.0, 0.0, 0.0, 0.0, 0.0, 0.0)]);
        assert!((-force[1] - Vec3::new(-1.0, 0.0, 0.0)).norm() < 1e-15);
        assert!(force.iter().sum::<Vec3>().norm() < 1e-15);
    }

    #[test]
    fn a_traction_adds_up_to_its_area() {
        let mut force = vec![Vec3::zeros(); 4];
        add_traction(&[[0, 2, 1]], &corner().rest, &Vec3::new(0.0, 0.0, 5.0), &mut force);
        assert!((force.iter().sum::<Vec3>() - Vec3::new(0.0, 0.0, 2.5)).norm() < 1e-14);
    }
}
