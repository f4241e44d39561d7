//! How much forces would move blocks in a step, each by itself: what unbalanced forces are compared with.

use ndda_mesh::{BlockId, Vec3};
use ndda_ranks::ExactSum;

use crate::bodies::kind::BodyKind;
use crate::step::Simulation;

impl Simulation {
    /// Kinetic energy that its loads alone would give a block in a step [J].
    pub(super) fn load_energy_j(&self, block: BlockId) -> f64 {
        let load: Vec3 = self.loads.total()[self.blocks().nodes_of(block)].iter().sum();
        let mass_kg = self.inertia_factor(block) * self.shape(block).operator.mass_kg;
        0.5 * (self.part_s * load).norm_squared() / mass_kg
    }

    /// The same if the loads of all its nodes had one direction [J].
    pub(super) fn load_size_j(&self, block: BlockId) -> f64 {
        let loads = &self.loads.total()[self.blocks().nodes_of(block)];
        self.size_energy_j(block, loads.iter().map(|load| load.norm()).sum())
    }

    /// Kinetic energy that loads, contact and bolts would give all blocks but the fixed ones in a step if they had one direction on each [J].
    pub(super) fn acting_energy_j(&self) -> f64 {
        let of_block = |block: BlockId| {
            let factor = self.inertia_factor(block);
            let nodes = self.blocks().nodes_of(block);
            let forces = self.scratch.force[nodes.clone()].iter().zip(&self.loads.total()[nodes]);
            // Forces were divided by the factor on inertia.
            let size_n = forces.map(|(all, load)| load.norm() + (factor * all - load).norm()).sum();
            self.size_energy_j(block, size_n)
        };
        let moving = self.blocks().ids().filter(|&block| self.shape(block).kind != BodyKind::Fixed);
        moving.map(of_block).collect::<ExactSum>().value()
    }

    fn size_energy_j(&self, block: BlockId, size_n: f64) -> f64 {
        let mass_kg = self.inertia_factor(block) * self.shape(block).operator.mass_kg;
        0.5 * (self.part_s * size_n).powi(2) / mass_kg
    }
}
