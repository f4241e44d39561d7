//! A bar pulled at its end: uniform stress σ, strains σ/E and −ν σ/E. The patch test of the block solve.

use ndda_mesh::Vec3;

use crate::evidence::Answer::AtMost;
use crate::evidence::row;
use crate::{POISSON, YOUNG_PA, assert_uniform_strain, bar, rollers, settle};

#[test]
fn a_pulled_bar_reaches_uniform_strain_and_stress() {
    let traction_pa = 1e5;
    let loads =
        format!("tractions: [(block: \"bar\", on: Set(\"x_max\"), traction_pa: ({traction_pa}, 0, 0))]");
    let mut simulation = bar("", &rollers(""), &loads);
    settle(&mut simulation);
    let strain = traction_pa / YOUNG_PA;
    // The tolerance is for ringing that has not died out.
    assert_uniform_strain(&simulation, Vec3::new(strain, -POISSON * strain, -POISSON * strain), 1e-9);

    let mut stress = vec![[0.0; 6]; simulation.blocks().tets.len()];
    simulation.recover_stress(&mut stress).unwrap();
    let exact = [traction_pa, 0.0, 0.0, 0.0, 0.0, 0.0];
    let off = |s: &[f64; 6]| s.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let worst = stress.iter().map(off).fold(0.0, f64::max);
    row(
        "uniform stress",
        "stress off that of the traction in a pulled bar, relative",
        worst / traction_pa,
        AtMost(1e-8),
    );
}
