//! Blocks that deform on their way to rest, with the masses with which contact makes all of them oscillate as fast as the step allows.

use std::ops::ControlFlow;

use ndda_mesh::BlockId;
use ndda_solver::{Damping, Settle, Settled, Simulation};

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;
use crate::extreme::farthest;
use crate::simulation;

/// A tower of blocks that deform under a thin plate, which limits the step.
fn tower(body: &str, step_s: f64) -> Simulation {
    simulation(&format!(
        "(title: \"tower\", time: (step_s: {step_s}, end_s: 1), gravity_m_s2: (0, 0, -9.8),
          materials: [(name: \"rock\", young_pa: 2e10, poisson: 0, density_kg_m3: 2500)],
          blocks: [
              (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (6, 6, 1), cells: (1, 1, 1)), at_m: (-1, -1, -1)),
              (name: \"first\", material: \"rock\", body: {body}, shape: Box(size_m: (4, 4, 4), cells: (2, 2, 2))),
              (name: \"second\", material: \"rock\", body: {body}, shape: Box(size_m: (4, 4, 4), cells: (2, 2, 2)), at_m: (0, 0, 4)),
              (name: \"third\", material: \"rock\", body: {body}, shape: Box(size_m: (4, 4, 4), cells: (2, 2, 2)), at_m: (0, 0, 8)),
              (name: \"plate\", material: \"rock\", body: {body}, shape: Box(size_m: (4, 4, 0.25), cells: (2, 2, 1)), at_m: (0, 0, 12)),
          ],
          contact: Potential(penalty_pa: 2e8, potential: Smooth(reference_m: 1), friction: (friction_deg: 30, shear_penalty_pa_m: 2e8)))"
    ))
}

/// Scaled masses and adaptive damping.
fn scaled(tolerance: f64) -> Settle {
    Settle { damping: Some(Damping::Adaptive), mass_scaling: true, ..Settle::new(tolerance, 100_000) }
}

#[test]
fn a_tower_that_deforms_settles_as_deep_with_scaled_masses_in_half_of_the_steps() {
    for body in ["Elastic", "Affine"] {
        let steps = [false, true].map(|mass_scaling| {
            let mut simulation = tower(body, 1e-4);
            let settle = if mass_scaling { scaled(1e-6) } else { Settle::new(1e-6, 100_000) };
            let settled = simulation.settle(&settle).unwrap();
            assert_eq!(settled.inertia_factors.is_some(), mass_scaling);
            let plate = simulation.blocks().nodes_of(BlockId(4));
            let sunk = simulation.blocks().rest_position[plate.clone()]
                .iter()
                .zip(&simulation.state().position[plate])
                .map(|(rest, x)| rest.z - x.z)
                .fold(0.0, f64::max);
            // Σ p/2 k_n of the four joints under the weight of what is above each, and the column shortens by ½ ρ g H²/E.
            let heights_m = [12.25, 8.25, 4.25, 0.25].iter().sum::<f64>();
            let (weight_n_m3, height_m) = (2500.0 * 9.8, 12.25);
            let expected = weight_n_m3 * (heights_m / (2.0 * 2e8) + 0.5 * height_m * height_m / 2e10);
            let way = if mass_scaling { "scaled" } else { "true" };
            // An affine block has one strain in all of it, which is that under half of its own weight: as short as the elastic one.
            let what = format!("depth of a tower of blocks, {body}, {way} masses [m]");
            row("settling of deforming blocks", &what, sunk, Within(expected, 1e-2));
            for _ in 0..1000 {
                simulation.step().unwrap();
            }
            let what = format!("motion of that tower afterwards over its depth, {body}, {way} masses");
            // The tolerance: an oscillation about rest with 1e-6 of the largest speed on the way swings by as much of the depth to either side, and the plate,
            // where it has all that energy by itself, as its mass is a 49th of all.
            row(
                "settling of deforming blocks",
                &what,
                farthest(&simulation) / expected,
                AtMost(2e-6 * 49f64.sqrt()),
            );
            settled.steps
        });
        assert!(2 * steps[1] <= steps[0], "{body}: {steps:?}");
    }
}

/// Only mass over Δt² counts on the way to rest. Factors are powers of two, and so is the square of this ratio of steps.
#[test]
fn with_scaled_masses_of_deforming_blocks_steps_to_rest_do_not_depend_on_the_step() {
    let settled = |step_s: f64| tower("Elastic", step_s).settle(&scaled(1e-6)).unwrap();
    let (long, short) = (settled(1.28e-4), settled(2e-6));
    let what = "steps to rest with scaled masses: a 64th of the step over the step";
    let one = 1.0 / long.steps as f64;
    row("settling of deforming blocks", what, short.steps as f64 / long.steps as f64, Within(1.0, one));
    let factors = |settled: Settled| settled.inertia_factors.unwrap();
    assert_eq!(factors(short).map(|factor| 4096.0 * factor), factors(long));
}

/// Masses and factors are those of before to the last bit: a scene that has settled goes on as one that takes over its state.
#[test]
fn after_settling_blocks_that_deform_go_on_with_their_own_masses() {
    for body in ["Elastic", "Affine"] {
        let mut settled = tower(body, 1e-4);
        settled.settle(&scaled(1e-4)).unwrap();
        let mut other = tower(body, 1e-4);
        other.restore(settled.snapshot()).unwrap();
        for _ in 0..50 {
            settled.step().unwrap();
            other.step().unwrap();
        }
        assert_eq!(settled.state(), other.state());
    }
}

/// Contact gets stiffer on the way where a block that touches with an edge at first comes to lie on a face: its mass follows, and it comes to rest.
#[test]
fn a_block_that_tips_onto_its_face_while_it_settles_comes_to_rest() {
    let mut simulation = simulation(
        "(title: \"tips\", time: (step_s: 1e-4, end_s: 1), gravity_m_s2: (0, 0, -9.8),
          materials: [(name: \"rock\", young_pa: 2e9, poisson: 0.2, density_kg_m3: 2500)],
          blocks: [
              (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (6, 6, 1), cells: (1, 1, 1)), at_m: (-3, -3, -1)),
              (name: \"slab\", material: \"rock\", shape: Box(size_m: (2, 2, 0.5), cells: (2, 2, 1)), at_m: (-1, -1, 0.001), turns: [(axis: (0, 1, 0), angle_deg: 2)]),
          ],
          contact: Potential(penalty_pa: 2e8, potential: Smooth(reference_m: 1), friction: (friction_deg: 30, shear_penalty_pa_m: 2e8)))",
    );
    simulation.settle(&scaled(1e-4)).unwrap();
    let slab = simulation.blocks().nodes_of(BlockId(1));
    let heights = simulation.state().position[slab].iter().map(|x| x.z);
    let lowest = heights.fold(f64::INFINITY, f64::min);
    // p/2 k_n under its weight.
    let depth_m = 2500.0 * 9.8 * 0.5 / (2.0 * 2e8);
    row(
        "settling of deforming blocks",
        "depth of a slab that has tipped onto its face [m]",
        -lowest,
        Within(depth_m, 0.02),
    );
}

#[test]
fn settling_of_deforming_blocks_goes_on_from_any_step_with_the_same_bits() {
    for damping in [Damping::Adaptive, Damping::Kinetic] {
        let settle = Settle { damping: Some(damping), ..scaled(1e-3) };
        let mut whole = tower("Elastic", 1e-4);
        let all = whole.settle(&settle).unwrap().steps;
        for broken_off in (1..all).step_by(17) {
            let mut first = tower("Elastic", 1e-4);
            let mut settling = first.begin_to_settle(&settle);
            let mut until = |settled: &Settled| match settled.steps == broken_off {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            };
            assert!(!first.go_on_settling(&settle, &mut settling, &mut until).unwrap());
            let kept = postcard::to_stdvec(&(first.snapshot(), &settling)).unwrap();
            let (snapshot, mut settling) = postcard::from_bytes(&kept).unwrap();
            let mut second = tower("Elastic", 1e-4);
            second.restore(snapshot).unwrap();
            assert!(
                second.go_on_settling(&settle, &mut settling, &mut |_| ControlFlow::Continue(())).unwrap()
            );
            assert_eq!(second.state(), whole.state(), "broken off after {broken_off} of {all} steps");
        }
    }
}
