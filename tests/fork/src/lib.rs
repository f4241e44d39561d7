//! Parts that a program of other people brings to ndda, one file each.

pub mod exponential_pressure;
pub mod grid_broad_phase;
pub mod hardening_material;
pub mod point_springs;
pub mod quadratic_potential;
pub mod rate_and_state;
pub mod slip_weakening;
pub mod sparse_solver;

use std::sync::Arc;

use ndda::build::Choices;

/// Names of all parts, as the command line takes them.
pub const PARTS: [&str; 8] = [
    "quadratic-potential",
    "exponential-pressure",
    "slip-weakening",
    "rate-and-state",
    "grid",
    "sparse-solver",
    "hardening-rock",
    "point-springs",
];

/// The part with this name in the place of what a scene names.
pub fn choices(part: &str) -> Option<Choices> {
    let scene = Choices::default();
    Some(match part {
        "quadratic-potential" => {
            Choices { potential: Some(Box::new(quadratic_potential::QuadraticPotential)), ..scene }
        }
        "exponential-pressure" => Choices {
            potential: Some(Box::new(exponential_pressure::ExponentialPressure {
                reference_m: 1.0,
                softness_m: 1e-3,
            })),
            ..scene
        },
        "slip-weakening" => Choices {
            friction: Some(Box::new(slip_weakening::SlipWeakening {
                shear_penalty_pa_m: 2e10,
                static_friction: 0.75,
                dynamic_friction: 0.6,
                weakening_m: 5e-3,
                healing_s: 1.0,
            })),
            ..scene
        },
        "rate-and-state" => Choices {
            friction: Some(Box::new(rate_and_state::RateAndState {
                shear_penalty_pa_m: 2e10,
                friction: 0.6,
                direct: 0.01,
                evolution: 0.015,
                slip_m: 1e-4,
                velocity_m_s: 1e-6,
            })),
            ..scene
        },
        "grid" => Choices { broad_phase: Some(Box::<grid_broad_phase::Grid>::default()), ..scene },
        "sparse-solver" => Choices { solver: Some(Box::new(sparse_solver::SparseLlt)), ..scene },
        "hardening-rock" => {
            let rock = hardening_material::HardeningRock::new(2650.0, 20e9, 0.25, 1e-7);
            Choices { materials: vec![("rock".into(), Arc::new(rock))], ..scene }
        }
        "point-springs" => {
            let springs = point_springs::PointSprings { stiffness_n_m: 1e8, reach_m: 1.0 };
            Choices { contact: Some(Box::new(springs)), ..scene }
        }
        _ => return None,
    })
}
