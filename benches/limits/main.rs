//! Rates of the program against those of the machine, measured in the same run on one thread: the kernel of contact
//! against the rate of the processor's arithmetic, the solve of a block against the rate at which memory is read, and
//! the step of a pile against the sum of both.
//!
//! Prints tables as lines of tab-separated cells, the name of the table first and its header before its rows;
//! `docs/evidence/performance.py --measure limits` puts them into docs/verification/performance.md. Without `--bench`, as `cargo test` runs
//! it, everything is done once and on the smallest of its problems.

mod kernel;
mod machine;
mod pile;
#[path = "../piles/mod.rs"]
mod piles;
mod solve;
mod twin;

use machine::Clock;

/// Prints one line of a table.
fn row(table: &str, cells: &[String]) {
    println!("{table}\t{}", cells.join("\t"));
}

/// Prints the header of a table.
fn header(table: &str, cells: &[&str]) {
    row(table, &cells.iter().map(ToString::to_string).collect::<Vec<_>>());
}

fn main() {
    let clock = Clock { measured: std::env::args().any(|argument| argument == "--bench") };
    // The calling thread does the work of a step itself.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    pool.build_global().expect("no pool before");
    let rates = machine::rates(&clock);
    kernel::table(&clock, &rates);
    solve::table(&clock, &rates);
    pile::table(&clock);
}
