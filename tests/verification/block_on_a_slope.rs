//! A block on a slope stands, slides, topples or does both, by its slenderness and friction (Wyllie & Mah 2004),
//! and as quickly as a rigid block does.

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Settle;

use crate::evidence::Answer::{AtMost, Near, Within};
use crate::evidence::row;
use crate::simulation;

const BASE_M: f64 = 10.0;
const DIP_DEG: f64 = 40.0;
const GRAVITY: f64 = 9.8;
const DENSITY: f64 = 2000.0;
/// Length over which the potential rises.
const REFERENCE_M: f64 = 1.0;

/// Motion of the block after `time_s`: how far it slid down the slope, and how far it turned [rad]. It may be
/// brought to rest first, as far as it stays.
fn fate((height_m, friction_deg): (f64, f64), penalty_pa: f64, time_s: f64, settles: bool) -> (f64, f64) {
    // A step in proportion to the period of contact.
    let step_s = 9.0 / penalty_pa.sqrt();
    let (sin, cos) = DIP_DEG.to_radians().sin_cos();
    // As deep as its weight requires: p = 2 k_n h/L₀.
    let sunk = DENSITY * GRAVITY * cos * height_m * REFERENCE_M / (2.0 * penalty_pa);
    let mut simulation = simulation(&format!(
        "(title: \"slope\", time: (step_s: {step_s:e}, end_s: 1), gravity_m_s2: ({}, 0, -{}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: {DENSITY})],
          blocks: [
            (name: \"slope\", material: \"rock\", body: Fixed, shape: Box(size_m: (60, 20, 5), cells: (12, 4, 1)), at_m: (-40, -5, -5)),
            (name: \"block\", material: \"rock\", body: Rigid, at_m: (0, 0, -{sunk:e}),
             shape: Box(size_m: ({BASE_M}, {BASE_M}, {height_m}), cells: (4, 4, 2))),
          ],
          contact: Potential(penalty_pa: {penalty_pa:e}, potential: Smooth(reference_m: {REFERENCE_M}),
                             friction: (friction_deg: {friction_deg})))",
        -GRAVITY * sin,
        GRAVITY * cos
    ));
    let block = simulation.blocks().nodes_of(BlockId(1));
    if settles {
        simulation.settle(&Settle::new(1e-4, 20_000)).unwrap();
    }
    let rest: Vec<Vec3> = simulation.state().position[block.clone()].to_vec();
    for _ in 0..(time_s / step_s) as u32 {
        simulation.step().unwrap();
    }
    let now = &simulation.state().position[block];
    // The lower edge slides; an edge along z, from the bottom to the top, turns.
    let at = |x: f64, z: f64| {
        let misfit = |i: &usize| (rest[*i].x - x).abs() + (rest[*i].z - z).abs() + rest[*i].y.abs();
        (0..rest.len()).min_by(|a, b| misfit(a).total_cmp(&misfit(b))).unwrap()
    };
    let low = rest.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
    let left = rest.iter().map(|x| x.x).fold(f64::INFINITY, f64::min);
    let (foot, top) = (at(left, low), at(left, low + height_m));
    let lean = |x: &[Vec3]| (x[foot].x - x[top].x).atan2(x[top].z - x[foot].z);
    (rest[foot].x - now[foot].x, lean(now) - lean(&rest))
}

#[test]
fn a_block_on_a_slope_stands_slides_or_topples_as_statics_says() {
    let (sin, cos) = DIP_DEG.to_radians().sin_cos();
    let time_s = 0.5;
    let (slid, turned) = fate((10.0, 40.1), 2e9, time_s, true);
    // Standing is the statement: it moves by less than a ten-millionth of its edge. What settling leaves of its speed has no closed form.
    let stands_m = 1e-7 * BASE_M;
    row("block on a slope", "slide of 10 m at 40.1°, which stands [m]", slid.abs(), AtMost(stands_m));
    row("block on a slope", "turn of 10 m at 40.1°, which stands [rad]", turned.abs(), AtMost(1e-6));

    let (slid, turned) = fate((5.0, 20.0), 1e11, time_s, false);
    let free = 0.5 * GRAVITY * (sin - 20f64.to_radians().tan() * cos) * time_s * time_s;
    row("block on a slope", "slide of 5 m at 20° [m]", slid, Within(free, 2e-2));
    // Friction on its base leans it on the bed of contact by its moment over the bed's stiffness, and twice as far when it swings: thrice that.
    let friction_n = DENSITY * BASE_M * BASE_M * 5.0 * GRAVITY * cos * 20f64.to_radians().tan();
    let bed_n_m = 2.0 * 1e11 / REFERENCE_M * BASE_M.powi(4) / 12.0;
    let leans = 6.0 * friction_n * 2.5 / bed_n_m;
    row("block on a slope", "turn of 5 m at 20°, which slides [rad]", turned, Near(0.0, leans));

    let (slid, turned) = fate((25.0, 60.0), 1e11, time_s, false);
    // Contact is stiff here: a soft edge sinks, and the block turns about a line further up.
    let falls = turn_about_the_foot(25.0, time_s);
    row("block on a slope", "turn of 25 m at 60° [rad]", turned, Within(falls, 5e-2));
    // It turns about the end of the strip w on which its edge presses, ½ p′ w² θ = N: its foot goes w θ²/2 aside, and four times that passes.
    let normal_n = DENSITY * BASE_M * BASE_M * 25.0 * GRAVITY * cos;
    let strip_m = (2.0 * normal_n / (2.0 * 1e11 / REFERENCE_M * BASE_M * falls)).sqrt();
    let aside_m = 4.0 * 0.5 * strip_m * falls * falls;
    row("block on a slope", "slide of 25 m at 60°, which topples [m]", slid, Near(0.0, aside_m));

    let (slid, turned) = fate((25.0, 24.0), 1e11, time_s, false);
    let (slides, turns) = slide_and_turn((25.0, 24.0), 1e11, time_s);
    row("block on a slope", "slide of 25 m at 24°, which does both [m]", slid, Within(slides, 0.01));
    row("block on a slope", "turn of 25 m at 24°, which does both [rad]", turned, Within(turns, 0.01));
}

