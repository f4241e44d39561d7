//! A block hangs by its joint: settling leaves it there up to the strength, however it swings on the way, and lets it go beyond.

use ndda_solver::{Damping, Settle, StepError};

use crate::evidence::Answer::{AtLeast, AtMost};
use crate::evidence::row;
use crate::simulation;

const DENSITY_KG_M3: f64 = 2600.0;
const GRAVITY_M_S2: f64 = 9.81;

/// A cube of a metre under a held one, of which the joint carries its weight over `used` of the strength.
fn hang(body: &str, damping: Damping, used: f64) -> Result<(), StepError> {
    let tension_pa = DENSITY_KG_M3 * GRAVITY_M_S2 / used;
    let mut simulation = simulation(&format!(
        "(title: \"hang\", time: (step_s: 1e-4, end_s: 1), gravity_m_s2: (0, 0, -{GRAVITY_M_S2}),
          materials: [(name: \"rock\", young_pa: 20e9, poisson: 0.25, density_kg_m3: {DENSITY_KG_M3})],
          blocks: [
              (name: \"roof\", material: \"rock\", body: Fixed, shape: Box(size_m: (2, 2, 1), cells: (1, 1, 1)), at_m: (-1, -1, 1)),
              (name: \"block\", material: \"rock\", body: {body}, shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)), at_m: (-0.5, -0.5, 0)),
          ],
          contact: Potential(penalty_pa: 2e8, potential: Smooth(),
              friction: (friction_deg: 30, shear_penalty_pa_m: 1e9, cohesion_pa: 1e6, tension_pa: {tension_pa:e})))"
    ));
    simulation.settle(&Settle { damping: Some(damping), ..Settle::new(1e-4, 20_000) }).map(drop)
}

#[test]
fn a_block_hangs_by_its_joint_up_to_its_strength_however_it_is_damped_on_the_way() {
    let local = Damping::Local { factor: 0.8 };
    let (mut most, mut least) = (0.0f64, f64::INFINITY);
    for body in ["Rigid", "Elastic"] {
        for damping in [Damping::Kinetic, Damping::Adaptive, local] {
            for used in [0.6, 0.9, 0.98, 1.02, 1.1] {
                match hang(body, damping, used) {
                    Ok(()) => most = most.max(used),
                    Err(StepError::NotSettled { overloaded_bonds, .. }) => {
                        assert!(overloaded_bonds > 0, "{body} {damping:?} {used}");
                        least = least.min(used);
                    }
                    Err(error) => panic!("{error}"),
                }
            }
        }
    }
    row(
        "bonds at rest",
        "largest weight over strength with which it hangs, of 0.6 to 1.1",
        most,
        AtMost(1.0),
    );
    row(
        "bonds at rest",
        "least weight over strength with which it falls, of 0.6 to 1.1",
        least,
        AtLeast(1.0),
    );
}
