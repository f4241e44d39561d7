//! Forces on points of blocks, as forces on nodes.

use ndda_io::scene;
use ndda_mesh::geometry::{Aabb, tet_volume};
use ndda_mesh::{BlockId, BlockSet, Vec3};

use super::regions::in_region;
use super::vec3;

/// A point belongs to a tetrahedron if none of its barycentric coordinates is less than minus this.
const ROUNDING: f64 = 1e-6;
/// A point is a node if that node's barycentric coordinate is one but for this.
const NODE: f64 = 1e-9;

/// Nodes of a block, counted from its first, and their shares of a force.
type Shares = Vec<(u32, f64)>;

/// The blocks that a force acts on, and its shares on their nodes: through their mass centres, or at a point on those that have it. Where none has it, as between
/// the facets and the curved face that they stand for, it acts on the nearest node.
pub(super) fn acts_on(blocks: &BlockSet, force: &scene::Force) -> Result<Vec<(BlockId, Shares)>, String> {
    let Some(at_m) = force.at_m else {
        return in_region(blocks, &force.block, |block| {
            Ok((0..).zip(volume_shares(blocks, block)).collect())
        });
    };
    let place = vec3(at_m) - blocks.origin_m;
    let exact = |block| shares_at(blocks, block, &place).ok_or_else(String::new);
    in_region(blocks, &force.block, exact).or_else(|_| {
        let near = in_region(blocks, &force.block, |block| nearest_node(blocks, block, &place))?;
        let nearest = near.into_iter().min_by(|(_, a), (_, b)| a.1.total_cmp(&b.1));
        Ok(nearest.into_iter().map(|(block, (node, _))| (block, vec![(node, 1.0)])).collect())
    })
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

/// The node nearest to a place, and its distance [m]; the place must not be outside of the block's box by more than a tenth of it.
fn nearest_node(blocks: &BlockSet, block: BlockId, place: &Vec3) -> Result<(u32, f64), String> {
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
    let distance_m = |i: usize| (nodes[i] - place).norm();
    let nearest = (0..nodes.len()).min_by(|&i, &j| distance_m(i).total_cmp(&distance_m(j)));
    let nearest = nearest.ok_or("the block has no nodes")?;
    Ok((nearest as u32, distance_m(nearest)))
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

    #[test]
    fn of_many_blocks_those_that_have_the_point_take_the_force_or_else_the_nearest() {
        let speeds = |at_m: &str| {
            let block = |name: &str, x: f64| {
                format!(
                    "(name: \"{name}\", material: \"rock\", body: Rigid, at_m: ({x}, 0, 0), shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))"
                )
            };
            let text = format!(
                "(title: \"pushed\", time: (step_s: 1e-3, end_s: 1e-3), contact: Off,
                materials: [(name: \"rock\", density_kg_m3: 1000, young_pa: 20e9, poisson: 0.25)],
                blocks: [{}, {}], forces: [(block: \"a_*\", at_m: {at_m}, force_n: (0, 0, 1000))])",
                block("a_1", 0.0),
                block("a_2", 1.02)
            );
            let mut simulation = Model::from_text(&text).unwrap().simulation;
            simulation.step().unwrap();
            let speed = |block: u32| {
                let nodes = simulation.blocks().nodes_of(ndda_mesh::BlockId(block));
                let v = &simulation.state().velocity[nodes];
                v.iter().map(|v| v.z).sum::<f64>() / v.len() as f64
            };
            [speed(0), speed(1)]
        };
        // Within the first, and in the gap between both, nearer to the second.
        for (at_m, takes) in [("(0.95, 0.5, 0.5)", 0), ("(1.015, 0, 0)", 1)] {
            let speeds = speeds(at_m);
            assert!(speeds[takes] > 9e-4 && speeds[1 - takes] == 0.0, "{at_m}: {speeds:?}");
        }
    }
}
