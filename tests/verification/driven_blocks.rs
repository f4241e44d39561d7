//! Blocks that a caller pushes and strikes between steps: Newton's second law, with impulse and work in the balances.

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{DriveError, Settle, Simulation};

use crate::evidence::Answer::{AtMost, Near, Within};
use crate::evidence::{rounding, row};
use crate::simulation;

const MOVING: [&str; 3] = ["Elastic", "Affine", "Rigid"];
const INTEGRATORS: [&str; 4] = [
    "Midpoint(theta: 0.5)",
    "Newmark(alpha: 0.5, delta: 1)",
    "Newmark(alpha: 0.25, delta: 0.5)",
    "GeneralizedAlpha(radius: 0.5)",
];
const MASS_KG: f64 = 0.3 * 0.2 * 0.1 * 2600.0;
const BRICK: BlockId = BlockId(0);

/// A brick of 15.6 kg in empty space.
fn brick(body: &str, integrator: &str) -> Simulation {
    simulation(&format!(
        "(title: \"driven\", time: (step_s: 1e-3, end_s: 1, integrator: {integrator}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
          blocks: [(name: \"brick\", material: \"rock\", shape: Box(size_m: (0.3, 0.2, 0.1), cells: (1, 1, 1)), body: {body},
             velocity_m_s: (1, 2, 3))])"
    ))
}

fn steps(simulation: &mut Simulation, count: usize) {
    for _ in 0..count {
        simulation.step().unwrap();
    }
}

#[test]
fn a_force_between_two_times_gives_its_impulse_and_its_work() {
    let force_n = Vec3::new(30.0, -10.0, 20.0);
    for integrator in INTEGRATORS {
        for body in MOVING {
            let mut simulation = brick(body, integrator);
            simulation.sample().unwrap();
            steps(&mut simulation, 100);
            simulation.set_force(BRICK, force_n).unwrap();
            steps(&mut simulation, 200);
            simulation.sample().unwrap();
            simulation.set_force(BRICK, Vec3::zeros()).unwrap();
            steps(&mut simulation, 100);
            let end = simulation.sample().unwrap();
            let expected = MASS_KG * Vec3::new(1.0, 2.0, 3.0) + 0.2 * force_n;
            let named = |what: &str| format!("{body} brick pushed for 0.2 s, {integrator}: {what}");
            let off = (end.momentum - expected).norm() / expected.norm();
            row("driven blocks", &named("momentum off m v + F t [-]"), off, AtMost(rounding(400)));
            // Exact in every step: rounding of 400 steps, twentyfold.
            let rounds = 20.0 * rounding(400);
            let kinetic_j = 0.5 * expected.norm_squared() / MASS_KG;
            row("driven blocks", &named("kinetic energy [J]"), end.kinetic_j, Within(kinetic_j, rounds));
            let worst = simulation.invariants();
            row("driven blocks", &named("error of momentum"), worst.linear_momentum, AtMost(rounding(400)));
            row("driven blocks", &named("error of angular momentum"), worst.angular_momentum, AtMost(rounds));
            let unbalanced = worst.energy_gain.max(worst.energy_loss);
            row("driven blocks", &named("error of energy"), unbalanced, AtMost(rounds));
        }
    }
}

#[test]
fn a_blow_sets_velocity_and_spin_and_is_booked() {
    let (velocity_m_s, spin_rad_s) = (Vec3::new(-2.0, 0.0, 1.0), Vec3::new(0.0, 0.0, 5.0));
    for integrator in INTEGRATORS {
        for body in MOVING {
            let mut simulation = brick(body, integrator);
            simulation.sample().unwrap();
            steps(&mut simulation, 100);
            simulation.set_velocity(BRICK, velocity_m_s, spin_rad_s).unwrap();
            steps(&mut simulation, 100);
            let end = simulation.sample().unwrap();
            let named = |what: &str| format!("{body} brick struck, {integrator}: {what}");
            let off = (end.momentum - MASS_KG * velocity_m_s).norm() / end.momentum.norm();
            row("driven blocks", &named("momentum off m v [-]"), off, AtMost(rounding(200)));
            let worst = simulation.invariants();
            row("driven blocks", &named("error of momentum"), worst.linear_momentum, AtMost(rounding(200)));
            // Rounding of 200 steps, twentyfold.
            let rounds = 20.0 * rounding(200);
            row("driven blocks", &named("error of angular momentum"), worst.angular_momentum, AtMost(rounds));
            let unbalanced = worst.energy_gain.max(worst.energy_loss);
            // The sudden spin stretches rock that deforms by ρ ω² r²/E, a part of its energy that vibrates: schemes that damp may take it, those
            // that keep energy to second order are off by (ω Δt)² of it.
            let stretch = 2600.0 * spin_rad_s.norm_squared() * (0.15 * 0.15 + 0.1 * 0.1 + 0.05 * 0.05) / 20e9;
            let lost = match integrator {
                _ if body == "Rigid" => rounding(200),
                "Midpoint(theta: 0.5)" | "Newmark(alpha: 0.25, delta: 0.5)" => {
                    stretch * spin_rad_s.norm_squared() * 1e-3 * 1e-3
                }
                _ => stretch,
            };
            row("driven blocks", &named("error of energy"), unbalanced, AtMost(lost));
        }
    }
}

