//! Any bytes as a line of the pair calculator: numbers, or an error with the line's number.
#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../../examples/pair.rs"]
#[allow(dead_code)]
mod calculator;

fuzz_target!(|line: &[u8]| {
    let answer = calculator::answer(1, line);
    assert!(answer["error"].is_string() || answer["energy"].is_f64() && answer["stiffness_offdiagonal"].is_f64());
});
