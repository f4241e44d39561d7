//! Damped contact of an edge or a corner in a face: what is damped is the approach of the blocks along the force between them, and not that the edge slides.

use ndda_mesh::Vec3;
use ndda_solver::Simulation;

use crate::evidence::Answer::{Near, Within};
use crate::evidence::row;
use crate::simulation;

const MATERIAL: &str = "materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)]";
const FLOOR: &str = "(name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (20, 4, 1), cells: (1, 1, 1)), at_m: (-10, -1.5, -1))";

/// Velocity and spin of the cube or the plank.
fn motion(simulation: &Simulation) -> (Vec3, Vec3) {
    let block = ["cube", "plank"].iter().find_map(|name| simulation.blocks().find(name)).unwrap();
    let nodes = simulation.blocks().nodes_of(block);
    let operator = &simulation.shape(block).operator;
    let (position, velocity) =
        (&simulation.state().position[nodes.clone()], &simulation.state().velocity[nodes]);
    (operator.momentum(velocity) / operator.mass_kg, operator.rigid_motion(position, velocity).spin_rad_s)
}

/// A cube with an edge down on a plane floor, after a time.
fn cube_on_its_edge(body: &str, motion: (Vec3, f64), contact: &str, end_s: f64) -> Vec3 {
    cube_on(&format!("blocks: [{FLOOR},"), body, motion, contact, end_s)
}

/// The same on another floor.
fn cube_on(floor: &str, body: &str, (velocity, gravity): (Vec3, f64), contact: &str, end_s: f64) -> Vec3 {
    let [x, _, z] = [velocity.x, velocity.y, velocity.z];
    let step_s: f64 = 2e-5;
    let mut simulation = simulation(&format!(
        "(title: \"edge\", time: (step_s: {step_s}, end_s: 1), gravity_m_s2: (0, 0, -{gravity}), {MATERIAL},
          {floor}
            (name: \"cube\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1), pattern: TwentyFour),
             turns: [(axis: (0, 1, 0), angle_deg: 45)], at_m: (0, 0, {}), velocity_m_s: ({x}, 0, {z}))],
          contact: Potential(penalty_pa: 1e9, potential: Smooth(), {contact}))",
        0.5f64.sqrt()
    ));
    crate::advance(&mut simulation, (end_s / step_s).round() as u64);
    motion(&simulation).0
}

/// The floor with a step at its far end, so that it is not convex.
fn stepped_floor() -> String {
    let outline = "[(-3, -1), (9, -1), (9, 1), (8.5, 1), (8.5, 0), (-3, 0)]";
    format!(
        "rock: [(name: \"floor\", material: \"rock\", body: Fixed, domain: Column(outline_m: {outline}, axis: Y, start_m: -1, end_m: 3))], blocks: ["
    )
}

#[test]
fn an_edge_that_slides_on_a_smooth_floor_is_not_braked() {
    let plate = format!("blocks: [{FLOOR},");
    for (floor, name) in [(&plate, "a plate"), (&stepped_floor(), "a floor that is not convex")] {
        for body in ["Rigid", "Affine", "Elastic"] {
            let start = Vec3::new(1.0, 0.0, 0.0);
            let contact = "friction: None, restitution: 0.5";
            let velocity = cube_on(floor, body, (start, 10.0), contact, 0.1);
            let what = format!(
                "speed of a cube ({body}) that slides on its edge on {name}, e = 0.5, over that at the start"
            );
            row("damping at edges", &what, velocity.x, Within(1.0, 1e-3));
        }
    }
}

#[test]
fn friction_takes_nothing_from_a_cube_that_falls_on_its_edge_on_a_floor_that_is_not_convex() {
    for body in ["Rigid", "Elastic"] {
        let start = Vec3::new(0.0, 0.0, -1.0);
        let after = |friction: &str| {
            let contact = format!("friction: {friction}, restitution: 1");
            cube_on(&stepped_floor(), body, (start, 0.0), &contact, 0.1).z
        };
        let what = format!(
            "speed of a cube ({body}) after a fall on its edge on a floor that is not convex, φ = 30°, over that without friction"
        );
        row("damping at edges", &what, after("(friction_deg: 30)") / after("None"), Within(1.0, 1e-4));
    }
}

#[test]
fn an_oblique_impact_of_an_edge_changes_the_speed_along_the_floor_by_friction_alone() {
    for restitution in [0.1, 0.5, 0.9] {
        let start = Vec3::new(5.0, 0.0, -1.0);
        let contact = |friction: &str| format!("friction: {friction}, restitution: {restitution}");
        let smooth = cube_on_its_edge("Rigid", (start, 0.0), &contact("None"), 0.1);
        let what = format!(
            "speed along a smooth floor after an oblique impact of an edge, e = {restitution}, over that before"
        );
        row("damping at edges", &what, smooth.x / start.x, Within(1.0, 1e-9));
        let rough = cube_on_its_edge("Rigid", (start, 0.0), &contact("(friction_deg: 30)"), 0.1);
        let friction = f64::tan(30f64.to_radians());
        let what = format!(
            "speed that φ = 30° takes along the floor, e = {restitution}, over μ times the change of the normal one"
        );
        row(
            "damping at edges",
            &what,
            (start.x - rough.x) / (friction * (rough.z - start.z)),
            Within(1.0, 1e-3),
        );
    }
}

