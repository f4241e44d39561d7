//! A plate on a ramp with μ = tan α exactly, none, and a thousand.

use ndda::Model;
use ndda_mesh::Vec3;
use ndda_solver::Settle;

use super::{advance, extreme};
use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;

/// Mean position of the plate's centre over a second.
fn second(ready: &mut Model) -> Vec3 {
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
        ready.simulation.settle(&Settle::new(1e-5, 1_000_000)).unwrap();
        let early = second(&mut ready);
        advance(&mut ready.simulation, 8000);
        let rate = (second(&mut ready) - early).norm() / 9.0;
        row(
            "extreme: friction at its limit",
            &format!("creep at μ = {name}, lengths a second"),
            rate,
            // The promise of the header of scenes/extreme/ramp_at_its_limit.ron: what friction is found to, 1e-7 of μN, is more at μ = 1000.
            AtMost(1e-6),
        );
    }
}

#[test]
fn a_plate_without_friction_slides_as_it_falls() {
    let mut ready = extreme("ramp_at_its_limit", &["contact.friction.friction_deg=0", "settle=None"]);
    advance(&mut ready.simulation, 500);
    let slide = ready.monitors[0].displacement(&ready.simulation).norm();
    row(
        "extreme: friction at its limit",
        "slide at μ = 0 within 0.5 s [m]",
        slide,
        // The promise of the same header.
        Within(0.5 * 9.8 * 0.5 * 0.25, 1e-4),
    );
}

/// The plate as three equations of motion: along the ramp, off it, and its rocking, on a bed of springs that only push, with Coulomb's friction on
/// its lower face as a whole. Place and velocity of each.
struct Planar {
    along: [f64; 2],
    off: [f64; 2],
    rocking: [f64; 2],
}

const RAMP_RAD: f64 = std::f64::consts::FRAC_PI_6;
/// Thickness of the plate [m], its mass [kg], and 2k_n/L₀ of its face of 1 m² [N/m].
const THICK_M: f64 = 0.05;
const MASS_KG: f64 = 2650.0 * THICK_M;
const BED_N_M: f64 = 4e7;
const GRAVITY_M_S2: f64 = 9.8;

impl Planar {
    /// Force and moment of the bed; the plate is a metre long.
    fn bed(&self, depth_m: f64) -> (f64, f64) {
        let (middle, edge) = (depth_m - self.off[0], 0.5 * self.rocking[0].abs());
        if edge <= middle {
            return (BED_N_M * middle, BED_N_M * self.rocking[0] / 12.0);
        }
        let pressed = ((middle + edge) / (2.0 * edge)).max(0.0);
        let force = 0.5 * BED_N_M * (middle + edge).max(0.0) * pressed;
        (force, force * (0.5 - pressed / 3.0) * self.rocking[0].signum())
    }

    fn step(&mut self, dt_s: f64, depth_m: f64) {
        let inertia = MASS_KG * (1.0 + THICK_M * THICK_M) / 12.0;
        let (arm, pull) = (0.5 * THICK_M, GRAVITY_M_S2 * RAMP_RAD.sin());
        let (normal, moment) = self.bed(depth_m);
        let slip = self.along[1] - arm * self.rocking[1];
        let holding = (slip / dt_s + pull + arm * moment / inertia) / (1.0 / MASS_KG + arm * arm / inertia);
        let most = RAMP_RAD.tan() * normal;
        let friction = holding.clamp(-most, most);
        let rates = [
            pull - friction / MASS_KG,
            normal / MASS_KG - GRAVITY_M_S2 * RAMP_RAD.cos(),
            (arm * friction - moment) / inertia,
        ];
        for (motion, rate) in [&mut self.along, &mut self.off, &mut self.rocking].into_iter().zip(rates) {
            motion[1] += dt_s * rate;
            motion[0] += dt_s * motion[1];
        }
    }
}

#[test]
fn a_plate_at_its_limit_that_bounces_slides_as_three_equations_say() {
    let deep = MASS_KG * GRAVITY_M_S2 * RAMP_RAD.cos() / BED_N_M;
    let place = [0.259793564460496 + 0.25 * deep, -0.5, 1.849975653125 + 0.5 * deep * RAMP_RAD.cos()];
    let place = format!("blocks.plate.at_m=({:e}, {:e}, {:e})", place[0], place[1], place[2]);
    let rigid =
        ["blocks.plate.body=Rigid", "blocks.ramp.body=Fixed", "supports=[]", "time.step_s=1e-4", &place];
    let overrides = [&rigid[..], &["time.integrator=Midpoint()"]].concat();
    let mut ready = extreme("sudden_load_at_the_limit", &overrides);
    let along = Vec3::new(RAMP_RAD.cos(), 0.0, -RAMP_RAD.sin());
    let mut planar = Planar { along: [0.0; 2], off: [0.5 * deep, 0.0], rocking: [0.0; 2] };
    for (until_s, tolerance) in [(0.1, 1e-2), (0.5, 2e-2)] {
        while ready.simulation.time_s() < until_s - 1e-9 {
            ready.simulation.step().unwrap();
            (0..20).for_each(|_| planar.step(5e-6, deep));
        }
        let slide = ready.monitors[0].displacement(&ready.simulation).dot(&along);
        let what = format!("slide of a bouncing plate at its limit of friction within {until_s} s [m]");
        row("extreme: friction at its limit", &what, slide, Within(planar.along[0], tolerance));
    }
}
