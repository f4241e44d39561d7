//! The velocities with which blocks fail.

use ndda_mesh::Vec3;
use ndda_solver::Simulation;
use serde::{Deserialize, Serialize};

use super::free_blocks::free;
use crate::run::motion::radius_m;

/// Blocks slower than this part of the fastest do not count.
const SLOW: f64 = 0.01;
/// Speed by rotation over that of the mass centre from which on a block turns.
const TURNS: f64 = 0.5;

/// The velocity with which a block failed, as a rigid motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BlockVelocity {
    /// Name of the block.
    pub block: String,
    /// Velocity of its mass centre [m/s].
    pub velocity_m_s: [f64; 3],
    /// Its spin [rad/s].
    pub spin_rad_s: [f64; 3],
    /// Whether a point of it moves faster by its rotation than half of what its mass centre does.
    #[serde(default)]
    pub turns: bool,
}

/// Velocities of the blocks that move, from those of the nodes.
pub fn velocities(simulation: &Simulation, of_nodes: &[Vec3]) -> Vec<BlockVelocity> {
    let blocks = simulation.blocks();
    let speed_m_s = |block| {
        let nodes = blocks.nodes_of(block);
        nodes.map(|node| of_nodes[node].norm()).fold(0.0, f64::max)
    };
    let fastest_m_s = free(simulation).map(speed_m_s).fold(0.0, f64::max);
    let moving = free(simulation).filter(|&block| speed_m_s(block) > SLOW * fastest_m_s);
    let state = simulation.state();
    moving
        .map(|block| {
            let nodes = blocks.nodes_of(block);
            let operator = &simulation.shape(block).operator;
            let motion = operator.rigid_motion(&state.position[nodes.clone()], &of_nodes[nodes]);
            BlockVelocity {
                block: blocks.names[block.index()].clone(),
                velocity_m_s: motion.velocity_m_s.into(),
                spin_rad_s: motion.spin_rad_s.into(),
                turns: radius_m(operator) * motion.spin_rad_s.norm() > TURNS * motion.velocity_m_s.norm(),
            }
        })
        .collect()
}

/// Velocities along the way that blocks have gone since they were in some places, the fastest node at a speed.
pub fn on_the_way(simulation: &Simulation, from: &[Vec3], speed_m_s: f64) -> Vec<BlockVelocity> {
    let way: Vec<Vec3> = simulation.state().position.iter().zip(from).map(|(x, from)| x - from).collect();
    let farthest_m = way.iter().map(Vec3::norm).fold(0.0, f64::max);
    if farthest_m == 0.0 {
        return Vec::new();
    }
    let of_nodes: Vec<Vec3> = way.into_iter().map(|way| way * (speed_m_s / farthest_m)).collect();
    velocities(simulation, &of_nodes)
}

/// The same, per node of a simulation, scaled so that the fastest node moves at a speed; none if nothing moves.
pub fn field(simulation: &Simulation, velocities: &[BlockVelocity], speed_m_s: f64) -> Option<Vec<Vec3>> {
    let position = &simulation.state().position;
    let mut field = vec![Vec3::zeros(); position.len()];
    for block in free(simulation) {
        let name = &simulation.blocks().names[block.index()];
        let Some(velocity) = velocities.iter().find(|velocity| velocity.block == *name) else { continue };
        let nodes = simulation.blocks().nodes_of(block);
        let center = simulation.shape(block).operator.center(&position[nodes.clone()]);
        let (v, spin) = (Vec3::from(velocity.velocity_m_s), Vec3::from(velocity.spin_rad_s));
        for node in nodes {
            field[node] = v + spin.cross(&(position[node] - center));
        }
    }
    let fastest = field.iter().map(Vec3::norm).fold(0.0, f64::max);
    let factor = speed_m_s / fastest;
    factor.is_finite().then(|| field.into_iter().map(|v| v * factor).collect())
}
