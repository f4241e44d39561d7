//! Inertia of a rigid block.

use ndda_mesh::{Mat3, Vec3};

/// Inertia of a rigid block in its rest frame.
#[derive(Clone, Debug)]
pub struct RigidInertia {
    /// J about the mass centre [kg m²].
    pub(super) inertia: Mat3,
    pub(super) inverse: Mat3,
    /// Inverse of the inertia of lumped masses: gives the spin of a rigid field of velocities from their moment.
    pub(super) inverse_lumped: Mat3,
}

impl RigidInertia {
    /// Of a block with these node masses and rest positions.
    pub(crate) fn new(operator: &ndda_fem::BlockOperator) -> Self {
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
