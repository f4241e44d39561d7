//! A slender block that rocks on its edges takes Housner's quarter period to come upright (Housner 1963).

use ndda_mesh::{BlockId, Vec3};

use crate::evidence::Answer::Within;
use crate::evidence::row;
use crate::simulation;

const WIDTH_M: f64 = 0.2;
const HEIGHT_M: f64 = 1.0;
const GRAVITY: f64 = 9.8;

/// R, α and p² of the block: half its diagonal, its slenderness, 3 g/4 R.
fn rocking() -> (f64, f64, f64) {
    let radius = 0.5 * WIDTH_M.hypot(HEIGHT_M);
    (radius, WIDTH_M.atan2(HEIGHT_M), 0.75 * GRAVITY / radius)
}

/// Time until upright, from a tilt of `part` α: acosh(1/(1 − θ₀/α))/p for small angles, and by small steps of
/// θ″ = −p² sin(α − θ).
fn quarter_periods(part: f64) -> (f64, f64) {
    let (_, slenderness, rate2) = rocking();
    let housner = (1.0 / (1.0 - part)).acosh() / rate2.sqrt();
    let (mut angle, mut rate, dt, mut t) = (part * slenderness, 0.0f64, 1e-6, 0.0);
    while angle > 0.0 {
        angle += 0.5 * dt * rate;
        rate -= dt * rate2 * (slenderness - angle).sin();
        angle += 0.5 * dt * rate;
        t += dt;
    }
    (housner, t)
}

#[test]
fn a_rocking_block_takes_housners_quarter_period() {
    for part in [0.3, 0.5, 0.7] {
        let (_, slenderness, _) = rocking();
        let step_s = 2e-5;
        let tilt = part * slenderness;
        let mut simulation = simulation(&format!(
            "(title: \"rocking\", time: (step_s: {step_s}, end_s: 1), gravity_m_s2: (0, 0, -{GRAVITY}),
              materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
              blocks: [
                (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (4, 2, 0.5), cells: (4, 2, 1)), at_m: (-2, -0.75, -0.5)),
                (name: \"block\", material: \"rock\", body: Rigid, turns: [(axis: (0, 1, 0), angle_deg: -{})],
                 shape: Box(size_m: ({WIDTH_M}, 0.5, {HEIGHT_M}), cells: (1, 2, 4))),
              ],
              contact: Potential(penalty_pa: 5e10, potential: Smooth(reference_m: 0.2), friction: (friction_deg: 60)))",
            tilt.to_degrees()
        ));
        let block = simulation.blocks().nodes_of(BlockId(1));
        let rest: Vec<Vec3> = simulation.state().position[block.clone()].to_vec();
        // The edge that stands on the floor, and that above it.
        let nearest = |place: Vec3| {
            let far = |&i: &usize| (rest[i] - place).norm();
            (0..rest.len()).min_by(|a, b| far(a).total_cmp(&far(b))).unwrap()
        };
        let (foot, top) =
            (nearest(Vec3::zeros()), nearest(HEIGHT_M * Vec3::new(-tilt.sin(), 0.0, tilt.cos())));
        let leans = |x: &[Vec3]| x[foot].x - x[top].x;
        let mut t = 0.0;
        while leans(&simulation.state().position[block.clone()]) > 0.0 && t < 2.0 {
            simulation.step().unwrap();
            t += step_s;
        }
        let (housner, exact) = quarter_periods(part);
        row(
            "rocking block",
            &format!("quarter period from {part} α by the rigid block's equation [s]"),
            t,
            Within(exact, 1e-2),
        );
        row(
            "rocking block",
            &format!("quarter period from {part} α by Housner [s]"),
            t,
            Within(housner, 1e-2),
        );
    }
}
