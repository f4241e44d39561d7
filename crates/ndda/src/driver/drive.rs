//! Forces and velocities that somebody else gives blocks between two steps.

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::DriveError;

use super::Driver;
use super::judged::Disturbance;

impl Driver {
    /// Lets a force [N] act at a block's centre of mass from now on ([`Simulation::set_force`](ndda_solver::Simulation::set_force)).
    ///
    /// # Errors
    /// [`DriveError`]; nothing has changed then.
    pub fn set_force(&mut self, block: BlockId, force_n: Vec3) -> Result<(), DriveError> {
        self.model.simulation.set_force(block, force_n)?;
        self.note_change(Disturbance::Force);
        Ok(())
    }

    /// Gives a block a velocity [m/s] and a spin [rad/s] now ([`Simulation::set_velocity`](ndda_solver::Simulation::set_velocity)).
    ///
    /// # Errors
    /// [`DriveError`]; nothing has changed then.
    pub fn set_velocity(
        &mut self,
        block: BlockId,
        velocity_m_s: Vec3,
        spin_rad_s: Vec3,
    ) -> Result<(), DriveError> {
        self.model.simulation.set_velocity(block, velocity_m_s, spin_rad_s)?;
        self.note_change(Disturbance::Velocity);
        Ok(())
    }
}
