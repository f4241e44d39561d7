//! Nodes that were written twice.

use std::collections::HashMap;

use super::{Found, ids};
use crate::Vec3;
use crate::geometry::Aabb;

/// Side of a hash cell in tolerances: a node then meets 1 to 8 cells, 3.4 on average.
const CELL: f64 = 4.0;

/// Each node that lies within `tolerance_m` of an earlier one, after that one.
pub(super) fn pairs(nodes: &[Vec3], tolerance_m: f64) -> Found<(u32, u32)> {
    let twins = first_twins(nodes, tolerance_m);
    ids(&twins).filter_map(|(id, twin)| twin.map(|other| (other, id))).collect()
}

/// The earlier node within `tolerance_m` of each node, if any; only nodes without one are compared with.
///
/// Nodes are hashed into cells of a few tolerances. Only the first node of a place is kept, so a cell stays small
/// even if all nodes are at one place, and the work is linear in the number of nodes.
pub(crate) fn first_twins(nodes: &[Vec3], tolerance_m: f64) -> Vec<Option<u32>> {
    let corner = Aabb::around(nodes).min;
    // A tolerance of 0 must not put all nodes in one cell.
    let cell_m = (CELL * tolerance_m).max(f64::EPSILON * Aabb::around(nodes).diagonal());
    // A block without extent has tolerance 0: 0 / 0 is then cell 0, as the cast of NaN is.
    let cell =
        |x: &Vec3| -> [i64; 3] { std::array::from_fn(|axis| ((x - corner)[axis] / cell_m).floor() as i64) };
    let mut kept: HashMap<[i64; 3], Vec<u32>> = HashMap::with_capacity(nodes.len());
    let mut twins = Vec::with_capacity(nodes.len());
    for (id, node) in ids(nodes) {
        let from = cell(&node.add_scalar(-tolerance_m));
        let to = cell(&node.add_scalar(tolerance_m));
        let is_near = |&other: &u32| (nodes[other as usize] - node).norm() <= tolerance_m;
        let twin =
            cells(from, to).filter_map(|key| kept.get(&key)).flatten().copied().find(|other| is_near(other));
        if twin.is_none() {
            kept.entry(cell(node)).or_default().push(id);
        }
        twins.push(twin);
    }
    twins
}

fn cells(from: [i64; 3], to: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    let [x, y, z]: [_; 3] = std::array::from_fn(|axis| from[axis]..=to[axis]);
    x.flat_map(move |i| {
        let z = z.clone();
        y.clone().flat_map(move |j| z.clone().map(move |k| [i, j, k]))
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The definition: compares all pairs.
    fn all_pairs(nodes: &[Vec3], tolerance_m: f64) -> Vec<u32> {
        let mut kept: Vec<usize> = Vec::new();
        let mut twins = Vec::new();
        for (id, node) in nodes.iter().enumerate() {
            if kept.iter().any(|&other| (nodes[other] - node).norm() <= tolerance_m) {
                twins.push(id as u32);
            } else {
                kept.push(id);
            }
        }
        twins
    }

    proptest! {
        #[test]
        fn hashing_finds_what_comparing_all_pairs_finds(
            nodes in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 0..11),
            tolerance_m in prop_oneof![Just(0.0), 0.01..1.0f64],
        ) {
            let nodes: Vec<Vec3> = nodes.into_iter().map(Vec3::from).collect();
            let twins: Vec<u32> = pairs(&nodes, tolerance_m).first.iter().map(|pair| pair.1).collect();
            prop_assert_eq!(twins, all_pairs(&nodes, tolerance_m));
        }
    }

    #[test]
    fn many_nodes_at_one_place_are_all_twins_of_the_first() {
        let found = pairs(&vec![Vec3::repeat(2.0); 100_000], 0.0);
        assert_eq!(found.count, 99_999);
        assert_eq!(found.first[9], (0, 10));
    }
}
