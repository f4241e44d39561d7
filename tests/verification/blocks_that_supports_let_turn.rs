//! Blocks that springs, or nodes that move, hold at three nodes and more turn nevertheless: by any angle, without strain.

use ndda::judge::verdict;
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;

use crate::evidence::Answer::{AtMost, Near, Within};
use crate::evidence::row;
use crate::simulation;

const MATERIAL: &str = "materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)]";
const DENSITY: f64 = 2650.0;

fn spin(simulation: &Simulation) -> Vec3 {
    let shape = simulation.shape(BlockId(0));
    shape.operator.rigid_motion(&simulation.state().position, &simulation.state().velocity).spin_rad_s
}

/// The node that was at a place, and where it is now.
fn node_from(simulation: &Simulation, place: Vec3) -> Vec3 {
    let rest = &simulation.blocks().rest_position;
    let nearest =
        (0..rest.len()).min_by(|a, b| (rest[*a] - place).norm().total_cmp(&(rest[*b] - place).norm()));
    simulation.state().position[nearest.unwrap()]
}

/// Angle and rate of a pendulum I θ″ = −κ sin θ that starts at θ = 0, by small steps.
fn pendulum(rate2: f64, start_rad_s: f64, end_s: f64) -> (f64, f64) {
    let steps = 200_000;
    let dt = end_s / f64::from(steps);
    let (mut angle, mut rate) = (0.0f64, start_rad_s);
    for _ in 0..steps {
        angle += 0.5 * dt * rate;
        rate -= dt * rate2 * angle.sin();
        angle += 0.5 * dt * rate;
    }
    (angle, rate)
}

