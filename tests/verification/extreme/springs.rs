//! Springs of 10⁶ E · 1 m hold as elimination does.

use super::{advance, extreme};
use crate::displacements;
use crate::evidence::Answer::AtMost;
use crate::evidence::row;

#[test]
fn very_stiff_springs_hold_as_elimination_does() {
    let by: Vec<String> = (0..3).map(|i| format!("supports[{i}].by=Elimination")).collect();
    let run = |overrides: &[&str]| {
        let mut simulation = extreme("stiff_springs", overrides).simulation;
        advance(&mut simulation, 2000);
        displacements(&simulation)
    };
    let (sprung, held) = (run(&[]), run(&by.iter().map(String::as_str).collect::<Vec<_>>()));
    let largest = held.iter().map(|u| u.norm()).fold(0.0, f64::max);
    let apart = held.iter().zip(&sprung).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(apart > 0.0, "springs that do not give at all are no springs");
    row(
        "extreme: stiff springs",
        "springs of 1e6 E against elimination, relative",
        apart / largest,
        AtMost(1e-6),
    );
}
