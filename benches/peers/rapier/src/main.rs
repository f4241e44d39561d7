//! A problem of `benches/peers/problems.py` in Rapier: `peer-rapier PROBLEM.json SETTING.json` prints its state at the end.

use std::time::Instant;

use cpu_time::ProcessTime;
use rapier3d_f64::na::Unit;
use rapier3d_f64::prelude::*;
use serde_json::{Value, json};

fn main() {
    let mut arguments = std::env::args().skip(1).map(|path| read(&path));
    let (Some(problem), Some(setting)) = (arguments.next(), arguments.next()) else {
        panic!("usage: peer-rapier PROBLEM.json SETTING.json")
    };
    let (mut world, bodies) = build(&problem, &setting);
    let samples = problem["samples"].as_u64().expect("samples") as usize;
    let steps = (number(&problem["end_s"]) / number(&setting["step_s"])).round() as usize;
    let mut energies = vec![energy(&world, &bodies)];
    let (mut wall_s, mut cpu_s) = (0.0, 0.0);
    for sample in 0..samples {
        let (clock, processor) = (Instant::now(), ProcessTime::now());
        for _ in steps * sample / samples..steps * (sample + 1) / samples {
            world.step();
        }
        wall_s += clock.elapsed().as_secs_f64();
        cpu_s += processor.elapsed().as_secs_f64();
        energies.push(energy(&world, &bodies));
    }
    let corners: Vec<_> =
        bodies.iter().zip(list(&problem["bodies"])).map(|(&b, body)| corners(&world, b, body)).collect();
    let centres: Vec<_> = bodies.iter().map(|&b| components(world.bodies[b].center_of_mass())).collect();
    let velocities: Vec<_> = bodies.iter().map(|&b| components(world.bodies[b].linvel())).collect();
    println!(
        "{}",
        json!({"steps": steps, "step_cpu_s": cpu_s, "step_wall_s": wall_s, "corners_m": corners,
               "centres_m": centres,
               "velocities_m_s": velocities, "energies_j": energies})
    );
}

fn build(problem: &Value, setting: &Value) -> (PhysicsWorld, Vec<RigidBodyHandle>) {
    let mut world = PhysicsWorld::new();
    world.gravity = vector(&problem["gravity_m_s2"]);
    let parameters = &mut world.integration_parameters;
    parameters.dt = number(&setting["step_s"]);
    parameters.num_solver_iterations = number(&setting["iterations"]) as usize;
    if setting["coulomb"] == true {
        parameters.friction_model = FrictionModel::Coulomb;
    }
    if let Some(hertz) = setting["contact_hz"].as_f64() {
        parameters.contact_softness.natural_frequency = hertz;
        parameters.static_contact_softness.natural_frequency = hertz;
    }
    let has_friction = |collider: ColliderBuilder| {
        collider.friction(number(&problem["friction"])).restitution(number(&problem["restitution"]))
    };
    for support in list(&problem["supports"]) {
        let (shape, at) = support_shape(support);
        world.insert(RigidBodyBuilder::fixed().translation(at), has_friction(shape));
    }
    let density = number(&problem["density_kg_m3"]);
    let mut handles = Vec::new();
    for body in list(&problem["bodies"]) {
        let shape = match body["half_m"].as_array() {
            Some(half) => ColliderBuilder::cuboid(number(&half[0]), number(&half[1]), number(&half[2])),
            None => hull(&body["corners_m"]),
        };
        let moving = RigidBodyBuilder::dynamic()
            .translation(vector(&body["centre_m"]))
            .linvel(vector(&body["velocity_m_s"]))
            .can_sleep(false);
        handles.push(world.insert(moving, has_friction(shape).density(density)).0);
    }
    (world, handles)
}

/// A half-space where a program may take one, else the hull of the corners; and where it is put.
fn support_shape(support: &Value) -> (ColliderBuilder, Vector) {
    match support["plane"].as_object() {
        Some(plane) => (
            ColliderBuilder::halfspace(Unit::new_unchecked(vector(&plane["normal"]).normalize())),
            vector(&plane["point_m"]),
        ),
        None => (hull(&support["corners_m"]), Vector::ZERO),
    }
}

fn hull(corners: &Value) -> ColliderBuilder {
    let points: Vec<_> = list(corners).iter().map(vector).collect();
    ColliderBuilder::convex_hull(&points).expect("corners that span a body")
}

/// Kinetic energy and that of the weights [J].
fn energy(world: &PhysicsWorld, bodies: &[RigidBodyHandle]) -> f64 {
    let of =
        |body: &RigidBody| body.kinetic_energy() - body.mass() * world.gravity.dot(body.center_of_mass());
    bodies.iter().map(|&handle| of(&world.bodies[handle])).sum()
}

fn corners(world: &PhysicsWorld, handle: RigidBodyHandle, body: &Value) -> Vec<[f64; 3]> {
    let pose = world.bodies[handle].position();
    list(&body["corners_m"]).iter().map(|corner| components(*pose * vector(corner))).collect()
}

fn components(v: Vector) -> [f64; 3] {
    [v.x, v.y, v.z]
}

fn vector(value: &Value) -> Vector {
    Vector::new(number(&value[0]), number(&value[1]), number(&value[2]))
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

fn read(path: &str) -> Value {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{path}: {error}"))
}
