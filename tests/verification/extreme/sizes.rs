//! What contact has to look at grows as the number of blocks. Time and memory, which no test may judge, are measured by
//! docs/evidence/sizes.py.

use super::{advance, extreme};
use crate::evidence::Answer::AtMost;
use crate::evidence::row;

#[test]
fn pairs_grow_as_blocks_do() {
    // One block, two, and cubes of 5 and 10 blocks along each edge.
    let mut per_block = Vec::new();
    for (across, high) in [(1, 1), (1, 2), (5, 5), (10, 10)] {
        let domain = format!("rock.rock.domain.max_m=({across}, {across}, {high})");
        let mut simulation = extreme("blocks", &[&domain, "rock.rock.fixed=[]"]).simulation;
        let blocks = simulation.blocks().len();
        assert_eq!(blocks, across * across * high);
        advance(&mut simulation, 2);
        per_block.push(simulation.invariants().candidate_pairs_max as f64 / blocks as f64);
    }
    assert_eq!(per_block[0], 0.0, "one block has nothing to look at");
    // A block inside has 26 neighbours; at the rim of a small cube it has fewer.
    row(
        "extreme: many blocks",
        "pairs looked at per block, 1000 blocks over 125",
        per_block[3] / per_block[2],
        AtMost(2.0),
    );
}
