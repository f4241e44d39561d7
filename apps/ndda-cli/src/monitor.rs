//! Points whose motion is recorded.

use ndda_mesh::geometry::tet_volume;
use ndda_mesh::{BlockId, BlockSet, NodeId, Vec3};
use ndda_solver::Simulation;

/// A point outside its block by less than this part of a tetrahedron still belongs to it.
const OUTSIDE: f64 = 1e-9;

/// A material point as a weighted mean of nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Monitor {
    /// Name in the scene.
    pub name: String,
    /// Nodes and their weights, which sum to 1.
    pub weights: Vec<(NodeId, f64)>,
}

impl Monitor {
    /// The mass centre of a block.
    pub fn centre(name: &str, simulation: &Simulation, block: BlockId) -> Self {
        let operator = &simulation.shape(block).operator;
        let first = simulation.blocks().nodes_of(block).start;
        let weight = |(i, m): (usize, &f64)| (NodeId((first + i) as u32), m / operator.mass_kg);
        Self { name: name.into(), weights: operator.node_mass.iter().enumerate().map(weight).collect() }
    }

    /// The material point of `block` at `place` [m] in the rest shape; `None` when the block is not there.
    pub fn point(name: &str, blocks: &BlockSet, block: BlockId, place: &Vec3) -> Option<Self> {
        let inside = |tet: usize| {
            let corners = blocks.tets[tet].map(|n| blocks.rest_position[n.index()]);
            let volume = tet_volume(&corners);
            let lambda = [0, 1, 2, 3].map(|i| {
                let mut replaced = corners;
                replaced[i] = *place;
                tet_volume(&replaced) / volume
            });
            let smallest = lambda.iter().copied().fold(f64::INFINITY, f64::min);
            (smallest, lambda)
        };
        let nearer = |best: Option<(f64, usize, [f64; 4])>, tet| {
            let (smallest, lambda) = inside(tet);
            if best.is_none_or(|b| smallest > b.0) { Some((smallest, tet, lambda)) } else { best }
        };
        let (smallest, tet, lambda) = blocks.tets_of(block).fold(None, nearer)?;
        let weights = blocks.tets[tet].iter().copied().zip(lambda).collect();
        (smallest >= -OUTSIDE).then(|| Self { name: name.into(), weights })
    }

    /// Displacement since the start [m].
    pub fn displacement(&self, simulation: &Simulation) -> Vec3 {
        let (position, start) = (&simulation.state().position, simulation.start_position());
        self.mean(|n| position[n] - start[n])
    }

    /// Velocity [m/s].
    pub fn velocity(&self, simulation: &Simulation) -> Vec3 {
        self.mean(|n| simulation.state().velocity[n])
    }

    fn mean(&self, value: impl Fn(usize) -> Vec3) -> Vec3 {
        self.weights.iter().map(|(n, weight)| value(n.index()) * *weight).sum()
    }
}
