//! Torsional friction: a plank that spins on a plane under its weight. The limit torque of an even pressure p is
//! μ p ∫ r dA, so that the plank slows down at a constant rate and stops at a known angle.

use ndda_mesh::{BlockId, Vec3};
use ndda_solver::Simulation;

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;
use crate::simulation;

const CASE: &str = "torsional friction";
const GRAVITY: f64 = 9.8;
const FRICTION_DEG: f64 = 20.0;
const SPIN_RAD_S: f64 = 2.0;
/// What docs/theory/contact.md promises of the torque of a patch that twists.
const PROMISED: f64 = 5e-3;
/// The same of shear springs, of a square, of 2 : 1 and of 5 : 1: each facet bears force and torque within an ellipsoid, and points of a long facet that slide the same way bear
/// less torque than that allows.
const PROMISED_OF_SPRINGS: [(f64, f64); 3] = [(1.0, 0.03), (0.5, 0.05), (0.2, 0.1)];

/// Mean distance from the centre of a rectangle of 1 m and a width, in closed form.
fn mean_radius_m(width_m: f64) -> f64 {
    let (p, q) = (0.5, 0.5 * width_m);
    let d = f64::hypot(p, q);
    (2.0 * p * q * d + p.powi(3) * (q / p).asinh() + q.powi(3) * (p / q).asinh()) / (6.0 * p * q)
}

/// The same by the midpoint rule on n × n cells of a quarter.
fn mean_radius_by_quadrature_m(width_m: f64, n: u32) -> f64 {
    let at = |i: u32, size: f64| (f64::from(i) + 0.5) / f64::from(n) * 0.5 * size;
    let cells = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    cells.map(|(i, j)| at(i, 1.0).hypot(at(j, width_m))).sum::<f64>() / f64::from(n * n)
}

/// A plank of 1 m, 0.1 m thick, as deep as its weight presses it, that spins about its middle.
fn plank(width_m: f64, body: &str, step_s: f64) -> Simulation {
    plank_on((width_m, [1, 3]), body, step_s, "")
}

/// The same with these cells along both sides of the plank and of the floor, and more words on friction.
fn plank_on((width_m, [own, floor]): (f64, [u32; 2]), body: &str, step_s: f64, spring: &str) -> Simulation {
    let penalty_pa = 2e8;
    let sunk = 2650.0 * GRAVITY * 0.1 / (2.0 * penalty_pa);
    simulation(&format!(
        "(title: \"plank\", time: (step_s: {step_s:e}, end_s: 1), gravity_m_s2: (0, 0, -{GRAVITY}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
          blocks: [
            (name: \"floor\", material: \"rock\", body: Fixed, shape: Box(size_m: (6, 6, 1), cells: ({floor}, {floor}, 1)), at_m: (-3, -3, -1)),
            (name: \"plank\", material: \"rock\", body: {body}, shape: Box(size_m: (1, {width_m}, 0.1), cells: ({own}, {own}, 1)),
             at_m: (-0.5, {}, {}), spin_rad_s: (0, 0, {SPIN_RAD_S})),
          ],
          contact: Potential(penalty_pa: {penalty_pa:e}, potential: Smooth(reference_m: 1), friction: (friction_deg: {FRICTION_DEG}{spring})))",
        -0.5 * width_m, -sunk
    ))
}

/// Angle from one edge of the plank, between its first and last nodes, to where it points now, or its spin [rad, rad/s].
fn turned(simulation: &Simulation) -> (f64, f64) {
    let nodes = simulation.blocks().nodes_of(BlockId(1));
    let (first, last) = (nodes.start, nodes.end - 1);
    let edge = |places: &[Vec3]| (places[last] - places[first]).xy();
    let (now, then) = (edge(&simulation.state().position), edge(&simulation.blocks().rest_position));
    let rate = edge(&simulation.state().velocity);
    let (angle, spin) = (then.perp(&now).atan2(then.dot(&now)), now.perp(&rate) / now.norm_squared());
    (angle, spin)
}

