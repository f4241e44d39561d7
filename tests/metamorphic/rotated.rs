//! Space has no direction: a scene that is turned as a whole moves as before, turned.

use crate::generator::Wanted;
use crate::random::Random;
use crate::search::search;
use crate::transform::{Map, by, compare, each_direction, turn_of};

#[test]
fn rotated_scenes_move_as_before() {
    search("rotated", 40, &Wanted { uncut: true, ..Wanted::default() }, |case| {
        let mut random = Random::new(!case.seed);
        let (matrix, turn) = turn_of(random.vector(1.0).into(), random.between(5.0, 175.0));
        let mut twin = case.scene.clone();
        each_direction(&mut twin, &mut |v| by(&matrix, v));
        for block in &mut twin.blocks {
            block.turns.push(turn.clone());
            by(&matrix, &mut block.at_m);
            by(&matrix, &mut block.spin_rad_s);
        }
        compare(case, &twin, &Map::of_turn(matrix), Clone::clone)
    });
}
