//! How stiff contact is beside the masses that it moves, without a step.

use ndda_mesh::BlockId;

use crate::bodies::kind::BodyKind;
use crate::error::StepError;
use crate::step::Simulation;

impl Simulation {
    /// Upper bounds of ω_c² for each block [1/s²] where all blocks are swollen about their mass centres until their farthest nodes
    /// have moved by `depth_over_height` of their smallest tetrahedron: then neighbours that touch overlap as little as that. A bound is
    /// the largest Σ|k|/m of a node, as steps report it in h = ω_c Δt; it is zero for a block that touches none, and for fixed ones.
    ///
    /// # Errors
    /// [`StepError::Contact`] when contact cannot be computed.
    pub fn contact_rates2(&mut self, depth_over_height: f64) -> Result<Vec<f64>, StepError> {
        self.without_memory(|simulation| simulation.rates2_where_swollen(depth_over_height))
    }

    fn rates2_where_swollen(&mut self, depth_over_height: f64) -> Result<Vec<f64>, StepError> {
        for block in self.problem.blocks.ids() {
            let (nodes, shape) =
                (self.problem.blocks.nodes_of(block), &self.problem.shapes[self.bodies[block.index()].shape]);
            let center = shape.operator.center(&self.state.position[nodes.clone()]);
            let swelling = depth_over_height * shape.smallest_height_m / shape.scale().radius_m;
            for node in nodes {
                let x = self.state.position[node];
                self.scratch.contact_position[node] = x + swelling * (x - center);
            }
        }
        self.scratch.is_without_friction = true;
        let found = self.add_contact_forces(None);
        self.scratch.is_without_friction = false;
        found.map(|_| self.problem.blocks.ids().map(|block| self.contact_rate2(block)).collect())
    }

    /// Upper bound of ω_c² of a block by the contacts of the last evaluation [1/s²]; 0 for fixed ones.
    pub(super) fn contact_rate2(&self, block: BlockId) -> f64 {
        let shape = self.shape(block);
        if shape.kind == BodyKind::Fixed {
            return 0.0;
        }
        shape.contact_rate2(&self.scratch.contact_stiffness[self.problem.blocks.nodes_of(block)])
    }
}
