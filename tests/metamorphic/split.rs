//! A run of n steps and one of m more that goes on from its snapshot are the run of n + m steps, bit for bit.

use ndda::build;

use crate::generator::{Wanted, build};
use crate::motion::{ROWS, run, run_to};
use crate::random::Random;
use crate::search::{Found, search};

#[test]
fn split_runs_are_the_run() {
    search("split", 40, &Wanted::default(), |case| {
        let (whole, stopped) = run(&case.text);
        let steps = build::steps(&case.scene.time);
        let middle = u64::from(Random::new(!case.seed).whole(1, steps as u32 - 1));
        let (mut first, mut second) = (build(&case.text).unwrap(), build(&case.text).unwrap());
        if run_to(&mut first.simulation, middle, steps, ROWS).is_some() {
            return Found::Skipped("stops before the middle");
        }
        second.simulation.restore(first.simulation.snapshot()).unwrap();
        let also = run_to(&mut second.simulation, steps, steps, ROWS);
        if stopped != also {
            return Found::Fails(format!("split at step {middle}: {stopped:?} is {also:?}"));
        }
        let (own, mut other) = (whole.simulation.invariants(), second.simulation.invariants());
        // The number of pairs that contact examines in vain depends on the steps before, and no result depends on it.
        other.candidate_pairs_max = own.candidate_pairs_max;
        other.candidate_pairs_total = own.candidate_pairs_total;
        // A state that a failed step left behind is no result.
        if stopped.is_none() && whole.simulation.state() != second.simulation.state() {
            return Found::Fails(format!("split at step {middle} of {steps}, the end is another one"));
        }
        if stopped.is_none() && own != other {
            return Found::Fails(format!(
                "split at step {middle} of {steps}, the books are others: {own:?} {other:?}"
            ));
        }
        Found::Holds
    });
}
