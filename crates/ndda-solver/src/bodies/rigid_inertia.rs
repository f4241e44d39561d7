//! Inertia of a rigid block.

use ndda_fem::BlockOperator;
use ndda_mesh::{Mat3, Vec3};

/// Inertia of a rigid block in its rest frame.
#[derive(Clone, Debug)]
pub struct RigidInertia {
    /// J about the mass centre [kg m²].
    pub(crate) inertia: Mat3,
    pub(super) inverse: Mat3,
    /// Inverse of the inertia of lumped masses: gives the spin of a rigid field of velocities from their moment.
    pub(super) inverse_lumped: Mat3,
}

impl RigidInertia {
    /// Of a block with these node masses and rest positions.
    pub(crate) fn new(operator: &BlockOperator) -> Self {
        let inertia = operator.inertia(&operator.rest, &operator.rest);
        let weighted = operator.node_mass.iter().zip(&operator.rest);
        let moment: Mat3 = weighted.map(|(&m, x)| m * x * x.transpose()).sum();
        let lumped = Mat3::identity() * moment.trace() - moment;
        let inverse = |m: Mat3| m.try_inverse().expect("a validated block is not flat");
        Self { inertia, inverse: inverse(inertia), inverse_lumped: inverse(lumped) }
    }

    /// R J⁻¹ Rᵀ of a block turned by R [1/(kg m²)].
    pub(crate) fn inverse_turned(&self, rotation: &Mat3) -> Mat3 {
        rotation * self.inverse * rotation.transpose()
    }

    /// dω/dt of a block that turns freely, as seen in its frame, J⁻¹ (J ω × ω) [rad/s²].
    pub(crate) fn change_of_spin(&self, spin: &Vec3) -> Vec3 {
        self.inverse * (self.inertia * spin).cross(spin)
    }
}

/// r J⁻¹, r being the distance of the farthest node from the mass centre.
pub(super) fn turn_per_n_m(operator: &BlockOperator) -> Mat3 {
    let inertia = operator.inertia(&operator.rest, &operator.rest);
    let farthest_m = operator.rest.iter().map(|x| x.norm()).fold(0.0, f64::max);
    farthest_m * inertia.try_inverse().expect("a validated block is not flat")
}

/// The operator with lumped masses, and max |ω·(J − J₀) ω| / ω·J₀ ω over all axes ω for the inertias J with them and J₀ without: with
/// J₀ = L Lᵀ the largest eigenvalue of L⁻¹ (J − J₀) L⁻ᵀ.
pub(super) fn lumped(operator: BlockOperator) -> (BlockOperator, f64) {
    let exact = operator.inertia(&operator.rest, &operator.rest);
    let operator = operator.with_lumped_mass();
    let change = operator.inertia(&operator.rest, &operator.rest) - exact;
    let factor = exact.cholesky().expect("a validated block is not flat").l();
    let inverse = factor.try_inverse().expect("its factor is regular");
    let relative = inverse * change * inverse.transpose();
    (operator, relative.symmetric_eigenvalues().amax())
}
