//! The order of blocks in a file means nothing.

use ndda_mesh::Mat3;

use crate::generator::{Wanted, build};
use crate::motion::Motion;
use crate::search::{Found, search, text_of};
use crate::transform::{Map, compare};

/// Effect of the order of patches relative to size and speed, where a hundred sweeps do not find friction to 1e-7.
const ORDER: f64 = 1e-6;

#[test]
fn renumbered_scenes_move_as_before() {
    search("renumbered", 40, &Wanted { uncut: true, ..Wanted::default() }, |case| {
        if case.scene.blocks.len() < 2 {
            return Found::Skipped("one block has one order");
        }
        let mut twin = case.scene.clone();
        twin.blocks.reverse();
        let blocks = build(&text_of(&twin)).expect("the same blocks").simulation.blocks().clone();
        // The twin's blocks in the order of the case.
        let reorder = |motion: &Motion| {
            let ids: Vec<_> = blocks.ids().collect();
            let nodes = || ids.iter().rev().flat_map(|&block| blocks.nodes_of(block));
            Motion {
                position: nodes().map(|n| motion.position[n]).collect(),
                velocity: nodes().map(|n| motion.velocity[n]).collect(),
            }
        };
        let map = Map { friction: ORDER, ..Map::of_turn(Mat3::identity()) };
        compare(case, &twin, &map, reorder)
    });
}
