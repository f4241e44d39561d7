//! Free flight: a block that is thrown keeps its spin, and its mass centre goes along a parabola, whatever the integrator, the kind of body,
//! the place of contact and the speed of the observer.

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;

use crate::evidence::Answer::AtMost;
use crate::evidence::{rounding, row};
use crate::simulation;

const INTEGRATORS: [&str; 9] = [
    "Newmark(alpha: 0.5, delta: 1)",
    "Newmark(alpha: 0.25, delta: 0.5)",
    "Newmark(alpha: 0.36, delta: 0.7)",
    "Midpoint(theta: 0.5)",
    "Midpoint(theta: 0.8)",
    "GeneralizedAlpha(radius: 0)",
    "GeneralizedAlpha(radius: 0.5)",
    "GeneralizedAlpha(radius: 0.8)",
    "GeneralizedAlpha(radius: 1)",
];
const BODIES: [&str; 3] = ["Rigid", "Affine", "Elastic"];
const CONTACT_AT: [&str; 2] = ["", "contact_at: End(),"];
const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.81);
const SIDE_M: f64 = 0.1;

/// A cube in flight beside another one that it never meets, for contact to be on.
fn thrown(integrator: &str, body: &str, contact_at: &str, (velocity, spin): (Vec3, Vec3)) -> Simulation {
    let three = |v: Vec3| format!("({:?}, {:?}, {:?})", v.x, v.y, v.z);
    let motion = format!("velocity_m_s: {}, spin_rad_s: {}", three(velocity), three(spin));
    let shape = format!("shape: Box(size_m: ({SIDE_M}, {SIDE_M}, {SIDE_M}), cells: (1, 1, 1))");
    simulation(&format!(
        "(title: \"flight\", time: (step_s: 1e-3, end_s: 1, integrator: {integrator}, {contact_at}), gravity_m_s2: {},
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
          blocks: [
            (name: \"a\", material: \"rock\", {shape}, body: {body}, {motion}),
            (name: \"b\", material: \"rock\", {shape}, at_m: (0, 50, 0), body: {body}, {motion}),
          ],
          contact: Potential(penalty_pa: 1e8))",
        three(GRAVITY)
    ))
}

/// Angular momentum of the first block about its mass centre [kg m²/s], and the mass centre [m].
fn spin_of(simulation: &Simulation) -> (Vec3, Vec3) {
    let operator = &simulation.shape(BlockId(0)).operator;
    let nodes = simulation.blocks().nodes_of(BlockId(0));
    let (x, v) = (&simulation.state().position[nodes.clone()], &simulation.state().velocity[nodes]);
    let center = operator.center(x);
    (operator.angular_momentum(&center, x, v), center)
}

/// Angular momentum of both blocks about the origin [kg m²/s].
fn angular_momentum(simulation: &Simulation) -> Vec3 {
    let of_block = |block| {
        let (state, nodes) = (simulation.state(), simulation.blocks().nodes_of(block));
        let (x, v) = (&state.position[nodes.clone()], &state.velocity[nodes]);
        simulation.shape(block).operator.angular_momentum(&Vec3::zeros(), x, v)
    };
    simulation.blocks().ids().map(of_block).sum()
}

/// Angular momentum of a cube that spins at 1 rad/s [kg m²/s]: m a²/6.
fn per_spin() -> f64 {
    2600.0 * SIDE_M.powi(5) / 6.0
}

/// The worst of all kinds of bodies and places of contact: change of spin [rad/s], distance from the parabola [m], error of the angular
/// momentum of both blocks about the origin over Σ m |x| |v|, and I3.
fn worst(integrator: &str, motion: (Vec3, Vec3), steps: usize) -> [f64; 4] {
    let mut worst = [0.0f64; 4];
    for body in BODIES {
        for contact_at in CONTACT_AT {
            let mut simulation = thrown(integrator, body, contact_at, motion);
            simulation.sample().unwrap();
            let first = angular_momentum(&simulation);
            let (spin, start) = spin_of(&simulation);
            for _ in 0..steps {
                simulation.step().unwrap();
            }
            let last = simulation.sample().unwrap();
            let (end_spin, end) = spin_of(&simulation);
            let t = simulation.time_s();
            let parabola = start + t * motion.0 + 0.5 * t * t * GRAVITY;
            // ∫ c × m g dt along the parabolas of both, the other one being 50 m further along y.
            let mass = 2600.0 * SIDE_M.powi(3);
            let centers = 2.0 * start + Vec3::new(0.0, 50.0, 0.0);
            let moment = mass * (t * centers + t * t * motion.0).cross(&GRAVITY);
            let off = (angular_momentum(&simulation) - first - moment).norm() / last.angular_scale;
            let i3 = simulation.invariants().angular_momentum;
            let found = [(end_spin - spin).norm() / per_spin(), (end - parabola).norm(), off, i3];
            worst.iter_mut().zip(found).for_each(|(worst, found)| *worst = worst.max(found));
        }
    }
    worst
}

#[test]
fn a_block_in_free_flight_keeps_its_spin_and_goes_along_a_parabola() {
    // The bounds are for rounding of places of up to 60 m in 500 steps, twentyfold, and of stresses of 20 GPa; those
    // of angular momentum are parts of Σ m |x| |v|. A scheme that gives the orbital misfit of gravity to the spin makes 15 to 30 rad/s of the first throw.
    let throws = [
        (Vec3::new(10.0, 0.0, 0.0), Vec3::zeros()),
        (Vec3::new(3.0, -20.0, 7.0), Vec3::new(1.0, -2.0, 0.5)),
        (Vec3::new(100.0, 30.0, -50.0), Vec3::new(0.0, 3.0, 0.0)),
    ];
    for integrator in INTEGRATORS {
        let mut largest = [0.0f64; 4];
        for motion in throws {
            let found = worst(integrator, motion, 500);
            largest.iter_mut().zip(found).for_each(|(largest, found)| *largest = largest.max(found));
        }
        let rounds_m = 20.0 * rounding(500) * 60.0;
        let named = |of: &str| format!("{integrator}, flight at 10 to 116 m/s: {of}");
        row("flight", &named("change of spin [rad/s]"), largest[0], AtMost(1e-8));
        row("flight", &named("distance from the parabola [m]"), largest[1], AtMost(rounds_m));
        row("flight", &named("angular momentum against the moment of the weight"), largest[2], AtMost(1e-12));
        row("flight", &named("angular momentum error"), largest[3], AtMost(1e-12));
    }
}

/// Two cubes that collide off centre under gravity, seen by an observer who moves at −`boost`; places relative to the observer at the end.
fn collision(integrator: &str, body: &str, contact_at: &str, boost: Vec3) -> (Vec<Vec3>, f64, f64) {
    let three = |v: Vec3| format!("({:?}, {:?}, {:?})", v.x, v.y, v.z);
    let mut simulation = simulation(&format!(
        "(title: \"boost\", time: (step_s: 1e-4, end_s: 1, integrator: {integrator}, {contact_at}), gravity_m_s2: (0, 0, -9.81),
          materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2500)],
          blocks: [
            (name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), body: {body}, velocity_m_s: {}),
            (name: \"b\", material: \"rock\", shape: Box(size_m: (1, 0.5, 1), cells: (1, 1, 1)), body: {body}, at_m: (1.001, 0.6, 0.7),
             velocity_m_s: {}),
          ],
          contact: Potential(penalty_pa: 1e7, friction: (friction_deg: 30, shear_penalty_pa_m: 1e7)))",
        three(boost + Vec3::new(2.0, 0.0, 0.3)),
        three(boost)
    ));
    simulation.sample().unwrap();
    let mut pairs = 0;
    for _ in 0..600 {
        pairs += simulation.step().unwrap().contact.contact_pairs;
    }
    simulation.sample().unwrap();
    assert!(pairs > 100, "they do not meet");
    let t = simulation.time_s();
    let places = simulation.state().position.iter().map(|x| x - t * boost).collect();
    let worst = simulation.invariants();
    (places, worst.linear_momentum, worst.angular_momentum)
}

