//! Results have the same bits on 1, 2, 3 and 8 threads.

use crate::generator::Wanted;
use crate::motion::run;
use crate::search::{Found, search};

#[test]
fn threads_do_not_change_a_bit() {
    search("threads", 20, &Wanted { large: true, ..Wanted::default() }, |case| {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let (ready, stopped) = pool.install(|| run(&case.text));
            (ready.simulation.state().clone(), ready.simulation.invariants(), stopped)
        };
        let one = on(1);
        for threads in [2, 3, 8] {
            let other = on(threads);
            if one.2 != other.2 || (one.2.is_none() && one != other) {
                return Found::Fails(format!("{threads} threads end elsewhere than one"));
            }
        }
        Found::Holds
    });
}
