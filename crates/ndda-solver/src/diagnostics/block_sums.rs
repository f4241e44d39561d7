//! Sums over all blocks, which do not depend on the order of blocks.

use ndda_mesh::Vec3;
use ndda_ranks::ExactSum;

use crate::bodies::report::BlockReport;
use crate::diagnostics::energies::Sample;

/// The exact sum of some vectors, each component rounded once.
#[derive(Clone, Debug, Default)]
pub(crate) struct ExactVector([ExactSum; 3]);

impl ExactVector {
    /// Adds a vector.
    pub(crate) fn add(&mut self, addend: &Vec3) {
        self.0.iter_mut().zip(addend.iter()).for_each(|(sum, addend)| sum.add(*addend));
    }

    /// The sum.
    pub(crate) fn value(&self) -> Vec3 {
        Vec3::from_fn(|k, _| self.0[k].value())
    }

    fn clear(&mut self) {
        self.0.iter_mut().for_each(ExactSum::clear);
    }
}

/// Impulses and work of one step; their memory is kept from step to step.
#[derive(Debug, Default)]
pub(crate) struct StepSums {
    /// Force [N] and torque [N m] from outside, and the sum of how large forces are [N].
    pub force: ExactVector,
    pub torque: ExactVector,
    pub exchanged_n: ExactSum,
    /// Impulses beside the forces [N s, N m s].
    pub impulse: ExactVector,
    pub orbital: ExactVector,
    /// Work of friction, motions, loads and damping, and energy radiated [J].
    pub friction_j: ExactSum,
    pub motion_j: ExactSum,
    pub load_j: ExactSum,
    pub damping_j: ExactSum,
    pub radiated_j: ExactSum,
}

impl StepSums {
    /// Begins a step.
    pub(crate) fn clear(&mut self) {
        let Self { force, torque, impulse, orbital, .. } = self;
        [force, torque, impulse, orbital].into_iter().for_each(ExactVector::clear);
        let Self { exchanged_n, friction_j, motion_j, load_j, damping_j, radiated_j, .. } = self;
        let sums = [exchanged_n, friction_j, motion_j, load_j, damping_j, radiated_j];
        sums.into_iter().for_each(ExactSum::clear);
    }

    /// Adds what a block did in a part of a step that lasts `part_s`.
    pub(crate) fn add(&mut self, report: &BlockReport, part_s: f64) {
        self.force.add(&(report.reaction - report.motion_impulse / part_s));
        self.exchanged_n.add(report.reaction.norm());
        self.torque.add(&report.outside_torque);
        self.impulse.add(&report.motion_impulse);
        self.orbital.add(&report.orbital_impulse);
        self.friction_j.add(report.friction_work_j);
        self.motion_j.add(report.motion_work_j);
        self.load_j.add(report.load_work_j);
        self.damping_j.add(report.damping_work_j);
        self.radiated_j.add(report.radiated_j);
    }
}

/// Energies and momenta of all blocks.
#[derive(Debug, Default)]
pub(crate) struct SampleSums {
    pub kinetic_j: ExactSum,
    pub strain_j: ExactSum,
    pub spring_j: ExactSum,
    pub load_j: ExactSum,
    pub momentum: ExactVector,
    pub angular_momentum: ExactVector,
    pub momentum_scale: ExactSum,
    pub angular_scale: ExactSum,
}

impl SampleSums {
    /// Writes the sums into a sample.
    pub(crate) fn write(&self, sample: &mut Sample) {
        sample.kinetic_j = self.kinetic_j.value();
        sample.strain_j = self.strain_j.value();
        sample.spring_j = self.spring_j.value();
        sample.load_j = self.load_j.value();
        sample.momentum = self.momentum.value();
        sample.angular_momentum = self.angular_momentum.value();
        sample.momentum_scale = self.momentum_scale.value();
        sample.angular_scale = self.angular_scale.value();
    }
}

/// The exact sum over blocks of a function of the nodes of each, where block k has the nodes from `starts[k]` up to `starts[k + 1]`.
pub(crate) fn over_blocks(starts: &[u32], mut of_nodes: impl FnMut(std::ops::Range<usize>) -> f64) -> f64 {
    let of_block = |ends: &[u32]| of_nodes(ends[0] as usize..ends[1] as usize);
    starts.windows(2).map(of_block).collect::<ExactSum>().value()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_over_blocks_are_exact_and_forget_the_step_before() {
        let report = |friction_work_j: f64| BlockReport {
            friction_work_j,
            reaction: Vec3::new(friction_work_j, 0.0, -1.0),
            ..BlockReport::default()
        };
        let mut sums = StepSums::default();
        for _ in 0..2 {
            sums.clear();
            [1e30, 1.0, -1e30, 0.5].map(report).iter().for_each(|report| sums.add(report, 1e-3));
            assert_eq!((sums.friction_j.value(), sums.force.value()), (1.5, Vec3::new(1.5, 0.0, -4.0)));
        }
        assert_eq!(over_blocks(&[0, 1, 3, 3, 4], |nodes| [1e30, 1.0, 2.0, -1e30][nodes].iter().sum()), 3.0);
    }
}
