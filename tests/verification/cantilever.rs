//! A cantilever under its own weight against Timoshenko's beam, by refinement; and what ν → ½ does to linear
//! tetrahedra.

use crate::evidence::Answer::{AtMost, Near};
use crate::evidence::row;
use crate::simulation;

const YOUNG_PA: f64 = 10e9;
const DENSITY: f64 = 2500.0;
const GRAVITY: f64 = 10.0;
const LENGTH_M: f64 = 1.0;
const HEIGHT_M: f64 = 0.2;

/// Deflection of the tip [m]: ρ g A L⁴/(8 E I) + ρ g L²/(2 κ G), κ = 5/6.
fn beam(poisson: f64) -> f64 {
    let load = DENSITY * GRAVITY;
    let bending = load * LENGTH_M.powi(4) * 12.0 / (8.0 * YOUNG_PA * HEIGHT_M * HEIGHT_M);
    let shear = YOUNG_PA / (2.0 * (1.0 + poisson));
    bending + load * LENGTH_M * LENGTH_M / (2.0 * 5.0 / 6.0 * shear)
}

/// Deflection of the tip's section with `n` cells over the height: long steps of a scheme that damps are static.
fn deflection(n: u32, poisson: f64) -> f64 {
    let mut simulation = simulation(&format!(
        "(title: \"cantilever\", time: (step_s: 1, end_s: 20, integrator: Newmark(alpha: 0.5, delta: 1)),
          gravity_m_s2: (0, 0, -{GRAVITY}),
          materials: [(name: \"rock\", young_pa: {YOUNG_PA:e}, poisson: {poisson}, density_kg_m3: {DENSITY})],
          blocks: [(name: \"beam\", material: \"rock\",
                    shape: Box(size_m: ({LENGTH_M}, {HEIGHT_M}, {HEIGHT_M}), cells: ({}, {n}, {n})))],
          supports: [(block: \"beam\", on: Plane(point_m: (0, 0, 0), normal: (1, 0, 0)), hold: Fixed)])",
        5 * n
    ));
    for _ in 0..20 {
        simulation.step().unwrap();
    }
    let blocks = simulation.blocks();
    let sunk = |(x, rest): (&ndda_mesh::Vec3, &ndda_mesh::Vec3)| {
        ((rest + blocks.origin_m).x > LENGTH_M - 1e-6).then_some(rest.z - x.z)
    };
    let tip: Vec<f64> =
        simulation.state().position.iter().zip(&blocks.rest_position).filter_map(sunk).collect();
    tip.iter().sum::<f64>() / tip.len() as f64
}

#[test]
fn a_cantilever_converges_to_the_beam_with_second_order() {
    let exact = beam(0.0);
    let errors = [2, 4, 8].map(|n| (n, 1.0 - deflection(n, 0.0) / exact));
    for (n, error) in errors {
        // Linear tetrahedra of height h add to the stiffness in bending a part of second order, 4 (h/H)² at most, and lack a/(1 + a).
        let most = 4.0 / f64::from(n * n + 4);
        assert!(error > 0.0, "linear tetrahedra are too stiff: {errors:?}");
        row(
            "bending",
            &format!("deflection that {n} cells over the height lack of the beam's"),
            error,
            AtMost(most),
        );
    }
    // The part a that elements add to the stiffness is e/(1 − e) of the error e. If a ∝ h² (1 + c h/H), |c| ≤ ½, its order between h and h/2 is off 2 by
    // c h/(2 H ln 2).
    let added = errors.map(|(n, error)| (n, error / (1.0 - error)));
    for pair in added.windows(2) {
        let [(n, coarse), (twice, fine)] = [pair[0], pair[1]];
        let off = 0.25 / (f64::from(n) * std::f64::consts::LN_2);
        let what = format!("order of the stiffness that elements add, {n} to {twice} cells");
        row("bending", &what, (coarse / fine).log2(), Near(2.0, off));
    }
}

#[test]
fn near_incompressible_rock_locks_and_says_so() {
    let soft = deflection(4, 0.25) / beam(0.25);
    for poisson in [0.49, 0.499, 0.4999] {
        let locked = deflection(4, poisson) / beam(poisson);
        row(
            "extreme: locking",
            &format!("deflection over the beam's at ν = {poisson}; {soft:.3} at 0.25"),
            locked,
            AtMost(soft),
        );
    }
}
