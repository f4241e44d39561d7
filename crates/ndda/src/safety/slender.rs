//! Blocks that may topple before they slide.

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;

use super::free_blocks::free;
use super::mechanism::{SAME_PLANE, normals_of};

/// A block on one plane, whose weight acts along a line that leaves its base when the slope is made steeper.
#[derive(Clone, Debug, PartialEq)]
pub struct Slender {
    /// Its name.
    pub block: String,
    /// The ratio of shear to normal force on the base at which it does, over that of its slope: d/(h tan α) with the height h of the mass centre above the base, and the distance
    /// d of its foot from the lower edge.
    pub factor: f64,
}

impl Slender {
    /// The block with the smallest factor; none where every block is held by more planes than one, or lies level.
    pub fn first(simulation: &Simulation, gravity: Vec3) -> Option<Self> {
        let factor = |block: BlockId| Some((block, factor(simulation, gravity, block)?));
        let first = free(simulation).filter_map(factor).min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Self { block: simulation.blocks().names[first.0.index()].clone(), factor: first.1 })
    }
}

fn factor(simulation: &Simulation, gravity: Vec3, block: BlockId) -> Option<f64> {
    let [normal] = normals_of(simulation, block)[..] else { return None };
    let down = gravity - gravity.dot(&normal) * normal;
    let (tangent, press) = (down.norm(), -gravity.dot(&normal));
    let down = down.try_normalize(LEVEL * gravity.norm()).filter(|_| press > 0.0)?;
    let blocks = simulation.blocks();
    let position = &simulation.state().position;
    let centre = simulation.shape(block).operator.center(&position[blocks.nodes_of(block)]);
    let base = simulation.contacts().iter().filter(|contact| {
        let nodes = blocks.triangles[contact.facet.index()];
        // Outward normals of the block point into its base.
        blocks.block_of(nodes[0]) == block && contact.normal.dot(&normal) < -SAME_PLANE
    });
    let corners: Vec<Vec3> = base
        .flat_map(|contact| blocks.triangles[contact.facet.index()])
        .map(|node| position[node.index()] - centre)
        .collect();
    let edge_m = corners.iter().map(|arm| arm.dot(&down)).reduce(f64::max)?;
    let height_m = corners.iter().map(|arm| -arm.dot(&normal)).sum::<f64>() / corners.len() as f64;
    Some(edge_m / height_m * press / tangent).filter(|factor| factor.is_finite() && *factor > 0.0)
}

/// Sine of the slope below which a block lies level.
const LEVEL: f64 = 1e-3;