#[test]
fn an_edge_and_a_corner_rebound_with_the_coefficient_of_restitution() {
    let edge = "turns: [(axis: (0, 1, 0), angle_deg: 45)]";
    let corner =
        "turns: [(axis: (0, 0, 1), angle_deg: 45), (axis: (0, 1, 0), angle_deg: 54.735610317245346)]";
    // The law takes the energy of contact as if its force grew in proportion to the depth; on an edge it grows with the square, on a corner with the cube.
    for (name, turns, bound) in [("edge", edge, 0.015), ("corner", corner, 0.02)] {
        for (body, restitution) in
            [("Rigid", 0.3), ("Rigid", 0.6), ("Rigid", 0.9), ("Elastic", 0.3), ("Elastic", 0.6)]
        {
            let mut simulation = simulation(&format!(
                "(title: \"fall\", time: (step_s: 1e-5, end_s: 1), {MATERIAL},
                  blocks: [{FLOOR},
                    (name: \"cube\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1), pattern: TwentyFour), {turns},
                     at_m: (0, 0, 1), velocity_m_s: (0, 0, -1))],
                  contact: Potential(penalty_pa: 1e9, potential: Smooth(), friction: None, restitution: {restitution}))"
            ));
            crate::bouncing_block::step_until_it_leaves(&mut simulation);
            let what = format!("rebound of a cube ({body}) from its {name}, e = {restitution}, less e");
            row("damping at edges", &what, motion(&simulation).0.z - restitution, Near(0.0, bound));
        }
    }
}

/// Length and thickness of a plank, and its angle at the start.
const LENGTH_M: f64 = 2.0;
const THICK_M: f64 = 0.1;
const START_DEG: f64 = 60.0;
const GRAVITY: f64 = 10.0;

/// Velocity of the centre of a plank that slides down between a smooth wall and a smooth floor, by small steps of Lagrange's equation for its angle.
fn of_the_ladder(end_s: f64) -> Vec3 {
    let (half, thin) = (0.5 * LENGTH_M, 0.5 * THICK_M);
    let inertia = (LENGTH_M * LENGTH_M + THICK_M * THICK_M) / 12.0;
    let steps = 400_000;
    let dt = end_s / f64::from(steps);
    let (mut angle, mut rate) = (START_DEG.to_radians(), 0.0f64);
    let along = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        (-half * sin + thin * cos, half * cos - thin * sin)
    };
    for _ in 0..steps {
        let (sin, cos) = angle.sin_cos();
        let (x1, z1) = along(angle);
        let (x2, z2) = (-half * cos - thin * sin, -half * sin - thin * cos);
        rate -= dt * (GRAVITY * z1 + (x1 * x2 + z1 * z2) * rate * rate) / (inertia + x1 * x1 + z1 * z1);
        angle += dt * rate;
    }
    let (x1, z1) = along(angle);
    Vec3::new(x1 * rate, 0.0, z1 * rate)
}

#[test]
fn a_plank_slides_down_a_smooth_wall_as_its_equation_says() {
    let end_s = 0.4;
    let exact = of_the_ladder(end_s);
    let (sin, cos) = START_DEG.to_radians().sin_cos();
    for restitution in [0.5, 0.9] {
        let step_s: f64 = 8e-6;
        let mut simulation = simulation(&format!(
            "(title: \"plank\", time: (step_s: {step_s}, end_s: 1), gravity_m_s2: (0, 0, -{GRAVITY}), {MATERIAL},
              blocks: [{FLOOR},
                (name: \"wall\", material: \"rock\", body: Fixed, shape: Box(size_m: (1, 2, 10), cells: (1, 1, 1)), at_m: (-1, -0.5, 0)),
                (name: \"plank\", material: \"rock\", body: Rigid, shape: Box(size_m: ({LENGTH_M}, 1, {THICK_M}), cells: (4, 2, 1)),
                 turns: [(axis: (0, 1, 0), angle_deg: -{})], at_m: ({}, 0, {}))],
              contact: Potential(penalty_pa: 1e11, potential: Smooth(), friction: None, restitution: {restitution}))",
            180.0 - START_DEG,
            LENGTH_M * cos + THICK_M * sin,
            THICK_M * cos
        ));
        crate::advance(&mut simulation, (end_s / step_s).round() as u64);
        let what = format!(
            "velocity of a plank between a smooth wall and a smooth floor, e = {restitution}, off the equation, over it"
        );
        let (velocity, _) = motion(&simulation);
        // The penalty: with 1e10 Pa it is off by three times as much.
        row("damping at edges", &what, (velocity - exact).norm() / exact.norm(), Near(0.0, 0.01));
    }
}
