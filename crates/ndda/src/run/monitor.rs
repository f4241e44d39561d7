//! Points whose motion is recorded.

use std::ops::Range;

use ndda_mesh::geometry::tet_volume;
use ndda_mesh::{BlockId, BlockSet, NodeId, Vec3};
use ndda_solver::Simulation;

/// A point outside its block by less than this part of a tetrahedron still belongs to it.
const OUTSIDE: f64 = 1e-9;

/// A point whose motion is recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Monitor {
    /// Name in the scene.
    pub name: String,
    /// Where it is.
    pub place: Place,
}

/// Where a monitor is.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// A material point: nodes and their weights, which sum to 1.
    Point(Vec<(NodeId, f64)>),
    /// Whichever of the nodes has moved farthest along a unit vector.
    Largest(Vec<Range<usize>>, Vec3),
}

impl Monitor {
    /// The mass centre of a block.
    pub fn centre(name: &str, simulation: &Simulation, block: BlockId) -> Self {
        let operator = &simulation.shape(block).operator;
        let first = simulation.blocks().nodes_of(block).start;
        let weight = |(i, m): (usize, &f64)| (NodeId((first + i) as u32), m / operator.mass_kg);
        let weights = operator.node_mass.iter().enumerate().map(weight).collect();
        Self { name: name.into(), place: Place::Point(weights) }
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
        (smallest >= -OUTSIDE).then(|| Self { name: name.into(), place: Place::Point(weights) })
    }

    /// Whichever of the nodes has moved farthest along a unit vector.
    pub fn largest(name: &str, nodes: Vec<Range<usize>>, direction: Vec3) -> Self {
        Self { name: name.into(), place: Place::Largest(nodes, direction) }
    }

    /// Displacement since the start [m].
    pub fn displacement(&self, simulation: &Simulation) -> Vec3 {
        let (position, start) = (&simulation.state().position, simulation.counted_from());
        self.mean(simulation, |n| position[n] - start[n])
    }

    /// Velocity [m/s].
    pub fn velocity(&self, simulation: &Simulation) -> Vec3 {
        self.mean(simulation, |n| simulation.state().velocity[n])
    }

    fn mean(&self, simulation: &Simulation, value: impl Fn(usize) -> Vec3) -> Vec3 {
        match &self.place {
            Place::Point(weights) => weights.iter().map(|(n, weight)| value(n.index()) * *weight).sum(),
            Place::Largest(nodes, direction) => {
                let (position, start) = (&simulation.state().position, simulation.counted_from());
                let along = |n: &usize| (position[*n] - start[*n]).dot(direction);
                let all = nodes.iter().flat_map(Clone::clone);
                all.max_by(|a, b| along(a).total_cmp(&along(b))).map_or(Vec3::zeros(), value)
            }
        }
    }
}