#[test]
fn a_push_goes_on_from_a_snapshot_to_the_same_bits() {
    let mut whole = brick("Affine", INTEGRATORS[3]);
    whole.set_force(BRICK, Vec3::new(0.0, 50.0, 0.0)).unwrap();
    steps(&mut whole, 10);
    let snapshot = whole.snapshot();
    steps(&mut whole, 10);
    let mut resumed = brick("Affine", INTEGRATORS[3]);
    resumed.restore(snapshot).unwrap();
    steps(&mut resumed, 10);
    assert_eq!(whole.state(), resumed.state());
}

/// A slab of 1 × 1 × 0.2 m on a fixed floor, φ = 30°: it begins to slide at μ m g. A sudden push F at mid-height h/2 also tilts it on the
/// springs of contact, where it swings: friction has to carry up to F (1 + ¼ m h²/(I + ¼ m h²)) = 1.10 F, so that 0.8 μ m g holds. Its lower
/// face is looked at.
#[test]
fn a_push_beyond_friction_moves_a_slab_and_one_below_does_not() {
    let friction_m_s2 = 30f64.to_radians().tan() * 9.81;
    for (part, expected) in [(0.8, 0.0), (1.2, 0.2)] {
        let mut simulation = simulation(
            "(title: \"pushed\", time: (step_s: 1e-4, end_s: 1, integrator: Midpoint(theta: 0.5)), gravity_m_s2: (0, 0, -9.81),
              materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2500)],
              blocks: [
                (name: \"floor\", material: \"rock\", shape: Box(size_m: (5, 5, 1), cells: (1, 1, 1)), body: Fixed),
                (name: \"slab\", material: \"rock\", shape: Box(size_m: (1, 1, 0.2), cells: (1, 1, 1)), body: Rigid, at_m: (2, 2, 1)),
              ],
              settle: (tolerance: 1e-3),
              contact: Potential(penalty_pa: 1e8, friction: (friction_deg: 30)))",
        );
        simulation.settle(&Settle::new(1e-3, 100_000)).unwrap();
        let slab = BlockId(1);
        let lower_face_m = |simulation: &Simulation| {
            let nodes = simulation.blocks().nodes_of(slab);
            let places = nodes.map(|n| (simulation.start_position()[n].z, simulation.state().position[n].x));
            let places: Vec<_> = places.collect();
            let lowest_m = places.iter().map(|(z, _)| *z).fold(f64::INFINITY, f64::min);
            let lower: Vec<f64> =
                places.iter().filter(|(z, _)| *z < lowest_m + 0.1).map(|(_, x)| *x).collect();
            lower.iter().sum::<f64>() / lower.len() as f64
        };
        let before_m = lower_face_m(&simulation);
        simulation.set_force(slab, Vec3::new(part * friction_m_s2 * 500.0, 0.0, 0.0)).unwrap();
        steps(&mut simulation, 2000);
        let slide = (lower_face_m(&simulation) - before_m) / (0.5 * friction_m_s2 * 0.2 * 0.2);
        let what = format!("slab pushed by {part} of friction: slide over ½ g tan φ t²");
        // A slab that is held creeps by what friction is found to, 1e-7 of μN. One that slides has leaned by the moment of the push over the bed of
        // contact, 2 k_n a metre or more, twice as far when it swings.
        let leans_m = 2.0 * part * friction_m_s2 * 500.0 * 0.1 * 0.1 / (2.0 * 1e8 / 12.0);
        let off = if part < 1.0 { 1e-7 } else { leans_m / (0.5 * friction_m_s2 * 0.2 * 0.2) };
        row("driven blocks", &what, slide, Near(expected, off));
    }
}

#[test]
fn what_cannot_be_driven_is_refused_and_changes_nothing() {
    let mut simulation = simulation(
        "(title: \"held\", time: (step_s: 1e-3, end_s: 1), contact: Off,
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2600)],
          blocks: [(name: \"base\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), body: Fixed),
            (name: \"free\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 3))])",
    );
    let before = simulation.state().clone();
    let (zero, up) = (Vec3::zeros(), Vec3::new(0.0, 0.0, 1.0));
    let fixed = DriveError::Fixed { block: "base".into() };
    assert_eq!(simulation.set_force(BlockId(0), up), Err(fixed.clone()));
    assert_eq!(simulation.set_velocity(BlockId(0), up, zero), Err(fixed));
    let missing = DriveError::NoSuchBlock { number: 2, blocks: 2 };
    assert_eq!(simulation.set_force(BlockId(2), up), Err(missing));
    let what = DriveError::NotFinite { what: "the spin", block: "free".into() };
    assert_eq!(simulation.set_velocity(BlockId(1), up, up * f64::NAN), Err(what));
    assert_eq!(&before, simulation.state());
}
