//! A block that bounces on a held one, by integrator and step. Speeds before and after tell how contact treats
//! energy; the theory is that of a mass on a spring, ω_c Δt = h.

use ndda_mesh::Vec3;
use ndda_solver::{Simulation, StepError};

use crate::evidence::Answer::{AtMost, Near};
use crate::evidence::{rounding, row};
use crate::simulation;

const SPEED_M_S: f64 = 0.5;

/// An elastic block, tall, so that it hits a held one flat and is gone before anything else happens.
pub fn ball(integrator: &str, step_s: f64) -> Simulation {
    simulation(&format!(
        "(title: \"bounce\", time: (step_s: {step_s}, end_s: {}, integrator: {integrator}),
          materials: [(name: \"rock\", young_pa: 1e12, poisson: 0, density_kg_m3: 2500)],
          blocks: [
            (name: \"base\", material: \"rock\", shape: Box(size_m: (1, 1, 0.25), cells: (2, 2, 1))),
            (name: \"ball\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)), at_m: (0, 0, 0.251),
             velocity_m_s: (0, 0, -{SPEED_M_S})),
          ],
          supports: [(block: \"base\", on: All, hold: Fixed)],
          contact: Potential(penalty_pa: 4e6, potential: Smooth(reference_m: 1)))",
        1e3 * step_s
    ))
}

/// Speed of the ball over that before it hit.
pub fn restitution(simulation: &mut Simulation) -> Result<f64, StepError> {
    Ok(simulation.sample()?.momentum.z / (2500.0 * SPEED_M_S))
}

/// Steps until blocks have touched, and touch no more.
pub fn step_until_it_leaves(simulation: &mut Simulation) {
    let mut touched = false;
    loop {
        let report = simulation.step().unwrap();
        touched |= report.contact.contact_pairs > 0;
        if touched && report.contact.contact_pairs == 0 {
            return;
        }
    }
}

/// Speed after over speed before, and largest gain of the energy balance over the energy.
fn bounce(integrator: &str, step_s: f64) -> (f64, f64) {
    let mut simulation = ball(integrator, step_s);
    simulation.sample().unwrap();
    step_until_it_leaves(&mut simulation);
    (restitution(&mut simulation).unwrap(), simulation.invariants().energy_gain)
}

/// ω_c of the block as one mass on the patch: two smooth fields of slope 1 over the reference length, 4 k A in all.
pub fn contact_rate() -> f64 {
    (2.0 * 4e6 / 2500.0f64).sqrt()
}

/// Speed after over before of one mass on a one-sided spring, −ω² d, by the steps of a scheme in one dimension.
fn one_mass(scheme: &str, step_s: f64) -> f64 {
    let (dt, rate) = (step_s, contact_rate());
    // Height above the held block, as in the scene.
    let (mut x, mut v, mut a, mut touched) = (1e-3, -SPEED_M_S, 0.0, false);
    let push = |x: f64| rate * rate * (-x).max(0.0);
    loop {
        let force;
        match scheme {
            "Newmark(alpha: 0.5, delta: 1), contact_at: Predicted" => {
                force = push(x);
                x += dt * v + 0.5 * dt * dt * force;
                v += dt * force;
            }
            "Midpoint(theta: 0.5), contact_at: Predicted" => {
                force = push(x + 0.5 * dt * v);
                x += dt * (v + 0.5 * dt * force);
                v += dt * force;
            }
            "Midpoint(theta: 0.5), contact_at: End()" => {
                // F = −ω² x₁ with x₁ = x + Δt v + ½ Δt² F.
                force = push(x + dt * v) / (1.0 + 0.5 * rate * rate * dt * dt);
                x += dt * (v + 0.5 * dt * force);
                v += dt * force;
            }
            // Chung & Hulbert 1993, eqs 4–9, 17 and 24, with ρ∞ = 0.8; contact acts where docs/theory/method.md says.
            "GeneralizedAlpha(radius: 0.8), contact_at: Predicted" => {
                let (on_mass, on_force) = (0.6 / 1.8, 0.8 / 1.8);
                let (gamma, beta) = (0.5 - on_mass + on_force, 0.25 * (1.0f64 - on_mass + on_force).powi(2));
                let lead = on_mass * (0.5 - on_mass) / 3.0;
                force = push(x + (1.0 - on_force) * dt * v + lead * dt * dt * a);
                let new = (force - on_mass * a) / (1.0 - on_mass);
                x += dt * v + dt * dt * ((0.5 - beta) * a + beta * new);
                v += dt * ((1.0 - gamma) * a + gamma * new);
                a = new;
            }
            other => unreachable!("{other}"),
        }
        touched |= force > 0.0;
        if touched && force == 0.0 {
            return v / SPEED_M_S;
        }
    }
}

#[test]
fn midpoint_and_generalised_alpha_give_back_what_they_get() {
    for integrator in ["Midpoint(theta: 0.5)", "GeneralizedAlpha(radius: 0.8)", "GeneralizedAlpha(radius: 0)"]
    {
        for step_s in [2e-3, 1e-3, 5e-4] {
            let (restitution, gain) = bounce(integrator, step_s);
            let what = |what: &str| format!("{what}, {integrator}, Δt = {step_s:e} s");
            // Contact keeps v² (1 − h²/4) + ω² x², which jumps by up to h²/4 where it begins and ends within a step: h²/2 of the energy and
            // h²/4 of the speed, of which twice passes. A radius of 0 damps about h²/2 of the speed: thrice that.
            let h = contact_rate() * step_s;
            let own = if integrator.ends_with("(radius: 0)") { 1.5 } else { 0.5 };
            row("bounce and contact stability", &what("restitution"), restitution, Near(1.0, own * h * h));
            row("bounce and contact stability", &what("energy gained"), gain, AtMost(0.5 * h * h));
        }
    }
}

#[test]
fn restitution_over_the_step_is_that_of_one_mass_on_a_spring_for_every_scheme() {
    // The lines are what docs/pictures/restitution.py draws.
    let schemes = [
        ("Newmark(alpha: 0.5, delta: 1)", "Predicted"),
        ("Midpoint(theta: 0.5)", "Predicted"),
        ("GeneralizedAlpha(radius: 0.8)", "Predicted"),
        ("Midpoint(theta: 0.5)", "End()"),
    ];
    for (integrator, contact_at) in schemes {
        for h in [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0] {
            let step_s = h / contact_rate();
            let (restitution, _) = bounce(&format!("{integrator}, contact_at: {contact_at}"), step_s);
            println!("restitution;{integrator};{contact_at};{h};{restitution}");
            let expected = one_mass(&format!("{integrator}, contact_at: {contact_at}"), step_s);
            let what = format!("restitution, {integrator}, contact_at {contact_at}, h = {h}");
            // The sides of both blocks are nearer than the depth of 9 mm along a rim of their face of 1 m: contact is softer by 2 %.
            row("bounce and contact stability", &what, restitution, Near(expected, 0.025 * h));
        }
    }
}

/// Two cubes that meet in space: the paper's §4.1 without its plate.
const COLLISION: &str = "materials: [(name: \"rock\", young_pa: 1e8, poisson: 0.2, density_kg_m3: 2650)],
    blocks: [
      (name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), velocity_m_s: (1, 0, 0)),
      (name: \"b\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0.995, 0, 0)),
    ],
    contact: Potential(penalty_pa: 4e6)";

/// A block on its way down in a held one.
const PRESSED: &str = "materials: [(name: \"rock\", young_pa: 1e8, poisson: 0.2, density_kg_m3: 2500)],
    blocks: [
      (name: \"base\", material: \"rock\", shape: Box(size_m: (1, 1, 0.25), cells: (1, 1, 1)), body: Fixed),
      (name: \"ball\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 0.24),
       velocity_m_s: (0, 0, -0.5)),
    ],
    contact: Potential(penalty_pa: 4e6)";

/// Largest distance of the centre's height from that of a run with a step sixteen times shorter, in mid-contact.
fn error(scene: &str, integrator: &str, step_s: f64) -> f64 {
    let end_s = 0.02;
    let height = |step_s: f64| {
        let mut simulation = simulation(&format!(
            "(title: \"pressed\", time: (step_s: {step_s}, end_s: 1, integrator: {integrator}),
              {scene})"
        ));
        for _ in 0..(end_s / step_s).round() as usize {
            simulation.step().unwrap();
        }
        simulation.state().position.clone()
    };
    let (rough, fine) = (height(step_s), height(step_s / 16.0));
    rough.iter().zip(&fine).map(|(a, b): (&Vec3, &Vec3)| (a - b).norm()).fold(0.0, f64::max)
}

#[test]
fn midpoint_and_generalised_alpha_are_of_second_order_in_contact_and_the_papers_scheme_of_first() {
    let cases = [
        ("Midpoint(theta: 0.5)", 2.0),
        ("GeneralizedAlpha(radius: 0.8)", 2.0),
        ("GeneralizedAlpha(radius: 0.3)", 2.0),
        ("Newmark(alpha: 0.5, delta: 1)", 1.0),
    ];
    for (scene, (integrator, expected)) in
        [PRESSED, COLLISION].into_iter().flat_map(|s| cases.map(|c| (s, c)))
    {
        let errors = [1e-4, 5e-5, 2.5e-5].map(|step_s| error(scene, integrator, step_s));
        let order = (errors[1] / errors[2]).log2();
        // Terms of higher order in Δt change what two steps show of the order; by how much has no closed form. The paper's comes to it from below.
        let tolerance = if expected == 1.0 { 0.12 } else { 0.1 };
        let of = if scene == PRESSED { "a block pressed on a base" } else { "two cubes that meet" };
        row(
            "bounce and contact stability",
            &format!("order of {of}, {integrator}"),
            order,
            Near(expected, tolerance),
        );
    }
}

#[test]
fn momentum_on_supports_is_accounted_for_from_the_first_step() {
    for integrator in ["Midpoint()", "GeneralizedAlpha(radius: 0.8)", "Newmark(alpha: 0.25, delta: 0.5)"] {
        let mut simulation = simulation(&format!(
            "(title: \"held\", time: (step_s: 1e-4, end_s: 1, integrator: {integrator}), gravity_m_s2: (1, 0, -9.8),
              materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.2, density_kg_m3: 2500)],
              blocks: [
                (name: \"base\", material: \"rock\", shape: Box(size_m: (1, 1, 0.25), cells: (2, 2, 1))),
                (name: \"top\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 0.2499)),
              ],
              supports: [(block: \"base\", on: Plane(point_m: (0, 0, 0), normal: (0, 0, 1)), hold: Fixed)],
              contact: Potential(penalty_pa: 1e8, potential: Smooth(reference_m: 1)))"
        ));
        simulation.sample().unwrap();
        for _ in 0..50 {
            simulation.step().unwrap();
        }
        simulation.sample().unwrap();
        let error = simulation.invariants().linear_momentum;
        // What supports take is booked exactly: rounding of 50 steps.
        row(
            "bounce and contact stability",
            &format!("momentum on supports, {integrator}"),
            error,
            AtMost(rounding(50)),
        );
    }
}
