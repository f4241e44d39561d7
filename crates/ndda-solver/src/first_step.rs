//! Where free blocks begin.
//!
//! A scheme that takes contact at x* = x + ½ Δt v leaps from one x* to the next, by Δt v: these follow the motion, and x, the mean of
//! two of them, is off by ⅛ Δt² a. A block that begins at x itself therefore begins beside its course: where contact of frequency ω is to
//! bear a load all at once, it swings by (ω Δt)²/8 of that too much. One that begins ⅛ Δt² a ahead swings by (ω Δt)⁴/128
//! too much. Displacements count from there.

use ndda_mesh::Vec3;

use crate::simulation::Simulation;
use crate::step_error::StepError;

impl Simulation {
    /// Whether this is the first step, and one by a scheme of that kind.
    pub(crate) fn begins(&self) -> bool {
        let first = self.state.step == 0 && self.state.control.part == 0;
        first && self.newton.is_none() && self.weights.contact_in_the_middle()
    }

    /// x ← x + ⅛ Δt² a for free blocks as a whole, a being that of loads and contact where they are put. It is done without contact, too,
    /// so that a block does not go another way for being watched.
    pub(crate) fn begin_ahead(&mut self) -> Result<(), StepError> {
        let force = self.force_at_start()?;
        let mut start = self.start_position().to_vec();
        for block in self.blocks.ids() {
            let shape = &self.shapes[self.bodies[block.index()].shape];
            if shape.is_free() {
                let nodes = self.blocks.nodes_of(block);
                let total: Vec3 = force[nodes.clone()].iter().sum();
                let ahead = 0.125 * self.part_s * self.part_s / shape.operator.mass_kg * total;
                self.state.position[nodes.clone()].iter_mut().for_each(|x| *x += ahead);
                start[nodes].iter_mut().for_each(|x| *x += ahead);
            }
        }
        if start != self.start_position() {
            self.state.start = start;
        }
        self.force.copy_from_slice(self.loads.total());
        Ok(())
    }

    /// Loads and contact where the blocks are now [N]; nothing of it is remembered.
    pub(crate) fn force_at_start(&mut self) -> Result<Vec<Vec3>, StepError> {
        let untouched = self.state.contact.clone();
        self.force.copy_from_slice(self.loads.total());
        self.contact_position.copy_from_slice(&self.state.position);
        let found = self.add_contact_forces(None);
        self.state.contact = untouched;
        found.map(|_| self.force.clone())
    }
}
