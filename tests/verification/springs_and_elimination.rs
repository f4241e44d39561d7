//! Supports by the paper's springs of 10⁶ E against supports by elimination: they differ by the ratio of stiffnesses.

use crate::evidence::Answer::AtMost;
use crate::evidence::row;
use crate::{bar, displacements, rollers, settle};

#[test]
fn springs_give_what_elimination_gives_up_to_their_own_softness() {
    let loads = "tractions: [(block: \"bar\", on: Set(\"x_max\"), traction_pa: (1e5, 2e4, 0))]";
    let mut held = bar("", &rollers(""), loads);
    let mut sprung = bar("", &rollers("by: Springs()"), loads);
    settle(&mut held);
    settle(&mut sprung);
    let (held, sprung) = (displacements(&held), displacements(&sprung));
    let largest = held.iter().map(|u| u.norm()).fold(0.0, f64::max);
    let apart = held.iter().zip(&sprung).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    // The bar is about E · 0.25 m stiff, a spring 10⁶ E · 1 m.
    row("supports", "springs of 1e6 E against elimination, relative", apart / largest, AtMost(1e-5));
    assert!(apart > 0.0, "springs that do not give at all are no springs");
}
