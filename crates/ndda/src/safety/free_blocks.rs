//! Blocks that may move, and how far they have gone.

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{BodyKind, Simulation};

use crate::run::motion::radius_m;

/// Part of its radius that a block goes before it is in another place, where it may rest on others.
pub const ELSEWHERE: f64 = 0.05;

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

/// How far the block went on the way to rest that went farthest, where it came to rest in another place.
#[derive(Clone, Debug)]
pub struct Moved {
    /// Its name.
    pub block: String,
    /// How far it went [m].
    pub gone_m: f64,
}

impl Moved {
    /// Since blocks were in some places; none where all are still in theirs.
    pub fn farthest(simulation: &Simulation, begun: &[Vec3]) -> Option<Self> {
        let is_elsewhere = |(block, gone_m): &(BlockId, f64)| {
            *gone_m > ELSEWHERE * radius_m(&simulation.shape(*block).operator)
        };
        let gone = gone_m(simulation, begun).into_iter().filter(is_elsewhere);
        let (block, gone_m) = gone.max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Self { block: simulation.blocks().names[block.index()].clone(), gone_m })
    }

    /// Whether blocks went much less far than with less strength.
    pub fn is_held_back_from(&self, weaker: Option<&Self>) -> bool {
        weaker.is_some_and(|weaker| self.gone_m < 0.5 * weaker.gone_m)
    }
}
