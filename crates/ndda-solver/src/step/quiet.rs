//! Static reactions of quiet faces: what holds the rock up when time begins acts on as a constant force.

use ndda_mesh::Vec3;

use crate::error::StepError;
use crate::step::Simulation;

impl Simulation {
    /// Whether a block has quiet faces.
    fn is_quiet(&self) -> bool {
        self.problem.shapes.iter().any(|shape| !shape.supports.quiet.dashpots.is_empty())
    }

    /// Lets what quiet faces need to stay where they are, under all other forces per node, act on them from now on.
    ///
    /// # Errors
    /// [`StepError::Block`] when a block has no rotation any more.
    pub(crate) fn keep_static_reactions(&mut self, force: &[Vec3]) -> Result<(), StepError> {
        if !self.is_quiet() {
            return Ok(());
        }
        let mut kept = vec![Vec3::zeros(); force.len()];
        let mut others = force.to_vec();
        // Reactions that were kept until now are in `force`.
        others.iter_mut().zip(&self.state.kept_force).for_each(|(other, old)| *other -= old);
        for block in self.problem.blocks.ids() {
            let nodes = self.problem.blocks.nodes_of(block);
            let body = &mut self.bodies[block.index()];
            let shape = &self.problem.shapes[body.shape];
            let Some(elastic) = body.elastic().filter(|_| !shape.supports.quiet.dashpots.is_empty()) else {
                continue;
            };
            let place = (&self.state.position[nodes.clone()], &others[nodes.clone()]);
            if let Err(source) = elastic.keep_quiet(shape, place, &mut kept[nodes]) {
                let (time_s, block) = (self.time_s(), self.problem.blocks.names[block.index()].clone());
                return Err(StepError::Block { time_s, block, source });
            }
        }
        self.state.kept_force = kept;
        self.place_kept_forces();
        Ok(())
    }

    /// Lets the springs on which quiet faces rest while a scene settles begin where these are now.
    pub(crate) fn rest_on_quiet_faces(&mut self) {
        for block in self.problem.blocks.ids() {
            let nodes = self.problem.blocks.nodes_of(block);
            let body = &mut self.bodies[block.index()];
            let shape = &self.problem.shapes[body.shape];
            if let Some(elastic) = body.elastic() {
                elastic.rest_here(shape, &self.state.position[nodes]);
            }
        }
    }

    /// Lets what these springs bear at the end act on as a constant force. The energy that this gives the loads is work of loads [J].
    ///
    /// # Errors
    /// As [`keep_static_reactions`](Self::keep_static_reactions), or of a contact that cannot be computed.
    pub(crate) fn keep_reactions_of_rest(&mut self) -> Result<f64, StepError> {
        if !self.is_quiet() {
            return Ok(0.0);
        }
        let (before, _) = self.look()?;
        let force = std::mem::take(&mut self.scratch.force);
        let kept = self.keep_static_reactions(&force);
        self.scratch.force = force;
        kept?;
        let work_j = self.look()?.0.load_j - before.load_j;
        self.audit.ledger.add_work(0.0, 0.0, work_j, 0.0);
        Ok(work_j)
    }

    /// Puts the static reactions of the state among the constant loads.
    pub(crate) fn place_kept_forces(&mut self) {
        if self.state.kept_force.is_empty() {
            return;
        }
        if !self.is_quiet() {
            return self.state.kept_force.clear();
        }
        // Blocks that a stage has removed have no reactions.
        let absent = self.stage.as_ref().map_or(&[][..], |stage| &stage.absent);
        for (block, _) in self.problem.blocks.ids().zip(absent).filter(|(_, absent)| **absent) {
            self.state.kept_force[self.problem.blocks.nodes_of(block)].fill(Vec3::zeros());
        }
        self.loads.keep(&self.state.kept_force);
        self.place_loads_now();
    }
}