#[test]
fn a_cube_that_spins_on_springs_at_all_nodes_swings_as_a_pendulum_does() {
    let (stiffness_n_m, step_s): (f64, f64) = (1e5, 2.5e-5);
    for body in ["Affine", "Elastic"] {
        let mut simulation = simulation(&format!(
            "(title: \"springs\", time: (step_s: {step_s}, end_s: 1), {MATERIAL},
              blocks: [(name: \"b\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)), spin_rad_s: (0, 0, 20))],
              supports: [(block: \"b\", on: All, hold: Fixed, by: Springs(stiffness_n_m: {stiffness_n_m}))],
              contact: Off)"
        ));
        let rest = &simulation.blocks().rest_position;
        let center = rest.iter().sum::<Vec3>() / rest.len() as f64;
        let arms2: f64 = rest.iter().map(|x| (x - center).xy().norm_squared()).sum();
        let (angle, rate) = pendulum(stiffness_n_m * arms2 / (DENSITY / 6.0), 20.0, 0.5);
        crate::advance(&mut simulation, (0.5 / step_s).round() as u64);
        let what = format!(
            "spin of a block ({body}) on springs, which turns by more than 90°, off a pendulum, over 20 rad/s"
        );
        row("supports let turn", &what, (spin(&simulation).z - rate) / 20.0, Near(0.0, 2e-3));
        let turned =
            nalgebra::Rotation3::new(Vec3::z() * angle) * (Vec3::new(1.0, 1.0, 1.0) - center) + center;
        let corner = node_from(&simulation, Vec3::new(1.0, 1.0, 1.0));
        let what =
            format!("place of its corner ({body}), off the pendulum, over its distance from the centre");
        row("supports let turn", &what, (corner - turned).norm() / (0.5 * 3f64.sqrt()), AtMost(2e-3));
    }
}

#[test]
fn a_block_on_springs_that_is_pushed_at_its_top_stands_where_statics_say() {
    let (force_n, foot_n_m) = (150e3, 1e6);
    let mut simulation = simulation(&format!(
        "(title: \"subgrade\", time: (step_s: 2e-4, end_s: 6),
          materials: [(name: \"rock\", young_pa: 20e12, poisson: 0.25, density_kg_m3: {DENSITY}, damping: (mass_per_s: 20))],
          blocks: [(name: \"b\", material: \"rock\", body: Elastic, shape: Box(size_m: (1, 1, 3), cells: (2, 2, 2)))],
          supports: [(block: \"b\", on: Set(\"z_min\"), hold: Fixed, by: Springs(stiffness_n_m: {foot_n_m}))],
          forces: [(block: \"b\", at_m: (0.5, 0.5, 3), force_n: ({force_n}, 0, 0))],
          contact: Off)"
    ));
    crate::advance(&mut simulation, 30_000);
    // Nine springs under the foot: Σ k x² sin θ cos θ + … reduces to κ sin θ, κ = Σ k x², against F h cos θ of the arm to the centre of the foot; the foot gives way by F/9k.
    let rest = &simulation.blocks().rest_position;
    let foot = rest.iter().filter(|x| x.z == 0.0);
    let (nodes, second): (f64, f64) = foot.fold((0.0, 0.0), |(n, s), x| (n + 1.0, s + (x.x - 0.5).powi(2)));
    let tangent = force_n * 3.0 / (foot_n_m * second);
    let angle = tangent.atan();
    let shift = force_n / (nodes * foot_n_m);
    let top = node_from(&simulation, Vec3::new(0.5, 0.5, 3.0)) - Vec3::new(0.5, 0.5, 3.0);
    row(
        "supports let turn",
        "top of a block on springs pushed there, along the push, over statics",
        top.x / (shift + 3.0 * angle.sin()),
        Within(1.0, 1e-4),
    );
    row(
        "supports let turn",
        "how far it sinks, over statics",
        top.z / (3.0 * (angle.cos() - 1.0)),
        Within(1.0, 1e-3),
    );
}

#[test]
fn a_block_that_the_motion_of_an_edge_turns_has_no_strain() {
    let end_s = 0.7;
    let angle = |t: f64| 10f64.to_radians() * (1.0 - (std::f64::consts::PI * t).cos());
    let rows: String = (0..=200)
        .map(|i| {
            let t = 0.005 * f64::from(i);
            let (sin, cos) = angle(t).sin_cos();
            format!("(time_s: {t}, displacement_m: ({}, 0, {sin})),", cos - 1.0)
        })
        .collect();
    let mut simulation = simulation(&format!(
        "(title: \"lever\", time: (step_s: 2.5e-5, end_s: 1),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650, damping: (stiffness_s: 1e-4))],
          blocks: [(name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)))],
          supports: [(block: \"b\", on: Plane(point_m: (0, 0, 0), normal: (-1, 0, -1)), hold: Fixed),
                     (block: \"b\", on: Plane(point_m: (1, 0, 0), normal: (1, 0, -1)), hold: Motion([{rows}]))],
          contact: Off)"
    ));
    crate::advance(&mut simulation, (end_s / 2.5e-5f64).round() as u64);
    let (sin, cos) = angle(end_s).sin_cos();
    let exact = Vec3::new(cos - sin, 0.5, sin + cos);
    let top = node_from(&simulation, Vec3::new(1.0, 0.5, 1.0));
    row(
        "supports let turn",
        "place of a corner of a block turned by the motion of an edge, off a rotation [m]",
        (top - exact).norm(),
        AtMost(1e-3),
    );
    let sample = simulation.sample().unwrap();
    // As if linear in the displacements: 4.3 MJ.
    row("supports let turn", "strain energy of that block [J]", sample.strain_j, AtMost(100.0));
}

#[test]
fn a_block_that_is_computed_as_if_it_did_not_turn_is_called_inaccurate_where_it_does() {
    let label = |ties: &str, spin: f64| {
        let text = format!(
            "(title: \"ties\", time: (step_s: 1e-4, end_s: 1), {MATERIAL},
              blocks: [(name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)), spin_rad_s: ({spin}, 0, 0))],
              {ties} contact: Off)"
        );
        let mut simulation = simulation(&text);
        simulation.sample().unwrap();
        crate::advance(&mut simulation, 5000);
        simulation.sample().unwrap();
        verdict::label(&simulation, None)
    };
    let tied = "ties: [(block: \"b\", on: [Plane(point_m: (0, 0, 0), normal: (0, -1, -1))])],";
    let found = label(tied, 1.0);
    assert!(
        found.reasons.iter().any(|reason| reason.contains("as if its supports kept it from turning")),
        "{found:?}"
    );
    for (ties, spin) in [(tied, 1e-6), ("", 1.0)] {
        let found = label(ties, spin);
        assert!(!found.reasons.iter().any(|reason| reason.contains("kept it from turning")), "{found:?}");
    }
}
