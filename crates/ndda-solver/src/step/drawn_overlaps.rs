//! Blocks that overlap as they are drawn: contact pushes them apart with an energy that nobody has put in.

use ndda_contact::PairResultant;
use ndda_mesh::Vec3;

use crate::bodies::kind::BodyKind;
use crate::diagnostics::worst::Worst;
use crate::step::Simulation;

/// All contact of one block at the start.
#[derive(Clone, Copy, Default)]
struct Pressed {
    /// Resultant on it [N], and the sum of the sizes of its parts.
    force: Vec3,
    force_n: f64,
    /// ½ F d of all its pairs [J].
    energy_j: f64,
}

impl Simulation {
    /// Notes the largest speed at which overlaps at the start throw a free block [m/s], for the label. Of the energy E = Σ ½ F d of its pairs,
    /// d being their depths, a block may gain (ΔF/Σ F)² E, where ΔF is by how much contact exceeds what loads press against it: none where it lies as
    /// deep as contact carries it.
    pub fn note_drawn_overlaps(&mut self, pairs: &[PairResultant]) {
        let mut pressed = vec![Pressed::default(); self.problem.blocks.len()];
        for pair in pairs {
            let (force_n, depth_m) = (pair.force_n.norm(), pair.depth_m.max(0.0));
            for (block, sign) in [(pair.first, 1.0), (pair.second, -1.0)] {
                let of = &mut pressed[block.index()];
                of.force += sign * pair.force_n;
                of.force_n += force_n;
                of.energy_j += 0.5 * force_n * depth_m;
            }
        }
        let mut worst = Worst::default();
        for (block, Pressed { force, force_n, energy_j }) in self.problem.blocks.ids().zip(pressed) {
            let shape = self.shape(block);
            if shape.kind == BodyKind::Fixed || !shape.is_free() || force == Vec3::zeros() {
                continue;
            }
            let load: Vec3 = self.loads.total()[self.problem.blocks.nodes_of(block)].iter().sum();
            let excess_n = (force + load).dot(&force.normalize()).clamp(0.0, force_n);
            let gained_j = energy_j * (excess_n / force_n).powi(2);
            worst.take((2.0 * gained_j / shape.operator.mass_kg).sqrt(), block.index());
        }
        self.audit.ledger.note_drawn_overlaps(worst);
    }
}
