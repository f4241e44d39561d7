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
