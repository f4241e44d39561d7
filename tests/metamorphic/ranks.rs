//! Results have the same bits on 1, 2, 3, 4 and 7 ranks.

use std::sync::Arc;

use ndda_ranks::{Communicator, Threads};

use ndda::build;

use crate::generator::Wanted;
use crate::motion::{ROWS, run, run_to};
use crate::search::{Found, search};

/// State, energies and cause of the end of a scene on each of some ranks, which have a thread each.
fn on_ranks<R: Send>(size: usize, work: impl Fn(Arc<dyn Communicator>) -> R + Sync) -> Vec<R> {
    let work = &work;
    std::thread::scope(|scope| {
        let rank = |rank| {
            scope.spawn(move || {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
                pool.install(|| work(Arc::new(rank)))
            })
        };
        let ranks: Vec<_> = Threads::group(size).into_iter().map(rank).collect();
        ranks.into_iter().map(|rank| rank.join().expect("no panic")).collect()
    })
}

#[test]
fn ranks_do_not_change_a_bit() {
    search("ranks", 30, &Wanted::default(), |case| {
        let (whole, stopped) = run(&case.text);
        let end = (whole.simulation.state(), whole.simulation.invariants(), stopped);
        // One pair of numbers or the other, each for many seeds.
        let sizes = if case.seed % 2 == 0 { [2, 7] } else { [3, 4] };
        for size in sizes {
            let ends = on_ranks(size, |ranks| {
                let mut ready = crate::generator::build(&case.text).expect("it was built before");
                ready.simulation.share_steps(ranks);
                let steps = build::steps(&ready.loaded.scene.time);
                let stopped = run_to(&mut ready.simulation, steps, steps, ROWS);
                (ready.simulation.state().clone(), ready.simulation.invariants(), stopped)
            });
            for (rank, (state, invariants, stopped)) in ends.iter().enumerate() {
                let same = end.2.is_some() || (end.0, &end.1) == (state, invariants);
                if end.2 != *stopped || !same {
                    return Found::Fails(format!("rank {rank} of {size} ends elsewhere than one process"));
                }
            }
        }
        Found::Holds
    });
}
