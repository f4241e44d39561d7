//! Blocks that turn though supports are taken to keep them from turning, so that their rotation is linear in the displacements.
//!
//! A turn by θ takes a node at r to r + θ × r instead of to its place on a circle, ½ θ² r away from that, and its velocity has the direction that it has at θ = 0.

use ndda_mesh::BlockId;
use serde::{Deserialize, Serialize};

use crate::diagnostics::worst::{BlockScale, Worst};

/// Largest errors of all blocks and samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct KeptTurn {
    /// ½ θ² r over the smallest height of the block's tetrahedra, r being its radius.
    pub place: Worst,
    /// θ ω r [m/s].
    speed_m_s: Worst,
}

impl KeptTurn {
    /// Takes an angle θ [rad] and a rate of rotation ω [rad/s] of a block.
    pub(crate) fn add(&mut self, block: BlockId, scale: &BlockScale, turn_rad: f64, spin_rad_s: f64) {
        let misplaced_m = 0.5 * turn_rad * turn_rad * scale.radius_m;
        self.place.take(misplaced_m / scale.height_m, block.index());
        self.speed_m_s.take(turn_rad * spin_rad_s * scale.radius_m, block.index());
    }

    /// The largest error of a velocity over the largest speed, or over itself where it is larger.
    pub(crate) fn speed(&self, speed_m_s: f64) -> Worst {
        let Worst { value, block } = self.speed_m_s;
        Worst { value: if value > 0.0 { value / speed_m_s.max(value) } else { 0.0 }, block }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_misplaces_by_half_its_square_and_turns_velocities_by_itself() {
        let scale = BlockScale { mass_kg: 1.0, is_held: true, deforms: true, radius_m: 2.0, height_m: 0.5 };
        let mut kept = KeptTurn::default();
        kept.add(BlockId(3), &scale, 0.1, 5.0);
        kept.add(BlockId(1), &scale, 0.05, 2.0);
        assert!((kept.place.value - 0.02).abs() < 1e-15 && kept.place.block == 3);
        assert!((kept.speed(10.0).value - 0.1).abs() < 1e-15 && kept.speed(0.5).value == 1.0);
        assert_eq!(KeptTurn::default().speed(0.0), Worst::default());
    }
}
