//! Neighbours of unlike mass, stiffness and size.

use ndda::forecast::step;
use ndda_solver::Settle;

use super::{advance, block, extreme, sunk};
use crate::evidence::Answer::{AtMost, Within};
use crate::evidence::row;

#[test]
fn a_slab_of_half_a_million_times_the_mass_sinks_as_deep_as_statics_says() {
    let mut simulation = extreme("heavy_on_light", &[]).simulation;
    simulation.sample().unwrap();
    for _ in 0..35 {
        advance(&mut simulation, 1000);
        simulation.sample().unwrap();
    }
    let depth = 2.5e6 * 9.8 * 0.25 / 2e10;
    let below = sunk(&simulation, "light", 0.0);
    let between = sunk(&simulation, "heavy", 0.5) - sunk(&simulation, "light", 0.5);
    row(
        "extreme: unlike masses",
        "depth of the light slab in the base, mass ratio 5e5 [m]",
        below,
        Within(depth, 1e-2),
    );
    row(
        "extreme: unlike masses",
        "depth of the heavy slab in the light one [m]",
        between,
        Within(depth, 1e-2),
    );
    row(
        "extreme: unlike masses",
        "energy gained over the peak",
        simulation.invariants().energy_gain,
        // The promise of the header of scenes/extreme/heavy_on_light.ron.
        AtMost(1e-2),
    );
}

#[test]
fn stiff_rock_on_soft_ground_bears_the_stress_of_springs_in_series() {
    let mut simulation = extreme("stiff_on_soft", &[]).simulation;
    simulation.settle(&Settle::new(1e-5, 100_000)).unwrap();
    let mut stress = vec![[0.0; 6]; simulation.blocks().tets.len()];
    simulation.recover_stress(&mut stress).unwrap();
    let series = 1e-3 / (1.0 / 200e9 + 1.0 / 200e3 + 1.0 / 2e6);
    for name in ["lower", "upper"] {
        let part = &stress[simulation.blocks().tets_of(block(&simulation, name))];
        let mean = -part.iter().map(|s| s[2]).sum::<f64>() / part.len() as f64;
        row(
            "extreme: unlike stiffness",
            &format!("stress of the {name} bar, modulus ratio 1e6 [Pa]"),
            mean,
            // It settled to 1e-5 of its largest speed, and swings by as much of its stress; tenfold. The header of scenes/extreme/stiff_on_soft.ron promises 2 %.
            Within(series, 1e-4),
        );
    }
}

#[test]
fn the_advised_step_is_that_of_the_smallest_block_and_will_do() {
    let mut ready = extreme("small_between_large", &[]);
    let advice = step::advise(&ready.loaded.scene, &mut ready.simulation).expect("there is contact");
    assert_eq!(advice.worst().block, "grain");
    let mut simulation =
        extreme("small_between_large", &[&format!("time.step_s={}", advice.step_s)]).simulation;
    simulation.sample().unwrap();
    let steps = (0.02 / advice.step_s) as u64;
    advance(&mut simulation, steps);
    row(
        "extreme: unlike sizes",
        "h at the step advised for a grain of 1 mm between 1 m",
        simulation.invariants().max_h,
        AtMost(2.0),
    );
    let mut simulation = ready.simulation;
    simulation.sample().unwrap();
    advance(&mut simulation, 4000);
    let grain = simulation.blocks().nodes_of(block(&simulation, "grain"));
    let velocity = &simulation.state().velocity[grain.clone()];
    let speed = (velocity.iter().map(|v| v.z).sum::<f64>() / grain.len() as f64).abs();
    row(
        "extreme: unlike sizes",
        "speed of the grain after it has flown to and fro [m/s]",
        speed,
        Within(0.1, 1e-2),
    );
}
