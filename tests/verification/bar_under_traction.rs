//! A bar pulled at its end: uniform stress σ, strains σ/E and −ν σ/E. The patch test of the block solve.

use ndda_mesh::Vec3;

use crate::{POISSON, YOUNG_PA, assert_uniform_strain, bar, rollers, settle};

#[test]
fn a_pulled_bar_reaches_uniform_strain_and_stress() {
    let traction_pa = 1e5;
    let loads =
        format!("tractions: [(block: \"bar\", on: Set(\"x_max\"), traction_pa: ({traction_pa}, 0, 0))]");
    let mut simulation = bar("", &rollers(""), &loads);
    settle(&mut simulation);
    let strain = traction_pa / YOUNG_PA;
    // What is left is ringing that has not died out.
    assert_uniform_strain(&simulation, Vec3::new(strain, -POISSON * strain, -POISSON * strain), 1e-9);

    let mut stress = vec![[0.0; 6]; simulation.blocks().tets.len()];
    simulation.recover_stress(&mut stress).unwrap();
    for s in stress {
        let exact = [traction_pa, 0.0, 0.0, 0.0, 0.0, 0.0];
        let worst = s.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-8 * traction_pa, "{s:?}");
    }
}
