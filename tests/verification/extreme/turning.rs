//! How far a block turns in a step (`fast_spin.ron`): against ω t about a principal axis, and against Euler's equations.

use ndda::judge::verdict;
use ndda::summary::LabelWord;
use ndda_mesh::{Mat3, Vec3};
use ndda_solver::Simulation;

use super::labelled::{SPEED, summary_of, word};
use crate::evidence::Answer::AtMost;
use crate::evidence::{rounding, row};
use crate::simulation;

/// Spin of the blocks [rad/s].
const SPIN: f64 = 50.0;

/// A block of 0.4 × 0.3 × 0.2 m that turns freely, `turned` radians by its first spin, in steps of `angle` each.
fn turn(body: &str, integrator: &str, axis: &Vec3, angle: f64, turned: f64) -> Option<Simulation> {
    let spin = SPIN * axis;
    let mut simulation = simulation(&format!(
        "(title: \"turn\", time: (step_s: {:e}, end_s: 1, integrator: {integrator}),
          materials: [(name: \"rock\", young_pa: 200e9, poisson: 0.25, density_kg_m3: 2600)],
          blocks: [(name: \"brick\", material: \"rock\", body: {body}, shape: Box(size_m: (0.4, 0.3, 0.2), cells: (1, 1, 1)),
            spin_rad_s: ({:e}, {:e}, {:e}))])",
        angle / SPIN,
        spin.x,
        spin.y,
        spin.z
    ));
    simulation.sample().unwrap();
    let steps = (turned / angle).round() as u64;
    for step in 0..steps {
        simulation.step().ok()?;
        if step % 10 == 0 {
            simulation.sample().ok()?;
        }
    }
    simulation.sample().ok()?;
    Some(simulation)
}

/// Steps of Runge and Kutta.
const EULER_STEPS: u32 = 20_000;

/// Orientation and spin of the brick at a time, by Runge and Kutta's steps of Euler's equations.
fn euler(axis: &Vec3, time_s: f64) -> (Mat3, Vec3) {
    let inertia = Vec3::new(0.3 * 0.3 + 0.2 * 0.2, 0.4 * 0.4 + 0.2 * 0.2, 0.4 * 0.4 + 0.3 * 0.3);
    let (mut rotation, mut spin) = (Mat3::identity(), SPIN * axis);
    let rates = |rotation: &Mat3, spin: &Vec3| {
        let change = inertia.component_mul(spin).cross(spin).component_div(&inertia);
        (rotation * spin.cross_matrix(), change)
    };
    let h = time_s / f64::from(EULER_STEPS);
    for _ in 0..EULER_STEPS {
        let (r1, s1) = rates(&rotation, &spin);
        let (r2, s2) = rates(&(rotation + 0.5 * h * r1), &(spin + 0.5 * h * s1));
        let (r3, s3) = rates(&(rotation + 0.5 * h * r2), &(spin + 0.5 * h * s2));
        let (r4, s4) = rates(&(rotation + h * r3), &(spin + h * s3));
        rotation += h / 6.0 * (r1 + 2.0 * r2 + 2.0 * r3 + r4);
        spin += h / 6.0 * (s1 + 2.0 * s2 + 2.0 * s3 + s4);
    }
    (rotation, rotation * spin)
}

/// Error of the velocities, over the largest speed, and whether the run calls itself accurate.
fn judged(simulation: &Simulation, axis: &Vec3) -> (f64, bool) {
    let (rotation, spin) = euler(axis, simulation.time_s());
    let rest = &simulation.blocks().rest_position;
    let center = rest.iter().sum::<Vec3>() / rest.len() as f64;
    let exact = rest.iter().map(|x| spin.cross(&(rotation * (x - center))));
    let pairs = exact.zip(&simulation.state().velocity);
    let (off, largest) = pairs.fold((0.0f64, 0.0f64), |(off, largest), (exact, v)| {
        (off.max((exact - v).norm()), largest.max(exact.norm()))
    });
    (off / largest, verdict::label(simulation, None).word == LabelWord::Accurate)
}

#[test]
fn a_rigid_block_turns_about_its_axis_by_its_spin_however_long_a_step_is() {
    for angle in [0.01, 0.5, 2.5] {
        let simulation = turn("Rigid", "Midpoint(theta: 0.5)", &Vec3::z(), angle, 50.0).unwrap();
        let (error, says) = judged(&simulation, &Vec3::z());
        // The answer's own error, (ω h)⁴/120 in a radian by the steps of Runge and Kutta, tenfold.
        let answer = 10.0 * 50.0 * (50.0 / f64::from(EULER_STEPS)).powi(4) / 120.0;
        row(
            "extreme: fast spin",
            &format!("velocities after 50 rad in steps of {angle} rad, rigid"),
            error,
            AtMost(answer),
        );
        assert!(says, "{}", verdict::label(&simulation, None).reasons.join(", "));
    }
    let summary = summary_of("extreme/fast_spin.ron", &[]);
    let summary = summary.unwrap();
    // A corner half a metre off the axis, both ways, after 50 rad.
    let (sin, cos) = 50f64.sin_cos();
    let exact = [0.5 * (cos - sin) - 0.5, 0.5 * (sin + cos) - 0.5];
    let place = |i: usize| summary["monitors"]["corner"]["displacement"][i].as_f64().unwrap();
    let off = (place(0) - exact[0]).hypot(place(1) - exact[1]);
    // A rigid block turns about its axis exactly: rounding of 100 steps, twentyfold, half a metre off the axis.
    let rounds_m = 20.0 * rounding(100);
    row("extreme: fast spin", "a corner after 50 rad in steps of half a radian [m]", off, AtMost(rounds_m));
    assert_eq!(word(&summary), "accurate");
}

#[test]
fn a_block_that_turns_too_far_in_a_step_says_so() {
    let tumbling = Vec3::new(0.3, 1.0, 0.2).normalize();
    let elastic =
        ["Midpoint(theta: 0.5)", "GeneralizedAlpha(radius: 0.5)", "Newmark(alpha: 0.25, delta: 0.5)"];
    let mut kinds = vec![("Rigid", elastic[0], tumbling), ("Affine", elastic[0], Vec3::z())];
    kinds.extend(elastic.map(|integrator| ("Elastic", integrator, Vec3::z())));
    let (mut claimed_wrongly, mut too_modest, mut words) = (0, 0, [0, 0]);
    for (body, integrator, axis) in kinds {
        for angle in [0.003, 0.01, 0.02, 0.05, 0.1, 0.2, 0.4] {
            let Some(simulation) = turn(body, integrator, &axis, angle, 20.0) else { continue };
            let (error, says) = judged(&simulation, &axis);
            println!("{body}, {integrator}, {angle} rad a step: error {error:.1e}, accurate {says}");
            claimed_wrongly += u32::from(says && error > SPEED);
            too_modest += u32::from(!says && error < 0.1 * SPEED);
            words[usize::from(says)] += 1;
        }
    }
    assert!(words.iter().all(|n| *n > 5), "both labels should be met: {words:?}");
    // The statement: none is.
    row("extreme: fast spin", "turns called accurate that are not", f64::from(claimed_wrongly), AtMost(0.0));
    row(
        "extreme: fast spin",
        "turns called inaccurate that are not by a tenth of that",
        f64::from(too_modest),
        AtMost(0.0),
    );
}
