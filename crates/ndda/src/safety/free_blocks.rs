//! Blocks that may move, and how far they have gone.

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{BodyKind, Simulation};

/// Blocks that are not fixed.
pub fn free(simulation: &Simulation) -> impl Iterator<Item = BlockId> {
    simulation.blocks().ids().filter(|&block| simulation.shape(block).kind != BodyKind::Fixed)
}

/// How far the farthest node of each free block is from where it was at the start [m].
pub fn gone_m(simulation: &Simulation, start: &[Vec3]) -> Vec<(BlockId, f64)> {
    let position = &simulation.state().position;
    let gone = |block: BlockId| {
        let nodes = simulation.blocks().nodes_of(block);
        nodes.map(|n| (position[n] - start[n]).norm()).fold(0.0, f64::max)
    };
    free(simulation).map(|block| (block, gone(block))).collect()
}
