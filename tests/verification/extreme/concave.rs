//! A cube on the ledge of an L. The arch is tests/verification/masonry_arch.rs; that a concave block pushes as its convex
//! parts do, and not itself, is tested in crates/ndda-contact/src/potential_contact/contact_model.rs.

use ndda_solver::Settle;

use super::{advance, block, extreme, farthest};
use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;

#[test]
fn a_concave_block_bears_what_rests_in_it_and_all_of_it_rests() {
    let mut simulation = extreme("concave", &[]).simulation;
    simulation.settle(&Settle::new(1e-3, 1_000_000)).unwrap();
    let base = block(&simulation, "base");
    let (mut force, steps) = (0.0, 1000);
    for _ in 0..steps {
        advance(&mut simulation, 1);
        force += (simulation.reaction_n(base).z - 24.0 * 2500.0 * 9.8) / f64::from(steps);
    }
    // An L of 3 + 2 cells of 1 × 2 × 1 m, and a cube. Both bounds are the promise of the header of scenes/extreme/concave.ron, which settles to 1e-3.
    row(
        "extreme: concave blocks",
        "force under an L and a cube on its ledge [N]",
        force,
        Within(11.0 * 2500.0 * 9.8, 1e-3),
    );
    row("extreme: concave blocks", "motion after settling [m]", farthest(&simulation), AtMost(1e-6));
}
