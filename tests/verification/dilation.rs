//! Joints that open while they slip, in scenes: shear boxes against closed forms, and the balances of energy and momentum.

use std::f64::consts::PI;
use std::fmt::Write;

use ndda::joint::Hold;
use ndda_contact::FacetContact;
use ndda_mesh::{BlockId, Vec3};
use ndda_solver::{Sample, Settle, Simulation};

use crate::evidence::Answer::{AtMost, Near, Within};
use crate::evidence::{rounding, row};
use crate::{displacements, joint_laws, simulation};

const STRESS_PA: f64 = 1e6;
const STIFFNESS_PA_M: f64 = 1e10;
const FRICTION_DEG: f64 = 30.0;
const PSI_DEG: f64 = 10.0;
const END_S: f64 = 0.5;
const STEP_S: f64 = 1e-4;

fn tan(deg: f64) -> f64 {
    deg.to_radians().tan()
}

/// Slip of a joint by this much beyond the stretch of its spring [m].
fn total_m(plastic_m: f64) -> f64 {
    plastic_m + STRESS_PA * tan(FRICTION_DEG) / STIFFNESS_PA_M
}

/// A joint that dilates until a slip.
fn shear_box(upper: &str, sunk_m: f64, to_slip_m: f64, rows: &str, holds: (&str, &str)) -> Simulation {
    let law = format!("dilation: (psi_deg: {PSI_DEG}, to_slip_m: {to_slip_m})");
    shear_box_of(&law, (upper, sunk_m), rows, holds)
}