/// Slide of the foot and turn of a block that does both: a rigid rectangle on a bed of pressure 2 k_n d/L₀ at depth d that pushes only, with friction
/// μ p against its slide, by small steps. The lever of friction, μ h/2 − b/2, is 0.56 m, of which the edge that sinks takes a part.
fn slide_and_turn((height_m, friction_deg): (f64, f64), penalty_pa: f64, time_s: f64) -> (f64, f64) {
    let (down, across) = DIP_DEG.to_radians().sin_cos();
    let friction = friction_deg.to_radians().tan();
    let (half_b, half_h) = (0.5 * BASE_M, 0.5 * height_m);
    let mass_kg = DENSITY * BASE_M * BASE_M * height_m;
    let inertia = mass_kg * (BASE_M.powi(2) + height_m.powi(2)) / 12.0;
    let bed = 2.0 * penalty_pa * BASE_M / REFERENCE_M;
    let sunk = mass_kg * GRAVITY * across / (bed * BASE_M);
    // The centre along the slope, upwards, and above it; the turn, down the slope.
    let (mut x, mut z, mut turn) = (0.0, half_h - sunk, 0.0f64);
    let (mut v, mut w, mut spin) = (0.0, 0.0, 0.0);
    let steps = 500_000;
    let dt = time_s / f64::from(steps);
    for _ in 0..steps {
        let (sin, cos) = turn.sin_cos();
        // d(s) = c − s sin θ over the part of the base that is in the bed.
        let c = half_h * cos - z;
        let edge = if sin == 0.0 { half_b } else { (c / sin).clamp(-half_b, half_b) };
        let (a, b) = if sin < 0.0 { (edge, half_b) } else { (-half_b, edge) };
        let push = bed * (c * (b - a) - sin * (b * b - a * a) / 2.0).max(0.0);
        let moment = bed * (c * (b * b - a * a) / 2.0 - sin * (b.powi(3) - a.powi(3)) / 3.0);
        let foot_m_s = v + spin * (half_b * sin + half_h * cos);
        let drag = if foot_m_s < 0.0 { friction } else { 0.0 };
        let torque = cos * moment + half_h * sin * push - drag * (sin * moment - half_h * cos * push);
        v += dt * (drag * push / mass_kg - GRAVITY * down);
        w += dt * (push / mass_kg - GRAVITY * across);
        spin += dt * torque / inertia;
        (x, z, turn) = (x + dt * v, z + dt * w, turn + dt * spin);
    }
    let (sin, cos) = turn.sin_cos();
    (-(x - half_b * cos + half_h * sin + half_b), turn)
}

/// Turn of a rigid block about its foot on a slope: (4/3) R² θ″ = g R sin(θ + ψ − α), tan α = b/h, by small steps.
fn turn_about_the_foot(height_m: f64, time_s: f64) -> f64 {
    let radius = 0.5 * BASE_M.hypot(height_m);
    let lean = DIP_DEG.to_radians() - BASE_M.atan2(height_m);
    let (mut angle, mut rate, steps) = (0.0f64, 0.0f64, 100_000);
    let dt = time_s / f64::from(steps);
    for _ in 0..steps {
        angle += 0.5 * dt * rate;
        rate += dt * 0.75 * GRAVITY / radius * (angle + lean).sin();
        angle += 0.5 * dt * rate;
    }
    angle
}
