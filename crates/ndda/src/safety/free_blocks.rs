//! Blocks that may move, and how far they have gone.

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{BodyKind, Simulation};
use serde::{Deserialize, Serialize};

use crate::run::motion::{radius_m, shift_m};

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

/// Largest speed of a block, by its kinetic energy [m/s].
pub fn fastest_m_s(simulation: &Simulation) -> f64 {
    let speed_m_s = |block: BlockId| {
        let operator = &simulation.shape(block).operator;
        let velocity = &simulation.state().velocity[simulation.blocks().nodes_of(block)];
        (2.0 * operator.kinetic_energy_j(velocity) / operator.mass_kg).sqrt()
    };
    free(simulation).map(speed_m_s).fold(0.0, f64::max)
}

/// A block that does not stand as it is drawn: on the way to rest it went to another place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moved {
    /// Its name.
    pub block: String,
    /// How far its farthest node went \[m\].
    pub moved_m: f64,
    /// Direction in which its mass centre went, of length 1; zero where it only turned.
    pub direction: [f64; 3],
}

impl Moved {
    /// Blocks that are elsewhere than in some places, the farthest first.
    pub fn since(simulation: &Simulation, begun: &[Vec3]) -> Vec<Self> {
        let is_elsewhere = |(block, gone_m): &(BlockId, f64)| {
            *gone_m > ELSEWHERE * radius_m(&simulation.shape(*block).operator)
        };
        let mut gone: Vec<_> = gone_m(simulation, begun).into_iter().filter(is_elsewhere).collect();
        gone.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        let moved = |(block, moved_m): (BlockId, f64)| {
            let shift = shift_m(simulation, begun, block);
            let direction = shift.try_normalize(0.0).unwrap_or_default().into();
            Self { block: simulation.blocks().names[block.index()].clone(), moved_m, direction }
        };
        gone.into_iter().map(moved).collect()
    }

    /// Whether blocks went much less far than with less strength.
    pub fn are_held_back(now: &[Self], weaker: &[Self]) -> bool {
        let farthest_m = |moved: &[Self]| moved.first().map_or(0.0, |first| first.moved_m);
        farthest_m(now) < 0.5 * farthest_m(weaker)
    }
}
