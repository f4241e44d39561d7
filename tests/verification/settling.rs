//! A scene that settles first starts in equilibrium: penetration, stress and rest.

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Settle;

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;
use crate::simulation;

const SCENE: &str = "(title: \"stack\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: (0, 0, -9.8),
    materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
    blocks: [
        (name: \"floor\", material: \"rock\", shape: Box(size_m: (3, 3, 1), cells: (3, 3, 1)), at_m: (-1, -1, -1)),
        (name: \"lower\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2))),
        (name: \"upper\", material: \"rock\", shape: Box(size_m: (1, 1, 0.5), cells: (2, 2, 1)), at_m: (0, 0, 1)),
    ],
    supports: [(block: \"floor\", on: All, hold: Fixed)],
    contact: Potential(penalty_pa: 2e8, potential: Smooth(reference_m: 1), friction: (friction_deg: 30)))";

#[test]
fn a_stack_that_has_settled_lies_as_deep_as_its_weight_asks_for_and_stays() {
    let mut simulation = simulation(SCENE);
    let settled = simulation.settle(&Settle::new(1e-6, 100_000)).unwrap();
    assert!(settled.steps > 10 && settled.speed_ratio <= 1e-6, "{settled:?}");
    // p = 2 k_n h/L₀ under the weight of what is above.
    let sunk = |block: u32| {
        let nodes = simulation.blocks().nodes_of(BlockId(block));
        let rest = &simulation.blocks().rest_position[nodes.clone()];
        let lowest = |x: &[Vec3]| x.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
        lowest(rest) - lowest(&simulation.state().position[nodes])
    };
    let pressure = 2500.0 * 9.8 * 1.5;
    let expected = pressure / (2.0 * 2e8);
    row("settling", "depth of a stack that has settled [m]", sunk(1), Within(expected, 1e-2));

    assert_eq!(simulation.time_s(), 0.0);
    simulation.sample().unwrap();
    for _ in 0..1000 {
        simulation.step().unwrap();
    }
    let moved = simulation.state().position.iter().zip(simulation.start_position());
    let furthest = moved.map(|(x, start)| (x - start).norm()).fold(0.0, f64::max);
    row("settling", "motion afterwards over that depth", furthest / expected, AtMost(1e-4));
    let sample = simulation.sample().unwrap();
    assert!(sample.load_j.abs() < 1e-4 * 2500.0 * 9.8 * 1.5 * expected, "{sample:?}");
}
