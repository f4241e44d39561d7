//! Supports by the paper's springs of 10⁶ E against supports by elimination: they differ by the ratio of stiffnesses.

use crate::evidence::Answer::AtMost;
use crate::evidence::row;
use crate::{bar, displacements, rollers, settle, simulation};

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

/// Momentum that appears from nowhere in a box under gravity that is held on its foot, over its largest.
fn momentum_of_a_held_box(body: &str, integrator: &str, hold: &str) -> f64 {
    let mut simulation = simulation(&format!(
        "(title: \"held\", time: (step_s: 1e-3, end_s: 1, integrator: {integrator}), gravity_m_s2: (0, 0, -9.8),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500, damping: (mass_per_s: 5))],
          blocks: [(name: \"box\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 2), cells: (1, 1, 2)))],
          supports: [(block: \"box\", on: Plane(point_m: (0, 0, 0), normal: (0, 0, 1)), {hold})])"
    ));
    simulation.sample().unwrap();
    for _ in 0..200 {
        simulation.step().unwrap();
        simulation.sample().unwrap();
    }
    simulation.invariants().linear_momentum
}

#[test]
fn reactions_of_a_held_block_explain_its_momentum_whatever_holds_it() {
    for body in ["Elastic", "Affine"] {
        let mut worst = 0.0f64;
        for integrator in
            ["Midpoint(theta: 0.5)", "Newmark(alpha: 0.5, delta: 1)", "GeneralizedAlpha(radius: 0.8)"]
        {
            for hold in
                ["hold: Fixed", "hold: Normal", "hold: Fixed, by: Springs()", "hold: Normal, by: Springs()"]
            {
                worst = worst.max(momentum_of_a_held_box(body, integrator, hold));
            }
        }
        let what = format!("momentum from nowhere of a box held on its foot, {body}");
        row("supports", &what, worst, AtMost(1e-10));
    }
}
