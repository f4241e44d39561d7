//! The solve of a block against the bytes of its factor over the rate at which as many are read.

use ndda_solver::{Factor, Supernodal};

use crate::machine::{Clock, Rates, read_gb_s};
use crate::{header, row};

#[path = "../../crates/ndda-solver/benches/cases/mod.rs"]
mod cases;

use cases::{load, matrix};

/// Cells along the edge of the cubes: 375, 3000 and 24 000 unknowns.
const CELLS: [u32; 3] = [4, 9, 19];

/// Prints the table.
pub fn table(clock: &Clock, rates: &Rates) {
    header(
        "solve",
        &[
            "unknowns",
            "factor",
            "solves at a time",
            "µs a block",
            "read at",
            "a bare read of as much",
            "time a block over that of the read",
            "of the rate of arithmetic",
        ],
    );
    let cells = if clock.measured { &CELLS[..] } else { &CELLS[..1] };
    for &cells in cells {
        let factor = Supernodal::factor_panels(&matrix(cells)).expect("positive definite");
        let read = read_gb_s(clock, factor.bytes());
        for (at_a_time, ns) in [(1.0, one_ns(clock, &factor)), (8.0, eight_ns(clock, &factor))] {
            // Each of the two sweeps reads all of it.
            let rate = 2.0 * factor.bytes() as f64 / ns;
            // A product and a sum for each number read and each load.
            let operations = 2.0 * at_a_time * 2.0 * factor.bytes() as f64 / 8.0;
            let cells = [
                factor.unknowns().to_string(),
                format!("{:.2} MB", factor.bytes() as f64 / 1e6),
                format!("{at_a_time}"),
                format!("{:.2}", ns / at_a_time / 1e3),
                format!("{rate:.1} GB/s"),
                format!("{read:.1} GB/s"),
                format!("{:.2}", read / rate / at_a_time),
                format!("{:.0} %", 100.0 * operations / ns / rates.separate),
            ];
            row("solve", &cells);
        }
    }
}

fn one_ns(clock: &Clock, factor: &dyn Factor) -> f64 {
    let (load, mut scratch) = (load(factor.unknowns()), factor.new_scratch());
    let mut x = load.clone();
    clock.least_ns(|| {
        x.copy_from_slice(&load);
        factor.solve_in_place(&mut x, &mut scratch).expect("a solution");
    })
}

fn eight_ns(clock: &Clock, factor: &dyn Factor) -> f64 {
    let load: Vec<[f64; 8]> = load(factor.unknowns()).into_iter().map(|b| [b; 8]).collect();
    let (mut x, mut scratch) = (load.clone(), factor.new_multi_scratch());
    clock.least_ns(|| {
        x.copy_from_slice(&load);
        factor.solve_multi_in_place(&mut x, &mut scratch).expect("a solution");
    })
}
