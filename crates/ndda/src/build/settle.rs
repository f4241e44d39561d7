//! How a scene settles, for the solver.

use ndda_io::scene;
use ndda_solver::{Damping, Settle};

/// The scene's choice; with scaled masses where it leaves that open.
pub(crate) fn settle(settle: scene::Settle) -> Settle {
    let damping = settle.damping.map(|damping| match damping {
        scene::SettleDamping::Kinetic => Damping::Kinetic,
        scene::SettleDamping::Adaptive => Damping::Adaptive,
        scene::SettleDamping::Local { factor } => Damping::Local { factor },
    });
    Settle {
        tolerance: settle.tolerance,
        most_steps: settle.most_steps,
        damping,
        mass_scaling: settle.mass_scaling.unwrap_or(true),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;

    /// A cube that a bolt of 100 kN presses on a fixed base, at rest: how deep it lies [m], and the error of momentum in a hundred steps after.
    fn pressed(body: &str, damping: &str) -> (f64, f64) {
        let text = format!(
            "(title: \"bolt\", time: (step_s: 2e-5, end_s: 2e-3), settle: ({damping}),
             materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.2, density_kg_m3: 2500)],
             blocks: [(name: \"base\", material: \"rock\", body: Fixed, shape: Box(size_m: (3, 3, 2), cells: (1, 1, 1)), at_m: (-1, -1, -2)),
                      (name: \"cube\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (2, 2, 2)))],
             bolts: [(name: \"b\", at: Line(from_m: (0.5, 0.5, 1), to_m: (0.5, 0.5, -1)), steel: (young_pa: 2e11, area_m2: 1e-3),
                      grout: (stiffness_n_m2: 2e9, strength_n_m: 4e6, from_m: 1.2), plate: (), pretension_n: 1e5)],
             contact: Potential(potential: Smooth(), penalty_pa: 2e7, friction: (friction_deg: 30, shear_penalty_pa_m: 2e7)))"
        );
        let mut model = Model::from_text(&text).unwrap();
        let settle = settle(model.loaded.scene.settle.unwrap());
        let simulation = &mut model.simulation;
        let settled = simulation.settle(&settle);
        assert!(settled.is_ok(), "{body} {damping}: {settled:?}");
        let cube = simulation.blocks().ids().nth(1).unwrap();
        let nodes = simulation.blocks().nodes_of(cube);
        let lowest_m = simulation.state().position[nodes].iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
        let depth_m = -lowest_m - simulation.blocks().origin_m.z;
        for _ in 0..100 {
            simulation.step().unwrap();
        }
        (depth_m, simulation.invariants().linear_momentum)
    }

    #[test]
    fn a_bolt_presses_its_block_until_it_balances_contact_however_the_scene_comes_to_rest() {
        // The bolt has 100 kN at zero depth and is k_b = 1.32e8 N/m stiff, contact k_c = 4e7 N/m: 23.3 kN at (100 kN)/(k_b + k_c).
        for damping in ["damping: Local()", "damping: Adaptive", "damping: Kinetic"] {
            let (depth_m, momentum) = pressed("Rigid", damping);
            assert!((depth_m / 5.83e-4 - 1.0).abs() < 0.01, "{damping}: {depth_m:e} m");
            assert!(momentum < 1e-10, "{damping}: {momentum:e} of the largest momentum");
        }
    }

    #[test]
    fn an_elastic_block_rests_under_a_bolt_that_is_stiffer_than_contact() {
        // Masses are scaled for the bolt at the node where it acts, which consistent masses let oscillate faster than row sums say.
        let (depth_m, momentum) = pressed("Elastic", "");
        assert!((depth_m / 6.0e-4 - 1.0).abs() < 0.05, "{depth_m:e} m");
        assert!(momentum < 1e-10, "{momentum:e} of the largest momentum");
    }
}
