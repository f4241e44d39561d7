//! Forces on points of blocks, as forces on nodes.

use ndda_io::scene;
use ndda_mesh::geometry::{Aabb, tet_volume};
use ndda_mesh::{BlockId, BlockSet, Vec3};

use super::vec3;

/// A point belongs to a tetrahedron if none of its barycentric coordinates is less than minus this.
const ROUNDING: f64 = 1e-6;
/// A point is a node if that node's barycentric coordinate is one but for this.
const NODE: f64 = 1e-9;

/// The nodes that a force acts on, and their shares of it.
pub(super) fn shares(
    blocks: &BlockSet,
    block: BlockId,
    force: &scene::Force,
) -> Result<Vec<(u32, f64)>, String> {
    let Some(at_m) = force.at_m else { return Ok((0..).zip(volume_shares(blocks, block)).collect()) };
    let place = vec3(at_m) - blocks.origin_m;
    match shares_at(blocks, block, &place) {
        Some(shares) => Ok(shares),
        None => Ok(vec![(nearest_node(blocks, block, &place)?, 1.0)]),
    }
}

/// Corners of the tetrahedron that has a place, and its barycentric coordinates: shares of a force there that have its moment about any point. None where the place
/// is outside of the block.
pub(crate) fn shares_at(blocks: &BlockSet, block: BlockId, place: &Vec3) -> Option<Vec<(u32, f64)>> {
    let (tet, shares) = blocks.deepest_tet(block, place)?;
    if shares.iter().any(|share| *share < -ROUNDING) {
        return None;
    }
    let first = blocks.nodes_of(block).start as u32;
    let pairs = || blocks.tets[tet.index()].iter().map(|node| node.0 - first).zip(shares);
    match pairs().find(|(_, share)| *share > 1.0 - NODE) {
        Some((node, _)) => Some(vec![(node, 1.0)]),
        None => Some(pairs().collect()),
    }
}

/// The part of a block's volume that is each node's: their mean place is the mass centre.
fn volume_shares(blocks: &BlockSet, block: BlockId) -> Vec<f64> {
    let nodes = &blocks.rest_position[blocks.nodes_of(block)];
    let mut shares = vec![0.0; nodes.len()];
    for tet in blocks.local_tets(block) {
        let volume = tet_volume(&tet.map(|node| nodes[node as usize]));
        tet.iter().for_each(|&node| shares[node as usize] += volume);
    }
    let whole: f64 = shares.iter().sum();
    shares.iter_mut().for_each(|share| *share /= whole);
    shares
}

/// The node nearest to a place, which must not be outside of the block's box by more than a tenth of it.
fn nearest_node(blocks: &BlockSet, block: BlockId, place: &Vec3) -> Result<u32, String> {
    let nodes = &blocks.rest_position[blocks.nodes_of(block)];
    let bounds = Aabb::around(nodes);
    if !bounds.inflated(0.1 * bounds.diagonal()).touches(&Aabb { min: *place, max: *place }) {
        let [min, max] =
            [bounds.min, bounds.max].map(|x| (x + blocks.origin_m).map(|x| (1e6 * x).round() / 1e6));
        return Err(format!(
            "this point is not on block `{}`, which lies from ({}, {}, {}) to ({}, {}, {}): give a point of it, or leave at_m out for a force through its mass centre",
            blocks.names[block.index()],
            min.x,
            min.y,
            min.z,
            max.x,
            max.y,
            max.z
        ));
    }
    let distance = |i: usize| (nodes[i] - place).norm_squared();
    let nearest = (0..nodes.len()).min_by(|&i, &j| distance(i).total_cmp(&distance(j)));
    Ok(nearest.ok_or("the block has no nodes")? as u32)
}

#[cfg(test)]
mod tests {
    use crate::Model;

    #[test]
    fn a_force_far_off_its_block_is_refused_with_the_extent_of_the_block() {
        let text = "(title: \"pushed\", time: (step_s: 1e-4, end_s: 1e-3),
            materials: [(name: \"rock\", density_kg_m3: 2600, young_pa: 20e9, poisson: 0.25)],
            blocks: [(name: \"a\", material: \"rock\", at_m: (2, 0, 0), shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))],
            forces: [(block: \"a\", at_m: (9, 0, 0), force_n: (1, 0, 0))])";
        let Err(refused) = Model::from_text(text) else { panic!("the force is off the block") };
        let words = refused.to_string();
        assert!(
            words.contains("lies from (2, 0, 0) to (3, 1, 1)") && words.contains("give a point of it"),
            "{words}"
        );
        assert!(!words.contains("ndda mesh"), "{words}");
    }
}
