//! Blocks that are far from rest although their scene is at rest: it is judged by the energy of all blocks, in which a small one beside a large one does not count.

use serde::{Deserialize, Serialize};

use crate::bodies::kind::BodyKind;
use crate::step::Simulation;

/// Blocks hardly move below this part of the speed √(g h).
const HARDLY: f64 = 0.01;

/// The block that settling has left farthest from rest, by its own measure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Unsettled {
    /// Index of the block.
    pub block: u32,
    /// Speed that the force which does not balance gives it [m/s].
    pub speed_m_s: f64,
    /// 0.01 √(g h) of the block, below which it hardly moves [m/s].
    pub slow_m_s: f64,
}

impl Unsettled {
    /// Its speed over that of the run [m/s], or over that below which it hardly moves, if this is more.
    pub fn over(&self, largest_m_s: f64) -> f64 {
        if self.speed_m_s > 0.0 { self.speed_m_s / largest_m_s.max(self.slow_m_s) } else { 0.0 }
    }
}

impl Simulation {
    /// The block that the last step leaves farthest from rest. A force R that does not balance makes a block oscillate at R/(m ω): with a bound of ω of its contact, which has it
    /// move more slowly than it does, or where nothing touches it with √(g/h), as a block oscillates that water carries.
    pub(super) fn least_settled(&self) -> Unsettled {
        let gravity_m_s2 = self.problem.gravity_m_s2.norm();
        let mut worst = Unsettled::default();
        for (block, body) in self.problem.blocks.ids().zip(&self.bodies) {
            let (shape, drive) = (&self.problem.shapes[body.shape], &body.report.drive);
            let may_move = shape.kind != BodyKind::Fixed && shape.is_free() && !self.is_absent(block);
            if !may_move || gravity_m_s2 == 0.0 {
                continue;
            }
            // Its own inertia, where settling gives it another.
            let factor = self.whole_inertia_factor(block);
            let (left_m_s2, rate2) = match drive.touches {
                true => (drive.shift_m_s2, factor * drive.contact_rate2),
                false => (drive.free_m_s2[0], gravity_m_s2 / shape.smallest_height_m),
            };
            let found = Unsettled {
                block: block.index() as u32,
                speed_m_s: factor * left_m_s2.norm() / rate2.sqrt(),
                slow_m_s: HARDLY * (gravity_m_s2 * shape.smallest_height_m).sqrt(),
            };
            if found.over(0.0) > worst.over(0.0) {
                worst = found;
            }
        }
        worst
    }
}

#[cfg(test)]
mod tests {
    use ndda_mesh::{BlockId, Vec3};

    use super::*;
    use crate::step::settle::Settle;
    use crate::step::test_boxes::boxes;

    #[test]
    fn a_small_block_that_swings_beside_a_large_one_at_rest_is_named() {
        let base = (BodyKind::Fixed, [9.0, 9.0, 1.0], [-1.0, -1.0, -1.0]);
        let large = (BodyKind::Rigid, [2.0; 3], [0.0, 0.0, -1e-4]);
        let mut simulation = Simulation::new(boxes(&[base, large])).unwrap();
        simulation.settle(&Settle::new(1e-3, 100_000)).unwrap();
        let alone = simulation.invariants().unsettled;
        assert!(alone.over(0.0) < 0.01, "{alone:?}");
        // Nothing carries the small one, which falls from high above.
        let small = (BodyKind::Rigid, [1e-3; 3], [5.0, 5.0, 300.0]);
        let mut simulation = Simulation::new(boxes(&[base, large, small])).unwrap();
        simulation.settle(&Settle::new(1e-2, 100_000)).unwrap();
        let beside = simulation.invariants().unsettled;
        assert_eq!(BlockId(beside.block), BlockId(2));
        assert!(beside.over(0.0) > 10.0 && simulation.state().velocity[0] == Vec3::zeros(), "{beside:?}");
    }
}
