//! How exactly friction is found.

use ndda_mesh::BlockId;

use crate::friction::law_table::TOLERANCE;
use crate::friction::patches::patch::PatchSummary;
use crate::model::{Body, ContactInput};

/// Part of the largest friction on a block that does not matter where the solver compares forces of one evaluation with the next.
const ITERATED_TOLERANCE: f64 = 1e-8;
/// Patches from which on the tolerance grows with the square of their number, and how many times at most. Where thousands of patches hold each
/// other, each being about to slip, a hundred times as exact a search takes a hundred times as long; the next step goes on from what was found.
const MANY: f64 = 1000.0;
const MOST_OF_MANY: f64 = 100.0;
/// Change of a block's speed in a step that does not matter among so many patches, as a part of the largest speed of the moment: a ten thousandth of
/// what the label of a run promises. It is an error of slips, which the next step finds anew, and does not add up.
const SPEED: f64 = 1e-6;
/// Most that such a change may be of the largest friction on a block.
const MOST_OF_FRICTION: f64 = 1e-4;

/// Change of friction that does not matter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance {
    /// As a part of the largest friction on both blocks.
    part: f64,
    /// As an acceleration of the lighter block [m/s²], where that is more and still less than [`MOST_OF_FRICTION`].
    acceleration_m_s2: f64,
}

impl Tolerance {
    /// A part of the largest friction on both blocks.
    pub(super) fn of_friction(part: f64) -> Self {
        Self { part, acceleration_m_s2: 0.0 }
    }

    /// Of so many patches; `part` is that of the laws. A scene that comes to rest has a tolerance of its own, by its speed.
    pub(super) fn new(input: &ContactInput, part: f64, patches: usize) -> Self {
        if input.is_iterated {
            return Self::of_friction(ITERATED_TOLERANCE);
        }
        let (part, settles) = (part.max(input.friction_tolerance), input.friction_tolerance > 0.0);
        let many = (patches as f64 / MANY).powi(2).min(MOST_OF_MANY);
        if many <= 1.0 {
            return Self::of_friction(part);
        }
        let speed_m_s =
            input.bodies.iter().map(|body| body.velocity_m_s.norm_squared()).fold(0.0, f64::max).sqrt();
        let acceleration_m_s2 = if settles { 0.0 } else { SPEED * speed_m_s / input.dt_s };
        Self { part: part.max(many * TOLERANCE), acceleration_m_s2 }
    }

    /// Tells patches what change of their friction matters, by what else acts on both blocks: the lesser of both largest, which `most_n` is room for.
    pub(super) fn find(&self, patches: &mut [PatchSummary], bodies: &[Body], most_n: &mut Vec<f64>) {
        most_n.clear();
        most_n.resize(bodies.len(), 0.0);
        for patch in patches.iter().filter(|patch| patch.has_friction) {
            for block in [patch.owner.index(), patch.target.index()] {
                most_n[block] = most_n[block].max(patch.most_n);
            }
        }
        for patch in patches {
            let of = |block: BlockId| {
                let mass_kg = bodies[block.index()].mass_kg;
                let most_n = if mass_kg.is_infinite() { f64::INFINITY } else { most_n[block.index()] };
                (most_n, mass_kg)
            };
            let ((a_n, a_kg), (b_n, b_kg)) = (of(patch.owner), of(patch.target));
            let (most_n, mass_kg) = (a_n.min(b_n), a_kg.min(b_kg));
            patch.tolerance_n = self.part * most_n;
            if self.acceleration_m_s2 > 0.0 {
                let by_speed = self.acceleration_m_s2 * mass_kg;
                patch.tolerance_n = patch.tolerance_n.max(by_speed.min(MOST_OF_FRICTION * most_n));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Patches between a fixed block and two others, of 2 kg and 5 kg, with friction of 10 and 30 N.
    fn found(tolerance: &Tolerance) -> [f64; 2] {
        let patch = |target: u32, most_n: f64| PatchSummary {
            owner: BlockId(0),
            target: BlockId(target),
            has_friction: true,
            most_n,
            tolerance_n: 0.0,
        };
        let mut patches = [patch(1, 10.0), patch(2, 30.0)];
        let bodies = [f64::INFINITY, 2.0, 5.0].map(Body::at_rest);
        tolerance.find(&mut patches, &bodies, &mut Vec::new());
        patches.map(|patch| patch.tolerance_n)
    }

    #[test]
    fn what_matters_is_a_part_of_friction_or_of_the_speed_of_the_moment() {
        let of = |acceleration_m_s2| found(&Tolerance { part: 1e-6, acceleration_m_s2 });
        assert_eq!(of(0.0), [1e-6 * 10.0, 1e-6 * 30.0]);
        // By the speed, 2 kg · 1e-4 m/s² and 5 kg · 1e-4 m/s².
        assert_eq!(of(1e-4), [2.0 * 1e-4, 5.0 * 1e-4]);
        assert_eq!(of(1.0), [MOST_OF_FRICTION * 10.0, MOST_OF_FRICTION * 30.0]);
    }
}
