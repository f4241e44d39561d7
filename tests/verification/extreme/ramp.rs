//! X17: a plate on a ramp with μ = tan α exactly, none, and a thousand.

use ndda_cli::check::Ready;
use ndda_mesh::Vec3;
use ndda_solver::Settle;

use super::{advance, extreme};
use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;

/// Where the plate's centre is, mean of a second.
fn second(ready: &mut Ready) -> Vec3 {
    let mut sum = Vec3::zeros();
    for _ in 0..1000 {
        ready.simulation.step().unwrap();
        sum += ready.monitors[0].displacement(&ready.simulation);
    }
    sum / 1000.0
}

#[test]
fn a_plate_at_the_limit_of_friction_and_far_beyond_it_does_not_creep() {
    for (name, friction_deg) in [("tan α", "30"), ("1000", "89.94270423958")] {
        let mut ready =
            extreme("ramp_at_its_limit", &[&format!("contact.friction.friction_deg={friction_deg}")]);
        ready.simulation.settle(&Settle { tolerance: 1e-5, most_steps: 1_000_000 }).unwrap();
        let early = second(&mut ready);
        advance(&mut ready.simulation, 8000);
        let rate = (second(&mut ready) - early).norm() / 9.0;
        row("X17", &format!("creep at μ = {name}, lengths a second"), rate, AtMost(1e-6));
    }
}

#[test]
fn a_plate_without_friction_slides_as_it_falls() {
    let mut ready = extreme("ramp_at_its_limit", &["contact.friction.friction_deg=0", "settle=None"]);
    advance(&mut ready.simulation, 500);
    let slide = ready.monitors[0].displacement(&ready.simulation).norm();
    row("X17", "slide at μ = 0 within 0.5 s [m]", slide, Within(0.5 * 9.8 * 0.5 * 0.25, 1e-4));
}