/// A block of a square metre on a larger one that is moved below it, and the law of the joint between them. `upper` is the block, `sunk_m` its overlap at the start,
/// `rows` the motion, `held` and `loads` what holds and presses it.
fn shear_box_of(
    law: &str,
    (upper, sunk_m): (&str, f64),
    rows: &str,
    (held, loads): (&str, &str),
) -> Simulation {
    simulation(&format!(
        "(title: \"shear box\", time: (step_s: {STEP_S:e}, end_s: {END_S}),
          materials: [(name: \"rock\", young_pa: 1e12, poisson: 0, density_kg_m3: 2600), (name: \"soft\", young_pa: 5e8, poisson: 0, density_kg_m3: 2600)],
          blocks: [
              (name: \"lower\", material: \"rock\", body: Fixed, shape: Box(size_m: (3, 3, 1), cells: (1, 1, 1)), at_m: (-1, -1, -1)),
              (name: \"upper\", {upper}, at_m: (0, 0, {:e})),
          ],
          supports: [(block: \"lower\", on: All, hold: Motion([(time_s: 0, displacement_m: (0, 0, 0)), {rows}])), {held}],
          {loads}
          contact: Potential(penalty_pa: 5e9, potential: Smooth(), friction: (friction_deg: {FRICTION_DEG}, shear_penalty_pa_m: {STIFFNESS_PA_M:e}, {law})))",
        -sunk_m
    ))
}

/// The block of a square metre as a body of this kind.
fn upper(body: &str, cells: &str) -> String {
    format!("material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 0.5), cells: ({cells}))")
}

/// Overlap at which the joint bears 1 MPa [m].
const SUNK_M: f64 = STRESS_PA / STIFFNESS_PA_M;
/// Free to rise, under a constant stress.
const PRESSED: (&str, &str) = (
    "(block: \"upper\", on: All, hold: Direction((1, 0, 0))), (block: \"upper\", on: All, hold: Direction((0, 1, 0))),",
    "tractions: [(block: \"upper\", on: Set(\"z_max\"), traction_pa: (0, 0, -1e6))],",
);

/// Error of the work of shear in a run of one turn, over that: the trapezoidal rule's, (Δt/T)²/12, T the time between rows of the motion, at which
/// speeds jump.
const WORK_ERROR: f64 = (STEP_S * 40.0 / END_S) * (STEP_S * 40.0 / END_S) / 12.0;

/// Rows of a motion that comes to these slips one after the other, each in the same time, and rests there for a moment.
fn by_turns(slips_m: &[f64]) -> String {
    const ROWS: u32 = 40;
    let (turn_s, mut from_m, mut rows) = (END_S / slips_m.len() as f64, 0.0, String::new());
    for (turn, &to_m) in slips_m.iter().enumerate() {
        for part in (1..=ROWS).map(|k| f64::from(k) / f64::from(ROWS)) {
            let at_m = from_m + (to_m - from_m) * 0.5 * (1.0 - (PI * part).cos());
            let time_s = turn_s * (turn as f64 + part);
            write!(rows, "(time_s: {time_s}, displacement_m: ({at_m:e}, 0, 0)),").unwrap();
        }
        from_m = to_m;
    }
    rows
}

/// Runs from rest to the end; the last sample, the largest error of the balance of energy over the work of what moves the lower block, and the lift [m].
fn sheared(simulation: &mut Simulation) -> (Sample, f64, f64) {
    simulation.settle(&Settle::new(1e-9, 200_000)).unwrap();
    let start_m = lift_m(simulation);
    let (mut sample, mut worst_j) = (simulation.sample().unwrap(), 0.0f64);
    let steps = (END_S / STEP_S).round() as u32;
    for k in 1..=steps {
        simulation.step().unwrap();
        if k % 50 == 0 {
            sample = simulation.sample().unwrap();
            worst_j = worst_j.max(sample.balance_j.abs());
        }
    }
    (sample, worst_j / sample.motion_work_j.abs(), lift_m(simulation) - start_m)
}

/// Mean displacement of the lower face of the upper block, upwards [m].
fn lift_m(simulation: &Simulation) -> f64 {
    let rest = &simulation.blocks().rest_position;
    let nodes = simulation.blocks().nodes_of(BlockId(1));
    let lowest_m = nodes.clone().map(|n| rest[n].z).fold(f64::INFINITY, f64::min);
    let lower: Vec<usize> = nodes.filter(|&n| rest[n].z < lowest_m + 0.1).collect();
    let moved = displacements(simulation);
    lower.iter().map(|&n| moved[n].z).sum::<f64>() / lower.len() as f64
}

/// Normal force of the joint in the last step [N].
fn normal_n(simulation: &Simulation) -> f64 {
    let on_upper =
        |facet: &FacetContact| if facet.target == BlockId(0) { facet.push_n.z } else { -facet.push_n.z };
    simulation.contacts().iter().map(on_upper).sum()
}

#[test]
fn a_block_is_lifted_by_slip_and_friction_pays_for_it() {
    for (to_slip_m, noted) in [(1.0f64, [0.881635e-3, 2005.12]), (3e-3, [0.528981e-3, 2357.77])] {
        for (body, cells) in [("Affine", "1, 1, 1"), ("Elastic", "2, 2, 1")] {
            let rows = by_turns(&[total_m(5e-3)]);
            let mut run = shear_box(&upper(body, cells), SUNK_M, to_slip_m, &rows, PRESSED);
            let (end, error, rise_m) = sheared(&mut run);
            let exact_m = tan(PSI_DEG) * to_slip_m.min(5e-3);
            let exact_j = STRESS_PA * (5e-3 * tan(FRICTION_DEG) - exact_m);
            assert!((exact_m / noted[0] - 1.0).abs() < 1e-5 && (exact_j / noted[1] - 1.0).abs() < 1e-5);
            let until = format!("an {body} block at 1 MPa, dilation to a slip of {to_slip_m} m");
            row("dilation in runs", &format!("lift of {until} [m]"), rise_m, Within(exact_m, 5e-3));
            let stored_j = 0.5 * (STRESS_PA * tan(FRICTION_DEG)).powi(2) / STIFFNESS_PA_M;
            let lost_j = -end.friction_work_j - stored_j;
            row("dilation in runs", &format!("energy lost by {until} [J]"), lost_j, Within(exact_j, 5e-3));
            let what = format!("error of the balance of energy over the work of shear, {until} [-]");
            row("dilation in runs", &what, error, AtMost(WORK_ERROR));
        }
    }
}

/// σ = σ₀ + K v, u = u_p + σ tan φ/k_s, v = u_p tan ψ, K the stiffness of the joint and of what holds the rock around it, in series.
#[test]
fn rock_that_holds_a_joint_presses_it_while_it_opens() {
    let soft = "material: \"soft\", shape: Box(size_m: (1, 1, 0.5), cells: (1, 1, 1))";
    let held = "(block: \"upper\", on: All, hold: Direction((1, 0, 0))), (block: \"upper\", on: All, hold: Direction((0, 1, 0))), \
        (block: \"upper\", on: Set(\"z_max\"), hold: Direction((0, 0, 1))),";
    let cases = [
        ("constant volume", upper("Fixed", "1, 1, 1"), "", SUNK_M, 1e10, [2.50795e6, 4.10830e6, 8.90936e6]),
        (
            "1 GPa/m in series",
            soft.into(),
            held,
            SUNK_M + 1e-3,
            1e10 / 11.0,
            [1.149657e6, 1.308485e6, 1.784967e6],
        ),
    ];
    for (words, upper, held, sunk_m, held_pa_m, noted) in cases {
        let rows = format!("(time_s: {END_S}, displacement_m: (5e-3, 0, 0))");
        let mut run = shear_box(&upper, sunk_m, 1.0, &rows, (held, ""));
        if !held.is_empty() {
            run.settle(&Settle::new(1e-7, 200_000)).unwrap();
        }
        run.watch_contacts(true);
        let steps = (END_S / STEP_S).round() as u32;
        let mut at = 0;
        for (slip_mm, noted_pa) in [1u32, 2, 5].into_iter().zip(noted) {
            while at < steps * slip_mm / 5 {
                run.step().unwrap();
                at += 1;
            }
            let growth = held_pa_m * tan(PSI_DEG);
            let exact_pa = (STRESS_PA + growth * 1e-3 * f64::from(slip_mm))
                / (1.0 + growth * tan(FRICTION_DEG) / STIFFNESS_PA_M);
            assert!((exact_pa / noted_pa - 1.0).abs() < 1e-5, "{exact_pa} {noted_pa}");
            let what = format!("normal stress at a slip of {slip_mm} mm, {words} [Pa]");
            row("dilation in runs", &what, normal_n(&run), Within(exact_pa, 5e-3));
        }
    }
}

#[test]
fn a_joint_that_slips_back_closes_and_does_not_ratchet() {
    let rows = by_turns(&[total_m(2e-3), 0.0].repeat(4));
    let mut run = shear_box(&upper("Affine", "1, 1, 1"), SUNK_M, 1.0, &rows, PRESSED);
    run.settle(&Settle::new(1e-9, 200_000)).unwrap();
    let start_m = lift_m(&run);
    let (mut highest_m, steps) = ([0.0f64; 4], (END_S / STEP_S).round() as usize);
    for k in 0..steps {
        run.step().unwrap();
        highest_m[4 * k / steps] = highest_m[4 * k / steps].max(lift_m(&run) - start_m);
    }
    for (cycle, highest_m) in highest_m.into_iter().enumerate() {
        // The block rings on its joint after each turn.
        let what = format!("highest lift in cycle {} [m]", cycle + 1);
        row("dilation in runs", &what, highest_m, Within(2e-3 * tan(PSI_DEG), 3e-2));
    }
    // The spring is stretched the other way then, unless ringing has relaxed it.
    let back_m = (total_m(2e-3) - 2e-3) * tan(PSI_DEG);
    let after = |run: &mut Simulation| {
        run.step().unwrap();
        lift_m(run) - start_m
    };
    let mean_m = (0..400).map(|_| after(&mut run)).sum::<f64>() / 400.0;
    row("dilation in runs", "mean lift after four cycles [m]", mean_m, Near(0.5 * back_m, 0.6 * back_m));
}

/// Slide of a block of `mass_kg` on a joint of a square metre after `end_s` [m]. First it hangs on the spring of the joint, x = (g sin α/ω²)(1 − cos ωt) with ω² = k_s/m.
/// When that has its strength the block slides and rises at once, v = u tan ψ, for which friction takes a part tan φ tan ψ/(1 + tan φ tan ψ) of its speed. From then on
/// m ü = m g sin α − N tan φ and N = m g cos α + m v̈: ü = g (sin α − cos α tan φ)/(1 + tan φ tan ψ).
fn slide_m(slope_deg: f64, gravity_m_s2: f64, mass_kg: f64, spring_pa_m: f64, end_s: f64) -> f64 {
    let (sin, cos) = slope_deg.to_radians().sin_cos();
    let (rate, held) = ((spring_pa_m / mass_kg).sqrt(), 1.0 + tan(FRICTION_DEG) * tan(PSI_DEG));
    let stretch_m = mass_kg * gravity_m_s2 * cos * tan(FRICTION_DEG) / spring_pa_m;
    let angle = (1.0 - stretch_m * rate * rate / (gravity_m_s2 * sin)).acos();
    let (speed_m_s, left_s) = (gravity_m_s2 * sin / rate * angle.sin() / held, end_s - angle / rate);
    let rate_m_s2 = gravity_m_s2 * (sin - cos * tan(FRICTION_DEG)) / held;
    stretch_m + speed_m_s * left_s + 0.5 * rate_m_s2 * left_s * left_s
}

#[test]
fn a_rigid_block_on_a_slope_rises_while_it_slides() {
    let (slope_deg, gravity_m_s2, end_s, step_s) = (40.0f64, 9.81f64, 0.1f64, 2e-5f64);
    let mut run = simulation(&format!(
        "(title: \"slope\", time: (step_s: {step_s:e}, end_s: {end_s}), gravity_m_s2: ({}, 0, {}),
          materials: [(name: \"rock\", young_pa: 1e12, poisson: 0.2, density_kg_m3: 2600)],
          blocks: [
              (name: \"lower\", material: \"rock\", body: Fixed, shape: Box(size_m: (3, 3, 1), cells: (1, 1, 1)), at_m: (-1, -1, -1)),
              (name: \"upper\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 0.2), cells: (1, 1, 1)), at_m: (-0.5, 0, {})),
          ],
          contact: Potential(penalty_pa: 5e8, potential: Smooth(), friction: (friction_deg: {FRICTION_DEG}, shear_penalty_pa_m: 1e9,
              dilation: (psi_deg: {PSI_DEG}, to_slip_m: 1))))",
        gravity_m_s2 * slope_deg.to_radians().sin(),
        -gravity_m_s2 * slope_deg.to_radians().cos(),
        -2600.0 * 0.2 * gravity_m_s2 * slope_deg.to_radians().cos() / 1e9,
    ));
    let start = run.sample().unwrap();
    let mut worst_j = 0.0f64;
    for _ in 0..(end_s / step_s).round() as u32 {
        run.step().unwrap();
        worst_j = worst_j.max((run.sample().unwrap().balance_j - start.balance_j).abs());
    }
    let nodes = run.blocks().nodes_of(BlockId(1));
    let moved = displacements(&run)[nodes.clone()].iter().sum::<Vec3>() / nodes.len() as f64;
    let exact_m = slide_m(slope_deg, gravity_m_s2, 2600.0 * 0.2, 1e9, end_s);
    let what = "slide of a rigid block on 40° that dilates [m]";
    row("dilation in runs", what, moved.x, Within(exact_m, 5e-3));
    row("dilation in runs", "its rise over its slide [-]", moved.z / moved.x, Within(tan(PSI_DEG), 5e-3));
    let end = run.sample().unwrap();
    row(
        "dilation in runs",
        "error of its balance of energy over friction [-]",
        worst_j / end.friction_work_j.abs(),
        AtMost(5e-3),
    );
    let invariants = run.invariants();
    // Conserved exactly: rounding of 5000 steps, fivefold for the products of places and momenta.
    let rounds = rounding(5000);
    row(
        "dilation in runs",
        "error of its angular momentum [-]",
        invariants.angular_momentum,
        AtMost(5.0 * rounds),
    );
    row("dilation in runs", "error of its momentum [-]", invariants.linear_momentum, AtMost(rounds));
}

/// A rough joint opens by half of the angle that is mobilised, as `ndda joint` finds it.
#[test]
fn a_rough_joint_lifts_a_block_as_the_test_of_its_law_says() {
    let law = "roughness: (jrc: 10, jcs_pa: 100e6, mobilised: true, dilates: true)";
    let (slip_m, rows) = (5e-3, by_turns(&[5e-3]));
    let mut run = shear_box_of(law, (&upper("Affine", "1, 1, 1"), SUNK_M), &rows, PRESSED);
    let (_, error, rise_m) = sheared(&mut run);
    let path_m: Vec<f64> = (1..=5000).map(|k| slip_m * f64::from(k) / 5000.0).collect();
    let end = joint_laws::sheared(
        &format!("friction_deg: {FRICTION_DEG}, {law}"),
        STRESS_PA,
        Hold::Stress,
        &path_m,
    )
    .pop()
    .expect("rows");
    row("dilation in runs", "lift of a block on a rough joint [m]", rise_m, Within(end.dilation_m, 5e-3));
    let what = "error of its balance of energy over the work of shear [-]";
    row("dilation in runs", what, error, AtMost(WORK_ERROR));
}
