//! Forces and velocities that somebody else gives blocks between two steps.

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{BodyKind, DriveError};

use super::Driver;
use super::judged::Disturbance;

impl Driver {
    /// Lets a force [N] act at a block's centre of mass from now on ([`Simulation::set_force`](ndda_solver::Simulation::set_force)).
    ///
    /// The force that acts already changes nothing.
    ///
    /// # Errors
    /// [`DriveError`]; nothing has changed then.
    pub fn set_force(&mut self, block: BlockId, force_n: Vec3) -> Result<(), DriveError> {
        if self.acts_already(block, force_n) {
            return Ok(());
        }
        self.model.simulation.set_force(block, force_n)?;
        self.note_change(Disturbance::Force);
        Ok(())
    }

    /// Whether a block that can be driven is driven so: to set its force again would only add zeros to the state.
    fn acts_already(&self, block: BlockId, force_n: Vec3) -> bool {
        let simulation = self.simulation();
        let acts_n = simulation.state().driving_force.get(block.index()).copied().unwrap_or_default();
        let is_there = block.index() < simulation.blocks().len();
        force_n == acts_n && is_there && simulation.shape(block).kind != BodyKind::Fixed
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;
    use crate::driver::EXAMPLE;

    #[test]
    fn a_force_that_acts_already_changes_no_bit_and_is_refused_where_another_would_be() {
        let fall = || Driver::new(Model::from_text(EXAMPLE.1).unwrap()).unwrap();
        let (mut plain, mut driver) = (fall(), fall());
        driver.set_force(BlockId(0), Vec3::zeros()).unwrap();
        driver.step(10).unwrap();
        plain.step(10).unwrap();
        assert_eq!(driver.state_crc32(), plain.state_crc32());
        assert_eq!(driver.snapshot().disturbed, None);
        driver.set_force(BlockId(1), Vec3::zeros()).unwrap_err();
        driver.set_force(BlockId(0), Vec3::x()).unwrap();
        assert!(driver.snapshot().disturbed.is_some());
    }
}
