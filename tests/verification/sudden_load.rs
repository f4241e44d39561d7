//! A block that gravity presses onto a held one all at once. It swings about the depth where contact carries it, v = −(g/ω) sin ωt, until
//! it is back where it began. A step of `Midpoint` leaves of that its frequency, sin ½ΩΔt = ½ωΔt, and (ω Δt)⁴/128 of the size;
//! without the ⅛ Δt² a that contact looks ahead of it the size would be off by (ω Δt)²/8.

use crate::evidence::Answer::{AtMost, Near};
use crate::evidence::row;
use crate::{advance, simulation};

const GRAVITY_M_S2: f64 = 9.8;
const PENALTY_PA: f64 = 4e8;
const DENSITY_KG_M3: f64 = 2500.0;

/// ω of a block 1 m high on its lower face: both fields have the slope 1 over the reference length, 2 k_n A in all.
fn rate() -> f64 {
    (2.0 * PENALTY_PA / DENSITY_KG_M3).sqrt()
}

/// Largest error of the velocity in the first swing, of g/ω.
fn error(body: &str, turn: f64) -> f64 {
    let (rate, step_s) = (rate(), turn / rate());
    let mut simulation = simulation(&format!(
        "(title: \"sudden\", time: (step_s: {step_s}, end_s: 1), gravity_m_s2: (0, 0, -{GRAVITY_M_S2}),
          materials: [(name: \"rock\", young_pa: 1e12, poisson: 0, density_kg_m3: {DENSITY_KG_M3})],
          blocks: [
            (name: \"base\", material: \"rock\", shape: Box(size_m: (1, 1, 0.25), cells: (2, 2, 1)), body: Fixed),
            (name: \"top\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)), at_m: (0, 0, 0.25), body: {body}),
          ],
          contact: Potential(penalty_pa: {PENALTY_PA:e}, potential: Smooth(reference_m: 1)))"
    ));
    let of_scheme = 2.0 * (0.5 * turn).asin() / step_s;
    let steps = (std::f64::consts::TAU / (of_scheme * step_s)) as u64;
    let mut worst = 0.0f64;
    for _ in 0..steps {
        simulation.step().unwrap();
        let velocity = simulation.sample().unwrap().momentum.z / DENSITY_KG_M3;
        let exact = -GRAVITY_M_S2 / rate * (of_scheme * simulation.time_s()).sin();
        worst = worst.max((velocity - exact).abs() * rate / GRAVITY_M_S2);
    }
    worst
}

#[test]
fn a_block_under_a_sudden_load_swings_by_the_load() {
    for body in ["Elastic", "Rigid"] {
        for turn in [0.2, 0.4, 0.8] {
            let what = format!("velocity under sudden gravity, {body}, ω Δt = {turn}: largest error, of g/ω");
            row(
                "bounce and contact stability",
                &what,
                error(body, turn),
                Near(0.0, turn.powi(4) / 128.0 + 2e-3),
            );
        }
    }
}

#[test]
fn blocks_that_push_each_other_off_keep_momentum_angular_momentum_and_energy() {
    // They overlap by two millimetres, and contact looks the further ahead of each the lighter it is. Without that they would gain 5 % of energy.
    let mut simulation = simulation(
        "(title: \"off\", time: (step_s: 1e-3, end_s: 0.05),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2500)],
          blocks: [
            (name: \"a\", material: \"rock\", shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)),
              velocity_m_s: (0.1, 0.2, 0.3), spin_rad_s: (0.1, 0.2, -0.1)),
            (name: \"b\", material: \"rock\", shape: Box(size_m: (0.6, 0.7, 0.5), cells: (1, 1, 1)), at_m: (0.4, 0.25, 0.998), body: Rigid),
            (name: \"c\", material: \"rock\", shape: Box(size_m: (0.5, 0.5, 0.5), cells: (1, 1, 1)), at_m: (0.998, -0.2, 0.1), body: Affine),
          ],
          contact: Potential(penalty_pa: 2e7))",
    );
    simulation.sample().unwrap();
    advance(&mut simulation, 50);
    simulation.sample().unwrap();
    let found = simulation.invariants();
    assert!(found.contact_pairs_max > 0 && found.max_h > 1.0, "they do not push: {found:?}");
    row(
        "bounce and contact stability",
        "three blocks pushed off by each other: momentum lost",
        found.linear_momentum,
        AtMost(1e-13),
    );
    row("bounce and contact stability", "… angular momentum lost", found.angular_momentum, AtMost(1e-12));
    let energy = found.lasting_gain.max(found.lasting_loss);
    row("bounce and contact stability", "… energy lost or gained once they part", energy, AtMost(1e-2));
}
