//! Data that would cross between processes that own whole blocks: the pile of a thousand cubes, after its fall, split among
//! 2, 4 and 8 of them.
//!
//! Each rank has its own blocks and copies of those of others that are near, of which it gets positions and velocities in
//! every step; a pair across a border is evaluated on both sides. That each rank then finds the forces on its own blocks
//! to the bit is checked here, by evaluating contact on what the rank knows.
//!
//! Prints a table as lines of tab-separated cells; `docs/evidence/performance.py --measure ranks` puts it into docs/verification/performance.md.
//! Without `--bench`, as `cargo test` runs it, the pile is small and at its start.

mod known;
#[path = "../piles/mod.rs"]
mod piles;
mod split;
mod traffic;

use known::Known;
use ndda_contact::ContactInput;
use ndda_contact::affine::ConvexBlocks;
use ndda_contact::broad_phase::Candidates;
use split::Owners;
use traffic::Traffic;

fn main() {
    let measured = std::env::args().any(|argument| argument == "--bench");
    let (scene, steps) = if measured { ("pile_1000", piles::STEPS) } else { ("pile_125", 1) };
    let mut simulation = piles::fallen(scene, &[]);
    (0..steps).for_each(|_| _ = simulation.step().expect("a step"));
    let (blocks, state) = (simulation.blocks(), simulation.state());
    let input = ContactInput::new(blocks, &state.position, &state.velocity, simulation.step_s());
    let mut candidates = Candidates::default();
    candidates.update(&input, &ConvexBlocks::default());
    println!("ranks\t{}", Traffic::HEADER.join("\t"));
    for ranks in [2, 4, 8] {
        let owners = Owners::new(&simulation, ranks);
        for rank in 0..ranks {
            Known::of(rank, &owners, &candidates, blocks).assert_same_bits(rank, &owners, &input);
        }
        let traffic = Traffic::new(&owners, &candidates, &input);
        println!("ranks\t{}", traffic.cells().join("\t"));
    }
}
