//! Energies and momenta at one instant.

use ndda_mesh::Vec3;
use serde::{Deserialize, Serialize};

/// Vibrations of a block that a step turns over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Vibration {
    /// Their speed [m/s].
    pub speed_m_s: f64,
    /// Scale beside which they are small, whatever moves: see [`BlockDiagnostics::strain_speed2`] [m²/s²].
    pub borne_m2_s2: f64,
}

impl Vibration {
    /// Over the largest speed and the block's elastic scale.
    pub(crate) fn over(&self, largest_m_s: f64) -> f64 {
        if self.speed_m_s == 0.0 {
            0.0
        } else {
            self.speed_m_s / (largest_m_s * largest_m_s + self.borne_m2_s2).sqrt()
        }
    }
}

/// Energies and momenta of all blocks at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Steps done.
    pub step: u64,
    /// Time [s].
    pub time_s: f64,
    /// ½ vᵀ M v [J].
    pub kinetic_j: f64,
    /// Elastic energy of the blocks, that of initial stress included [J].
    pub strain_j: f64,
    /// Potential energy of normal contact [J].
    pub contact_j: f64,
    /// Potential of constant loads: gravity, tractions and forces, zero at the start [J].
    pub load_j: f64,
    /// Energy of support springs [J].
    pub spring_j: f64,
    /// Work of friction since the start, negative when it dissipates [J].
    pub friction_work_j: f64,
    /// Work of prescribed motions since the start [J].
    pub motion_work_j: f64,
    /// Work of loads that change over time since the start [J].
    pub load_work_j: f64,
    /// Work of damping since the start, never positive [J].
    pub damping_work_j: f64,
    /// Energy that left through quiet faces since the start, never negative [J].
    pub radiated_j: f64,
    /// Work of contact damping since the start: what contacts with a restitution below 1 do not give back, never positive [J].
    pub restitution_work_j: f64,
    /// Energy of blocks that stages have taken out, and of their contact, less that of blocks added, since the start [J].
    pub removed_j: f64,
    /// Energy stored in bolts [J].
    pub bolt_j: f64,
    /// Work of yielding, slip and breaks of bolts since the start, never positive [J].
    pub bolt_work_j: f64,
    /// Energy that appeared (+) or vanished (−) without a cause since the start [J].
    pub balance_j: f64,
    /// Linear momentum [kg m/s].
    pub momentum: Vec3,
    /// Angular momentum about the place that nodes are relative to, [`BlockSet::origin_m`](ndda_mesh::BlockSet::origin_m) [kg m²/s]; that about the origin of the scene is
    /// [`Simulation::angular_momentum_of_scene`](crate::Simulation::angular_momentum_of_scene).
    pub angular_momentum: Vec3,
    /// Σ m |v| [kg m/s].
    pub momentum_scale: f64,
    /// Σ m |x| |v| [kg m²/s].
    pub angular_scale: f64,
    /// Smallest det F over all elements, with the index of the element.
    pub smallest_volume_ratio: (f64, usize),
}

impl Sample {
    /// Kinetic + strain + contact + load + spring + bolt energy [J].
    pub fn total_j(&self) -> f64 {
        self.kinetic_j + self.strain_j + self.contact_j + self.load_j + self.spring_j + self.bolt_j
    }
}
