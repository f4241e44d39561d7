//! Work and energy that leave or enter.

use crate::diagnostics::block_sums::StepSums;
use crate::diagnostics::energies::Sample;
use crate::diagnostics::ledger::Ledger;
use crate::integrators::time_integrator::StepWeights;

impl Ledger {
    /// Books impulses and work of all blocks in a step of `dt_s`.
    pub(crate) fn add_sums(&mut self, sums: &StepSums, dt_s: f64, weights: &StepWeights) {
        self.watch_load(sums.exchanged_n.value());
        self.add_impulse(dt_s, weights, sums.force.value(), sums.torque.value());
        self.add_whole_impulse(sums.impulse.value(), sums.orbital.value());
        let StepSums { friction_j, motion_j, load_j, damping_j, radiated_j, .. } = sums;
        self.add_work(friction_j.value(), motion_j.value(), load_j.value(), damping_j.value());
        self.add_radiated(radiated_j.value());
    }

    /// Books the work of friction, of prescribed motions, of changing loads and of damping in a step [J].
    pub(crate) fn add_work(&mut self, friction_j: f64, motion_j: f64, load_j: f64, damping_j: f64) {
        self.friction_work_j += friction_j;
        self.friction_gain_j = self.friction_gain_j.map(|gain_j| gain_j.max(self.friction_work_j));
        self.motion_work_j += motion_j;
        self.load_work_j += load_j;
        self.damping_work_j += damping_j;
    }

    /// Notes that springs of friction, and bonds, are stretched already, so that their work may be positive.
    pub(crate) fn springs_are_stretched(&mut self) {
        self.friction_gain_j = None;
    }

    /// Books the energy that left through quiet faces in a step [J].
    pub(crate) fn add_radiated(&mut self, radiated_j: f64) {
        self.radiated_j += radiated_j;
    }

    /// Books what a change at once does to momentum and angular momentum, from samples before and after it.
    pub(crate) fn add_jump_of_momentum(&mut self, before: &Sample, after: &Sample) {
        let turn = after.angular_momentum - before.angular_momentum;
        self.add_whole_impulse(after.momentum - before.momentum, turn);
    }

    /// Books the work of contact damping in a step [J], which is not to give energy.
    pub(crate) fn add_restitution_work(&mut self, work_j: f64) {
        self.restitution_work_j += work_j;
        self.least_restitution_work_j = self.least_restitution_work_j.min(self.restitution_work_j);
        self.damping_gain_j =
            self.damping_gain_j.max(self.restitution_work_j - self.least_restitution_work_j);
    }
}