fn advance(simulation: &mut Simulation, time_s: f64, step_s: f64) -> (f64, f64) {
    for _ in 0..(time_s / step_s).round() as u32 {
        simulation.step().unwrap();
    }
    turned(simulation)
}

#[test]
fn a_plank_that_spins_is_slowed_by_the_limit_torque_and_stops_at_its_angle() {
    for width_m in [1.0, 0.5, 0.2, 0.1, 0.05] {
        let arm_m = mean_radius_m(width_m);
        // The midpoint rule of second order; r itself has a corner at the centre, which costs no more.
        row(
            CASE,
            &format!("mean radius of a plank {width_m} m wide by quadrature [m]"),
            mean_radius_by_quadrature_m(width_m, 200),
            Within(arm_m, 1.0 / f64::from(200 * 200)),
        );
        let slowing = FRICTION_DEG.to_radians().tan() * GRAVITY * arm_m / ((1.0 + width_m * width_m) / 12.0);
        let (stops_s, angle) = (SPIN_RAD_S / slowing, 0.5 * SPIN_RAD_S * SPIN_RAD_S / slowing);
        for body in ["Rigid", "Affine"] {
            let what = |what: &str| format!("{what}, plank {width_m} m wide, {body}");
            let found = [4e-4, 1e-4].map(|step_s| {
                let mut simulation = plank(width_m, body, step_s);
                let half_s = (0.5 * stops_s / 4e-4).round() * 4e-4;
                let (_, spin) = advance(&mut simulation, half_s, step_s);
                row(
                    CASE,
                    &what(&format!("rate at which the spin falls, Δt = {step_s:e} s [rad/s²]")),
                    (SPIN_RAD_S - spin) / half_s,
                    Within(slowing, PROMISED),
                );
                let (angle_found, spin) = advance(&mut simulation, 0.7 * stops_s, step_s);
                if body == "Rigid" {
                    // Friction is found to 1e-7 of μN, here once more for each step. Affine planks go on to vibrate.
                    row(
                        CASE,
                        &what(&format!("spin after it has stopped, Δt = {step_s:e} s [rad/s]")),
                        spin.abs(),
                        AtMost(1e-7 * SPIN_RAD_S),
                    );
                }
                angle_found
            });
            row(CASE, &what("angle at which it stops [rad]"), found[1], Within(angle, PROMISED));
            if body == "Rigid" {
                // It stops within a step, by which less than half α Δt² of the angle may be off. Affine planks vibrate besides.
                row(
                    CASE,
                    &what("angle at Δt = 4e-4 s against that at 1e-4 s, over it"),
                    (found[0] / found[1] - 1.0).abs(),
                    AtMost((4e-4 / stops_s).powi(2)),
                );
            }
        }
    }
}

#[test]
fn shear_springs_slow_a_plank_that_spins_however_large_their_facets_are() {
    let (step_s, spring) = (1e-4, ", shear_penalty_pa_m: 1e10");
    for (width_m, promised) in PROMISED_OF_SPRINGS {
        let arm_m = mean_radius_m(width_m);
        let slowing = FRICTION_DEG.to_radians().tan() * GRAVITY * arm_m / ((1.0 + width_m * width_m) / 12.0);
        for body in ["Rigid", "Affine"] {
            for cells in [[1, 1], [1, 8], [4, 1]] {
                let mut simulation = plank_on((width_m, cells), body, step_s, spring);
                let half_s = (0.5 * SPIN_RAD_S / slowing / step_s).round() * step_s;
                let (_, spin) = advance(&mut simulation, half_s, step_s);
                let [own, floor] = cells;
                let on = format!("plank {width_m} m wide of {own} cells on {floor}, {body}");
                row(
                    CASE,
                    &format!("rate at which the spin falls by shear springs, {on} [rad/s²]"),
                    (SPIN_RAD_S - spin) / half_s,
                    Within(slowing, promised),
                );
            }
        }
    }
}
