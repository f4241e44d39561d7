//! A plate of 1 m² that is glued under a fixed one, pulled off it and sheared along it: the force at which its bonds break.

use ndda_mesh::BlockId;

use crate::evidence::Answer::Within;
use crate::evidence::row;
use crate::{advance, simulation};

const STEP_S: f64 = 5e-6;
const PULLED_S: f64 = 4e-3;
const END_S: f64 = 0.024;
const AREA_M2: f64 = 1.0;
/// Most shear over the strength that is expected.
const MOST: f64 = 1.2;

/// Shear force at which the last bond breaks [N]; pulled first, then sheared slowly, both in the joint.
fn breaking_n(cohesion_pa: f64, tension_pa: f64, pull_n: f64, friction_deg: f64, expected_n: f64) -> f64 {
    let most_n = MOST * expected_n;
    let mut simulation = simulation(&format!(
        "(title: \"bond\", time: (step_s: {STEP_S:e}, end_s: {END_S}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: 2650)],
          blocks: [
            (name: \"roof\", material: \"rock\", body: Fixed, shape: Box(size_m: (1.2, 1.2, 0.1), cells: (1, 1, 1)), at_m: (-0.1, -0.1, 0)),
            (name: \"plate\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 0.01), cells: (2, 2, 1)), at_m: (0, 0, -0.01)),
          ],
          forces: [
            (block: \"plate\", at_m: (0.5, 0.5, 0), force_n: (0, 0, {:e}), factor: [(time_s: 0, factor: 0), (time_s: {PULLED_S}, factor: 1)]),
            (block: \"plate\", at_m: (0.5, 0.5, 0), force_n: ({most_n:e}, 0, 0), factor: [(time_s: {PULLED_S}, factor: 0), (time_s: {END_S}, factor: 1)]),
          ],
          contact: Potential(penalty_pa: 1e9, potential: Smooth(reference_m: 0.1), friction: (friction_deg: {friction_deg}, shear_penalty_pa_m: 1e11,
                             cohesion_pa: {cohesion_pa:e}, tension_pa: {tension_pa:e})))",
        -pull_n
    ));
    while simulation.time_s() < END_S {
        simulation.step().unwrap();
        if simulation.state().contact.bonds.is_empty() {
            return most_n * (simulation.time_s() - PULLED_S) / (END_S - PULLED_S);
        }
    }
    f64::INFINITY
}

#[test]
fn a_glued_plate_under_slight_tension_breaks_at_its_cohesion() {
    for (cohesion_pa, tension_pa, pull_n) in [(1e5, 1e6, 1e5), (1e6, 1e5, 1e4)] {
        let strength_n = cohesion_pa * AREA_M2;
        let found_n = breaking_n(cohesion_pa, tension_pa, pull_n, 0.0, strength_n);
        let what = format!(
            "shear that breaks a bond, c = {cohesion_pa:e} Pa, σ_t = {tension_pa:e} Pa, pulled by {pull_n:e} N [N]"
        );
        row("bonds", &what, found_n, Within(strength_n, 1e-2));
    }
}

#[test]
fn a_pull_takes_its_friction_from_the_cohesion_and_a_push_adds_it() {
    let (cohesion_pa, friction_deg) = (1e6, 30.0f64);
    for pull_n in [5e4, -2e5] {
        let strength_n = cohesion_pa * AREA_M2 - pull_n * friction_deg.to_radians().tan();
        let found_n = breaking_n(cohesion_pa, 1e5, pull_n, friction_deg, strength_n);
        let what = format!(
            "shear that breaks a bond of c = {cohesion_pa:e} Pa and φ = 30°, pulled by {pull_n:e} N [N]"
        );
        row("bonds", &what, found_n, Within(strength_n, 1e-2));
    }
}

#[test]
fn bonds_form_where_blocks_are_meshed_however_long_the_first_step_is() {
    // A cube of m = 2500 kg that is glued under a fixed one by K = k_s A = 1e6 N/m, under sudden weight: z = m g/K (1 − cos ωt), ω = √(K/m) = 20 /s.
    let time_s = 0.1;
    let exact_m = 2500.0 * 9.81 / 1e6 * (1.0 - f64::cos(20.0 * time_s));
    // Contact at the end of steps damps by a part ½ ωΔt of each radian.
    for (contact_at, steps) in [("Predicted", [1e-4, 2e-3, 5e-3]), ("End()", [1e-4, 1e-3, 2e-3])] {
        for step_s in steps {
            let mut simulation = simulation(&format!(
                "(title: \"glued\", time: (step_s: {step_s:e}, end_s: 1, contact_at: {contact_at}), gravity_m_s2: (0, 0, -9.81),
                  materials: [(name: \"rock\", young_pa: 1e10, poisson: 0.2, density_kg_m3: 2500)],
                  blocks: [
                    (name: \"held\", material: \"rock\", body: Fixed, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (0, 0, 1)),
                    (name: \"hung\", material: \"rock\", body: Rigid, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1))),
                  ],
                  contact: Potential(penalty_pa: 1e6, potential: Smooth(), friction: (friction_deg: 30, shear_penalty_pa_m: 1e6,
                                     cohesion_pa: 1e9, tension_pa: 1e9)))"
            ));
            advance(&mut simulation, (time_s / step_s).round() as u64);
            let hung = simulation.blocks().nodes_of(BlockId(1));
            let mean = |x: &[ndda_mesh::Vec3]| x.iter().map(|x| x.z).sum::<f64>() / x.len() as f64;
            let sunk_m = mean(&simulation.blocks().rest_position[hung.clone()])
                - mean(&simulation.state().position[hung]);
            let what = format!(
                "way of a cube that hangs on its bonds after 0.1 s, {contact_at}, steps of {step_s:e} s [m]"
            );
            row("bonds", &what, sunk_m, Within(exact_m, 0.01 + 20.0 * step_s));
        }
    }
}
