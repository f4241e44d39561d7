//! A bar that is born compressed and free to grow: σ = D ε + σ₀ = 0, so ε = −D⁻¹ σ₀. Settles the sign of eq 6.

use ndda_mesh::Vec3;

use crate::evidence::Answer::AtMost;
use crate::evidence::row;
use crate::{POISSON, YOUNG_PA, assert_uniform_strain, bar, rollers, settle};

#[test]
fn a_compressed_bar_grows_until_it_is_free_of_stress() {
    let pressure_pa = 1e5;
    let mut simulation = bar(&format!("initial_stress_pa: (xx: -{pressure_pa})"), &rollers(""), "");
    settle(&mut simulation);
    let strain = pressure_pa / YOUNG_PA;
    assert_uniform_strain(&simulation, Vec3::new(strain, -POISSON * strain, -POISSON * strain), 1e-9);

    let mut stress = vec![[0.0; 6]; simulation.blocks().tets.len()];
    simulation.recover_stress(&mut stress).unwrap();
    let left = stress.iter().flatten().fold(0.0f64, |most, s| most.max(s.abs()));
    row(
        "initial",
        "stress left of an initial one that is released, relative",
        left / pressure_pa,
        AtMost(1e-8),
    );
}
