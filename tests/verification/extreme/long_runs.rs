//! Runs of many steps: a block that coasts, one that spins. `NDDA_STEPS=1000000` for a million.

use ndda_fem::stress::volume_m3;
use ndda_mesh::BlockId;

use super::{advance, extreme};
use crate::displacements;
use crate::evidence::Answer::AtMost;
use crate::evidence::{rounding, row};

fn steps(usual: u64) -> u64 {
    std::env::var("NDDA_STEPS").ok().and_then(|n| n.parse().ok()).unwrap_or(usual)
}

#[test]
fn a_block_that_coasts_is_where_its_velocity_takes_it() {
    let mut simulation = extreme("coasting", &[]).simulation;
    let steps = steps(50_000);
    advance(&mut simulation, steps);
    assert_eq!(simulation.time_s(), steps as f64 * 1e-3, "t is n Δt");
    let exact = ndda_mesh::Vec3::new(0.3, -0.1, 0.7) * simulation.time_s();
    let error = displacements(&simulation).iter().map(|u| (u - exact).norm()).fold(0.0, f64::max);
    row(
        "extreme: coasting",
        &format!("error of the place after {steps} steps over an edge"),
        error,
        AtMost(1e-9),
    );
}

#[test]
fn a_block_that_spins_keeps_its_volume_and_has_no_false_stress() {
    for step_s in ["1e-2", "1e-3", "1e-4"] {
        let mut simulation = extreme("spin", &[&format!("time.step_s={step_s}")]).simulation;
        let volume =
            |s: &ndda_solver::Simulation| volume_m3(&s.shape(BlockId(0)).operator, &s.state().position);
        let first = volume(&simulation);
        let mut stress = vec![[0.0; 6]; simulation.blocks().tets.len()];
        let (mut largest, mut drift, steps) = (0.0f64, 0.0f64, steps(20_000));
        for _ in 0..100 {
            advance(&mut simulation, steps / 100);
            simulation.recover_stress(&mut stress).unwrap();
            largest = stress.iter().flatten().fold(largest, |most, s| most.max(s.abs()));
            drift = drift.max((volume(&simulation) / first - 1.0).abs());
        }
        row(
            "extreme: fast spin",
            &format!("change of volume in {steps} steps of {step_s} s at 1 rad/s"),
            drift,
            AtMost(1e-9),
        );
        // Centrifugal forces stress it by ρ ω² r²/E of E, r half of its diagonal: tenfold, and the rounding of the steps.
        let centrifugal = 2600.0 * (0.15 * 0.15 + 0.1 * 0.1 + 0.05 * 0.05) / 200e9;
        row(
            "extreme: fast spin",
            &format!("largest stress over E, steps of {step_s} s"),
            largest / 200e9,
            AtMost(10.0 * centrifugal + rounding(steps as u32)),
        );
    }
}