#[test]
fn a_collision_is_the_same_for_an_observer_who_moves() {
    // An observer at 100 m/s sees places of 6 m and velocities rounded fifty times more in 600 steps; contact is stiff and amplifies that, tenfold.
    let boost = Vec3::new(60.0, -80.0, 20.0);
    for integrator in INTEGRATORS {
        let mut largest = [0.0f64; 3];
        for body in BODIES {
            for contact_at in CONTACT_AT {
                let (still, ..) = collision(integrator, body, contact_at, Vec3::zeros());
                let (moving, linear, angular) = collision(integrator, body, contact_at, boost);
                let apart = still.iter().zip(&moving).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
                // The residual of Newton's method for implicit contact differs between observers.
                let apart = if contact_at.is_empty() { apart } else { 0.0 };
                let found = [apart, linear, angular];
                largest.iter_mut().zip(found).for_each(|(worst, found)| *worst = worst.max(found));
            }
        }
        let named = |of: &str| format!("{integrator}, collision seen at 102 m/s: {of}");
        row("flight", &named("places differ by [m]"), largest[0], AtMost(10.0 * rounding(600) * 6.0));
        row("flight", &named("momentum"), largest[1], AtMost(1e-12));
        row("flight", &named("angular momentum"), largest[2], AtMost(1e-12));
    }
}
