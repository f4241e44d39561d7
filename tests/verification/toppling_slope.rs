//! The toppling slope of Goodman and Bray (1976): sixteen blocks on a stepped base, which stand or topple by the
//! friction between them, against their limit equilibrium.

use std::fmt::Write;

use ndda_solver::{Settle, StepError};

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;
use crate::simulation;

const WIDTH_M: f64 = 10.0;
const DIP_DEG: f64 = 30.0;
/// How much higher the base of a block is than that of the block below it.
const STEP_M: f64 = 1.0;
/// Heights from the toe up; the tenth is the crest.
const HEIGHTS_M: [f64; 16] =
    [4.0, 8.0, 12.0, 16.0, 20.0, 24.0, 28.0, 32.0, 36.0, 40.0, 34.0, 28.0, 22.0, 16.0, 10.0, 4.0];

/// The force that block n−1 has to carry from block n, from the back of the slope to its toe, over γ Δx [m²]
/// (Goodman & Bray 1976, eqs. 5 and 7): what keeps n from toppling or from sliding, whichever is more,
///   P_t = [P (M − Δx tan φ) + ½ W (y sin α − Δx cos α)] / L,   P_s = P − W (cos α tan φ − sin α) / (1 − tan² φ),
/// where the push of the block above acts at its own or at this block's upper corner, M above the base, and the push
/// on the block below at L.
fn force_at_the_toe(tan_phi: f64) -> f64 {
    let (sin, cos) = DIP_DEG.to_radians().sin_cos();
    let top = |n: usize| STEP_M * n as f64 + HEIGHTS_M[n];
    let mut push = 0.0_f64;
    for n in (0..HEIGHTS_M.len()).rev() {
        let (weight, base) = (HEIGHTS_M[n], STEP_M * n as f64);
        let above = if n + 1 < HEIGHTS_M.len() { top(n + 1).min(top(n)) } else { top(n) };
        let below = if n > 0 { top(n - 1).min(top(n)) } else { top(n) };
        let (m, l) = (above - base, below - base);
        let toppling =
            (push * (m - WIDTH_M * tan_phi) + 0.5 * weight * (HEIGHTS_M[n] * sin - WIDTH_M * cos)) / l;
        let sliding = push - weight * (cos * tan_phi - sin) / (1.0 - tan_phi * tan_phi);
        push = toppling.max(sliding).max(0.0);
    }
    push
}

/// The friction at which nothing is left to be carried at the toe [degrees].
fn limit_deg() -> f64 {
    let (mut falls, mut stands) = (31.0_f64, 44.0_f64);
    for _ in 0..60 {
        let middle = 0.5 * (falls + stands);
        let bears = force_at_the_toe(middle.to_radians().tan()) > 0.0;
        *(if bears { &mut falls } else { &mut stands }) = middle;
    }
    stands
}

fn scene(friction_deg: f64) -> String {
    let mut blocks = String::new();
    for (n, height) in HEIGHTS_M.iter().enumerate() {
        let (x, z) = (WIDTH_M * n as f64, STEP_M * n as f64);
        let shape =
            |height| format!("shape: Box(size_m: ({WIDTH_M}, {WIDTH_M}, {height}), cells: (1, 1, 1))");
        writeln!(
            blocks,
            "(name: \"b{n}\", material: \"rock\", body: Rigid, {}, at_m: ({x}, 0, {z})),",
            shape(*height)
        )
        .unwrap();
        writeln!(
            blocks,
            "(name: \"s{n}\", material: \"rock\", body: Fixed, {}, at_m: ({x}, 0, {})),",
            shape(WIDTH_M),
            z - WIDTH_M
        )
        .unwrap();
    }
    let (sin, cos) = DIP_DEG.to_radians().sin_cos();
    format!(
        "(title: \"toppling slope\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: ({}, 0, {}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)], blocks: [{blocks}],
          contact: Potential(penalty_pa: 2e9, potential: Smooth(),
              friction: (friction_deg: {friction_deg}, shear_penalty_pa_m: 2e9)))",
        -9.8 * sin,
        -9.8 * cos
    )
}

#[test]
fn the_limit_equilibrium_is_the_published_one() {
    // tan φ = 0.7855 in their Table 1.
    let limit = limit_deg().to_radians().tan();
    row("toppling", "tan φ of the limit equilibrium of Goodman and Bray", limit, Within(0.7855, 5e-3));
}

#[test]
fn the_slope_stands_above_its_limit_friction_and_topples_below_it() {
    let settle = Settle::new(1e-3, 6000);
    let limit = limit_deg();
    let mut stands = simulation(&scene(limit + 0.5));
    stands.settle(&settle).unwrap();
    let begun = stands.state().position.clone();
    for _ in 0..1000 {
        stands.step().unwrap();
    }
    let way_m = stands.state().position.iter().zip(&begun).map(|(x, from)| (x - from).norm());
    let fall_m = 0.5 * 9.8 * stands.time_s().powi(2);
    let named =
        format!("way in the second after it has settled at φ = {:.2}°, over a free fall", limit + 0.5);
    // A slope that lacks half a degree goes tan(φ + ½°) − tan φ = 0.014 of it; one that stands, a tenth of that at most.
    row("toppling", &named, way_m.fold(0.0, f64::max) / fall_m, AtMost(1.4e-3));
    let mut falls = simulation(&scene(limit - 0.5));
    let refused = falls.settle(&settle).unwrap_err();
    assert!(matches!(refused, StepError::NotSettled { .. }), "{refused}");
}
