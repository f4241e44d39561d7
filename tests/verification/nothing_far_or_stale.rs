//! Results do not depend on things far away, on what was computed before, or on waiting.

use std::path::Path;

use ndda::Model;
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{Settle, Simulation};

use crate::evidence::Answer::AtMost;
use crate::evidence::row;
use crate::{advance, simulation};

/// Two cubes that meet; `more` are further blocks.
fn collision(more: &str) -> Simulation {
    simulation(&format!(
        "(title: \"far\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: (0, 0, -9.8),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
          blocks: [
            (name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)), velocity_m_s: (1, 0, 0.1)),
            (name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 1, 2)), at_m: (1.01, 0.2, 0.3)),
            {more}
          ],
          contact: Potential(penalty_pa: 1e7, friction: (friction_deg: 30, shear_penalty_pa_m: 1e7)))"
    ))
}

#[test]
fn blocks_far_away_leave_every_bit_of_a_collision_as_it_is() {
    let (mut alone, mut with) = (
        collision(""),
        collision(
            "(name: \"far\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (30, -40, 0)),
             (name: \"near far\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (30, -40, 0.9))",
        ),
    );
    assert_eq!(alone.blocks().origin_m, with.blocks().origin_m);
    for _ in 0..200 {
        alone.step().unwrap();
        with.step().unwrap();
    }
    assert!(alone.invariants().contact_pairs_max > 0, "they do not meet");
    let nodes = alone.state().position.len();
    assert_eq!(alone.state().position, with.state().position[..nodes]);
    assert_eq!(alone.state().velocity, with.state().velocity[..nodes]);
    let apart = alone.state().position.iter().zip(&with.state().position).map(|(a, b)| (a - b).norm());
    row(
        "far blocks, resumed runs, rest",
        "what far blocks change in a collision [m]",
        apart.fold(0.0, f64::max),
        AtMost(0.0),
    );
}

#[test]
fn a_run_that_goes_on_from_a_snapshot_has_the_same_friction_to_the_bit() {
    // A plate on its way from sticking to sliding, with either law of friction.
    for scene in ["sliding_30_phi25_spring", "sliding_30_phi25_velocity"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{scene}.ron"));
        let start = || Model::open(&path, &[]).unwrap().simulation;
        let mut whole = start();
        advance(&mut whole, 150);
        let mut resumed = start();
        resumed.restore(whole.snapshot()).unwrap();
        for _ in 0..150 {
            whole.step().unwrap();
            resumed.step().unwrap();
        }
        assert!(!whole.state().contact.facets.is_empty() || scene.contains("velocity"), "no memory");
        assert_eq!(whole.state(), resumed.state(), "{scene}");
    }
}

#[test]
fn a_cube_at_rest_for_ten_seconds_does_not_tilt() {
    let mut simulation = simulation(
        "(title: \"rest\", time: (step_s: 5e-4, end_s: 10), gravity_m_s2: (0, 0, -9.8),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
          blocks: [
            (name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (3, 3, 1), cells: (3, 3, 1)), at_m: (-1, -1, -1)),
            (name: \"cube\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2))),
          ],
          contact: Potential(penalty_pa: 1e7, friction: (friction_deg: 30)))",
    );
    simulation.settle(&Settle::new(1e-6, 100_000)).unwrap();
    let early = second_of(&mut simulation);
    advance(&mut simulation, 16_000);
    let late = second_of(&mut simulation);
    let moved: Vec<Vec3> = late.iter().zip(&early).map(|(late, early)| late - early).collect();
    let (low, high) =
        moved.iter().fold((f64::INFINITY, -f64::INFINITY), |(l, h), u| (l.min(u.z), h.max(u.z)));
    row(
        "far blocks, resumed runs, rest",
        "tilt of a cube at rest from the first second to the tenth [rad]",
        high - low,
        // It settled to 1e-6 of its largest speed, that of sinking by up to ρ g h/2 k_n: that part of it, over the metre of its width.
        AtMost(1e-6 * 2500.0 * 9.8 / (2.0 * 1e7)),
    );
    row(
        "far blocks, resumed runs, rest",
        "drift of it [m]",
        moved.iter().map(|u| u.norm()).fold(0.0, f64::max),
        AtMost(1e-7),
    );
}

/// Mean places of the cube's nodes over a second: a vibration is no tilt.
fn second_of(simulation: &mut Simulation) -> Vec<Vec3> {
    let (nodes, steps) = (simulation.blocks().nodes_of(BlockId(1)), 2000);
    let mut mean = vec![Vec3::zeros(); nodes.len()];
    for _ in 0..steps {
        simulation.step().unwrap();
        let places = &simulation.state().position[nodes.clone()];
        mean.iter_mut().zip(places).for_each(|(mean, x)| *mean += x / f64::from(steps));
    }
    mean
}
