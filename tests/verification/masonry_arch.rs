//! A semicircular arch of rigid stones that cannot slide stands when its thickness over its mean radius exceeds
//! 0.1075, and falls by hinges below (Milankovitch 1907; Ochsendorf 2002).

use std::fmt::Write;

use crate::evidence::Answer::{AtLeast, AtMost};
use crate::evidence::row;
use crate::simulation;

const RADIUS_M: f64 = 5.0;
const STONES: u32 = 13;
const STEP_S: f64 = 1e-4;

fn arch(thickness: f64) -> String {
    let (inner, outer) = (RADIUS_M * (1.0 - 0.5 * thickness), RADIUS_M * (1.0 + 0.5 * thickness));
    let mut stones = String::new();
    for k in 0..STONES {
        let at = |k: u32| 180.0 * f64::from(k) / f64::from(STONES);
        writeln!(
            stones,
            "(name: \"stone_{k}\", material: \"rock\", body: Rigid, shape: Voussoir(inner_radius_m: {inner}, outer_radius_m: {outer},
              start_deg: {}, end_deg: {}, width_m: 1, cells: (4, 1, 1))),",
            at(k),
            at(k + 1)
        )
        .unwrap();
    }
    for (name, x) in [("right", RADIUS_M - 1.0), ("left", -RADIUS_M - 1.0)] {
        writeln!(
            stones,
            "(name: \"{name}\", material: \"rock\", body: Fixed, at_m: ({x}, -0.5, -1), shape: Box(size_m: (2, 2, 1), cells: (1, 1, 1))),"
        )
        .unwrap();
    }
    format!(
        "(title: \"arch\", time: (step_s: {STEP_S:e}, end_s: 1), gravity_m_s2: (0, 0, -9.8), gravity_ramp_s: 0.4,
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)], blocks: [{stones}],
          contact: Potential(penalty_pa: 1e10, potential: Smooth(reference_m: 1), friction: (friction_deg: 60)))"
    )
}

/// How far the lowest stone has sunk after a second [m].
fn sinks(thickness: f64) -> f64 {
    let mut simulation = simulation(&arch(thickness));
    let start = simulation.start_position().to_vec();
    for _ in 0..(1.0 / STEP_S) as u32 {
        simulation.step().unwrap();
    }
    let moved = simulation.state().position.iter().zip(&start);
    moved.map(|(x, start)| start.z - x.z).fold(0.0, f64::max)
}

#[test]
fn a_semicircular_arch_stands_above_milankovitchs_thickness_and_falls_below_it() {
    for (thickness, stands) in [(0.12, true), (0.1, false)] {
        let sunk = sinks(thickness);
        let answer = if stands { AtMost(1e-2) } else { AtLeast(0.1) };
        row(
            "masonry arch",
            &format!("sinking of an arch of t/R = {thickness} within a second [m]"),
            sunk,
            answer,
        );
    }
}
