//! Stress in the ground: a column that carries its weight already, and one that does not.

use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::{rounding, row};
use crate::simulation;

/// A column of 1 × 1 × 4 m on rollers under gravity; `more` goes into the scene.
fn column(cells: &str, more: &str) -> ndda_solver::Simulation {
    let roller = |at: &str, n: &str| {
        format!("(block: \"column\", on: Plane(point_m: {at}, normal: {n}), hold: Normal),")
    };
    simulation(&format!(
        "(title: \"column\", time: (step_s: 1e-3, end_s: 1), gravity_m_s2: (0, 0, -10),
          materials: [(name: \"rock\", young_pa: 1e9, poisson: 0.25, density_kg_m3: 2500)],
          blocks: [(name: \"column\", material: \"rock\", shape: Box(size_m: (1, 1, 4), cells: {cells}))],
          supports: [{}{}{}{}{}], {more})",
        roller("(0, 0, 0)", "(0, 0, 1)"),
        roller("(0, 0, 0)", "(1, 0, 0)"),
        roller("(1, 0, 0)", "(1, 0, 0)"),
        roller("(0, 0, 0)", "(0, 1, 0)"),
        roller("(0, 1, 0)", "(0, 1, 0)"),
    ))
}

/// σ_zz = −ρ g (4 − z), and half of it sideways.
const LITHOSTATIC: &str = "in_situ: (stress_pa: (), at_m: (0, 0, 4), gradients: [(along: (0, 0, 2), \
                           stress_pa_m: (zz: 25000, xx: 12500, yy: 12500))])";

#[test]
fn a_column_in_lithostatic_stress_does_not_move() {
    for cells in ["(1, 1, 1)", "(2, 2, 5)"] {
        let mut simulation = column(cells, LITHOSTATIC);
        for _ in 0..1000 {
            simulation.step().unwrap();
        }
        let moved = crate::displacements(&simulation).iter().map(|u| u.norm()).fold(0.0, f64::max);
        // Without it the top sinks by about ρ g H²/2E = 0.2 mm and bounces.
        row(
            "in situ",
            &format!("motion of a column of {cells} cells in lithostatic stress [m]"),
            moved,
            // Forces balance in every node: ε of its 4 m.
            AtMost(4.0 * f64::EPSILON),
        );
        let mut stress = vec![[0.0; 6]; simulation.blocks().tets.len()];
        simulation.recover_stress(&mut stress).unwrap();
        let mean = stress.iter().map(|s| s[2]).sum::<f64>() / stress.len() as f64;
        // Rounding of a sum over up to 120 tetrahedra.
        let rounds = rounding(120);
        row("in situ", &format!("mean σ_zz of a column of {cells} cells [Pa]"), mean, Within(-50e3, rounds));
    }
}

#[test]
fn a_column_that_settles_comes_to_the_confined_stress_of_its_weight() {
    let mut simulation = column("(2, 2, 8)", "");
    simulation.settle(&ndda_solver::Settle::new(1e-4, 20_000)).unwrap();
    let mut stress = vec![[0.0; 6]; simulation.blocks().tets.len()];
    simulation.recover_stress(&mut stress).unwrap();
    // σ_zz = −ρ g (H − z), σ_xx = ν/(1 − ν) σ_zz; on average half of that at the foot.
    let mean = |i: usize| stress.iter().map(|s| s[i]).sum::<f64>() / stress.len() as f64;
    // It settled to 1e-4 of its largest speed, and so of its stress.
    row("in situ", "mean σ_zz of a column that has settled [Pa]", mean(2), Within(-50e3, 1e-4));
    row("in situ", "mean σ_xx of a column that has settled [Pa]", mean(0), Within(-50e3 / 3.0, 1e-4));
}
