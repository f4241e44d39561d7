//! The ledger of a run: energy and momentum balance, and the worst of everything that has a limit.

mod control;
mod stages;
mod work;

use crate::diagnostics::energies::Sample;
use crate::diagnostics::energies::Vibration;
use crate::diagnostics::invariants::Invariants;
use ndda_mesh::{BlockId, Vec3};
use serde::{Deserialize, Serialize};

use crate::diagnostics::block_diagnostics::BlockDiagnostics;
use crate::diagnostics::worst::Worst;
use crate::integrators::time_integrator::StepWeights;
use crate::step::report::StepReport;
use crate::step::unsettled::Unsettled;

/// Strain below which the search is skipped: a tenth of the limit of a linear law.
const LITTLE_STRAIN: f64 = 1e-2;

/// Part of the largest speed of which it does not matter how much turns over in a step.
const LITTLE: f64 = 1e-3;

/// Part of the error of damping of contact that is left after a step.
const DASHPOTS_KEPT: f64 = 0.98;

/// Sums over steps and extremes over samples.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    start: Option<Sample>,
    impulse: Vec3,
    angular_impulse: Vec3,
    last_force: (Vec3, Vec3),
    load_n: f64,
    load_impulse: f64,
    friction_work_j: f64,
    motion_work_j: f64,
    load_work_j: f64,
    damping_work_j: f64,
    radiated_j: f64,
    restitution_work_j: f64,
    /// Least of it so far, and by how much it has grown again at most [J].
    least_restitution_work_j: f64,
    damping_gain_j: f64,
    /// Largest work of friction [J]; none where its springs may give back what they took before the run.
    friction_gain_j: Option<f64>,
    removed_j: f64,
    peak_energy_j: f64,
    /// Largest energy that blocks, contacts, springs and bolts stored [J].
    peak_stored_j: f64,
    peak_momentum: f64,
    peak_angular: f64,
    largest_gain_j: f64,
    largest_loss_j: f64,
    lasting_gain_j: f64,
    lasting_loss_j: f64,
    momentum_error: f64,
    angular_error: f64,
    largest_speed_m_s: f64,
    /// Speed of blocks that hardly move: that of a fall through 1/20 000 of their smallest size [m/s].
    slow_m_s: f64,
    vibration: Vibration,
    unresolved_m_s: f64,
    damping_m_s: f64,
    /// By how much damping of contact that steps leave out lets blocks go too fast [m/s]; it fades, as damping stops what is left of it.
    dashpot_m_s: f64,
    rounding_j: f64,
    last_sample_s: f64,
    blocks: BlockDiagnostics,
    worst: Invariants,
}

impl Ledger {
    /// An empty ledger of some blocks; `start` is the force and torque from outside before the first step, zero unless the integrator remembers
    /// accelerations [N, N m]; `slow_m_s` is the speed below which blocks hardly move.
    pub(crate) fn new(start: (Vec3, Vec3), blocks: BlockDiagnostics, slow_m_s: f64) -> Self {
        let worst = Invariants { smallest_volume_ratio: 1.0, ..Invariants::default() };
        Self {
            start: None,
            impulse: Vec3::zeros(),
            angular_impulse: Vec3::zeros(),
            last_force: start,
            load_n: 0.0,
            load_impulse: 0.0,
            friction_work_j: 0.0,
            motion_work_j: 0.0,
            load_work_j: 0.0,
            damping_work_j: 0.0,
            radiated_j: 0.0,
            restitution_work_j: 0.0,
            least_restitution_work_j: 0.0,
            damping_gain_j: 0.0,
            friction_gain_j: Some(0.0),
            removed_j: 0.0,
            peak_energy_j: 0.0,
            peak_stored_j: 0.0,
            peak_momentum: 0.0,
            peak_angular: 0.0,
            largest_gain_j: 0.0,
            largest_loss_j: 0.0,
            lasting_gain_j: 0.0,
            lasting_loss_j: 0.0,
            momentum_error: 0.0,
            angular_error: 0.0,
            largest_speed_m_s: 0.0,
            slow_m_s,
            vibration: Vibration::default(),
            unresolved_m_s: 0.0,
            damping_m_s: 0.0,
            dashpot_m_s: 0.0,
            rounding_j: 0.0,
            last_sample_s: 0.0,
            blocks,
            worst,
        }
    }

    /// Books an impulse and a moment of impulses about the origin as they are [kg m/s, kg m²/s].
    pub(crate) fn add_whole_impulse(&mut self, linear: Vec3, angular: Vec3) {
        self.impulse += linear;
        self.angular_impulse += angular;
    }

    /// Books force and torque from outside over a step, as the integrator weights them.
    pub(crate) fn add_impulse(&mut self, dt_s: f64, weights: &StepWeights, force: Vec3, torque: Vec3) {
        let (old_force, old_torque) = self.last_force;
        let (force, torque) = (weights.inertia(&force, &old_force), weights.inertia(&torque, &old_torque));
        self.impulse += dt_s * weights.mean_inertia(&old_force, &force);
        self.angular_impulse += dt_s * weights.mean_inertia(&old_torque, &torque);
        self.last_force = (force, torque);
        self.load_impulse += dt_s * self.load_n;
    }

    /// Notes that loads jump between two steps: integrators that remember forces begin the next one with those after the jump.
    /// Their moment about the mass centre is zero.
    pub(crate) fn note_jump(&mut self, force_n: Vec3) {
        self.last_force.0 += force_n;
    }

    /// Books impulse and angular impulse on a block beside the forces, and the error of velocities that damping leaves in the step
    /// [m/s].
    pub(crate) fn add_impulses(&mut self, impulse: Vec3, angular_impulse: Vec3, error_m_s: f64) {
        self.impulse += impulse;
        self.angular_impulse += angular_impulse;
        self.damping_m_s = self.damping_m_s.max(error_m_s);
    }

    /// Whether a first sample has opened the balance.
    pub(crate) fn is_open(&self) -> bool {
        self.start.is_some()
    }

    /// The largest energy so far [J].
    pub(crate) fn peak_energy_j(&self) -> f64 {
        self.peak_energy_j
    }

    /// The size of all loads now [N].
    pub(crate) fn watch_load(&mut self, load_n: f64) {
        self.load_n = load_n;
    }

    /// Diagnostics of single blocks.
    pub(crate) fn blocks(&mut self) -> &mut BlockDiagnostics {
        &mut self.blocks
    }

    /// Number of blocks.
    pub(crate) fn block_count(&self) -> usize {
        self.blocks.len()
    }

    /// Time since the last sample [s].
    pub(crate) fn since_sample_s(&self, time_s: f64) -> f64 {
        time_s - self.last_sample_s
    }

    /// A part of what vibrations are held against that would be nothing new.
    pub(crate) fn known_vibration(&self, die_out: bool) -> f64 {
        if die_out { LITTLE } else { self.vibration.over(self.largest_speed_m_s).max(LITTLE) }
    }

    /// Largest speed of a node so far [m/s].
    pub(crate) fn largest_speed_m_s(&self) -> f64 {
        self.largest_speed_m_s
    }

    /// Speed that errors of block velocities are held against [m/s]: the largest so far, or that of blocks that hardly move.
    pub(crate) fn speed_scale_m_s(&self) -> f64 {
        self.largest_speed_m_s.max(self.slow_m_s)
    }

    /// Speed below which a block that supports alone hold is at rest; zero for others [m/s].
    pub(crate) fn rest_speed_m_s(&self, block: BlockId) -> f64 {
        self.blocks.rest_speed_m_s(block)
    }

    /// Most that steps may have left of loads along the way of a block: of its velocity over the speed scale, and of its place over its smallest height.
    pub(crate) fn free_load_errors(&self, block: BlockId) -> (f64, f64) {
        self.blocks.free_loads_of(block, self.speed_scale_m_s())
    }

    /// Keeps the block that settling has left farthest from rest.
    pub(crate) fn note_unsettled(&mut self, found: Unsettled) {
        if found.over(0.0) > self.worst.unsettled.over(0.0) {
            self.worst.unsettled = found;
        }
    }

    /// Keeps the largest speed at which overlaps as drawn throw a block [m/s].
    pub(crate) fn note_drawn_overlaps(&mut self, thrown: Worst) {
        self.worst.drawn_overlap_m_s = thrown;
    }

    /// Keeps vibrations that a step turns over: the worst, or the last where they die out.
    pub(crate) fn watch_vibration(&mut self, found: Vibration, die_out: bool) {
        let speed_m_s = self.largest_speed_m_s;
        if die_out || found.over(speed_m_s) > self.vibration.over(speed_m_s) {
            self.vibration = found;
        }
    }

    /// The largest strain so far, or one that does not matter.
    pub(crate) fn largest_strain(&self) -> f64 {
        self.worst.largest_strain.value.max(LITTLE_STRAIN)
    }

    /// Keeps the largest strain, if it matters.
    pub(crate) fn watch_strain(&mut self, strain: f64, block: BlockId) {
        if strain > LITTLE_STRAIN {
            self.worst.largest_strain.take(strain, block.index());
        }
    }

    /// Energy that rounding alone may have brought [J].
    pub(crate) fn rounding_j(&self) -> f64 {
        self.rounding_j
    }

    /// Keeps the largest energy that rounding alone may have brought by now [J].
    pub(crate) fn watch_rounding(&mut self, energy_j: f64) {
        self.rounding_j = self.rounding_j.max(energy_j);
    }

    /// Sum of the sizes of all impulses of loads and supports so far, whether they balance or not [N s].
    pub(crate) fn load_impulse(&self) -> f64 {
        self.load_impulse
    }

    /// Loads that balance round in proportion to their moments about the origin, at most those of all of them as far from it as the farthest node.
    pub(crate) fn watch_farthest(&mut self, farthest_m: f64) {
        self.peak_angular = self.peak_angular.max(self.load_impulse * farthest_m);
    }

    /// Keeps the largest of all speeds, and of those that came and went within a step [m/s].
    pub(crate) fn watch_speeds(&mut self, speed_m_s: f64, unresolved_m_s: f64) {
        self.largest_speed_m_s = self.largest_speed_m_s.max(speed_m_s);
        self.unresolved_m_s = self.unresolved_m_s.max(unresolved_m_s);
    }

    /// Keeps the extremes of a step.
    pub(crate) fn watch(&mut self, report: &StepReport) {
        let (worst, contact) = (&mut self.worst, &report.contact);
        worst.max_penetration_ratio = worst.max_penetration_ratio.max(contact.max_penetration_ratio);
        worst.bond_overload = worst.bond_overload.max(contact.bond_overload);
        worst.friction_left_m_s += contact.friction_left_m_s;
        self.dashpot_m_s = contact.dashpot_error_m_s.max(DASHPOTS_KEPT * self.dashpot_m_s);
        worst.action_reaction = worst.action_reaction.max(contact.action_reaction_error.unwrap_or(0.0));
        worst.candidate_pairs_max = worst.candidate_pairs_max.max(contact.candidate_pairs);
        worst.contact_pairs_max = worst.contact_pairs_max.max(contact.contact_pairs);
        worst.candidate_pairs_total += contact.candidate_pairs as u64;
        worst.contact_pairs_total += contact.contact_pairs as u64;
        worst.max_h = worst.max_h.max(report.h);
        worst.max_travel.take(report.travel.value, report.travel.block as usize);
        worst.iterations_max = worst.iterations_max.max(report.iterations.newton);
    }

    /// Balances a sample against the ledger and keeps the extremes; the first sample opens the balance.
    ///
    /// Where contact is explicit and stable, what it keeps is v² (1 − h²/4)/2 + ω² x²/2: up to h²/4 of its own energy is
    /// missing while blocks are pressed, and comes back when they part. `explicit_contact` says that it is.
    pub(crate) fn balance(&mut self, mut sample: Sample, explicit_contact: bool) -> Sample {
        let start = *self.start.get_or_insert(sample);
        sample.friction_work_j = self.friction_work_j;
        sample.motion_work_j = self.motion_work_j;
        sample.load_work_j = self.load_work_j;
        sample.damping_work_j = self.damping_work_j;
        sample.radiated_j = self.radiated_j;
        sample.restitution_work_j = self.restitution_work_j;
        sample.removed_j = self.removed_j;
        let work_j = sample.friction_work_j
            + sample.motion_work_j
            + sample.load_work_j
            + sample.damping_work_j
            + sample.restitution_work_j
            - sample.radiated_j
            - sample.removed_j
            + (sample.bolt_work_j - start.bolt_work_j);
        sample.balance_j = sample.total_j() - start.total_j() - work_j;
        let stored_j = sample.strain_j.abs() + sample.contact_j + sample.spring_j + sample.bolt_j;
        self.peak_stored_j = self.peak_stored_j.max(stored_j);
        self.peak_energy_j = self.peak_energy_j.max(sample.kinetic_j + stored_j).max(sample.load_j.abs());
        self.largest_gain_j = self.largest_gain_j.max(sample.balance_j);
        self.largest_loss_j = self.largest_loss_j.max(-sample.balance_j);
        let h = if explicit_contact { self.worst.max_h } else { 0.0 };
        let comes_back_j = 0.25 * h * h * (sample.contact_j + sample.bolt_j);
        self.blocks.balance(0.25 * h * h);
        self.last_sample_s = sample.time_s;
        self.lasting_gain_j = self.lasting_gain_j.max(sample.balance_j - comes_back_j);
        self.lasting_loss_j = self.lasting_loss_j.max(-sample.balance_j - comes_back_j);
        // The exchange of supports and loads rounds in proportion to its size, however little it leaves to move.
        self.peak_momentum = self.peak_momentum.max(sample.momentum_scale).max(self.load_impulse);
        self.peak_angular = self.peak_angular.max(sample.angular_scale);
        let momentum_error = (sample.momentum - start.momentum - self.impulse).norm();
        let turn_error = (sample.angular_momentum - start.angular_momentum - self.angular_impulse).norm();
        self.momentum_error = self.momentum_error.max(momentum_error);
        self.angular_error = self.angular_error.max(turn_error);
        let ratio = sample.smallest_volume_ratio.0;
        self.worst.smallest_volume_ratio = self.worst.smallest_volume_ratio.min(ratio);
        sample
    }

    /// The worst of the run so far.
    pub(crate) fn invariants(&self) -> Invariants {
        let over = |value: f64, scale: f64| if value == 0.0 { 0.0 } else { value / scale };
        // Where nothing had a momentum, what loads and supports leave of each other is rounding.
        let kept = |error: f64, scale: f64| if scale > 0.0 { error / scale } else { 0.0 };
        let of_energy = |value_j: f64, scale_j: f64| over((value_j - self.rounding_j).max(0.0), scale_j);
        let energy = |value_j: f64| of_energy(value_j, self.peak_energy_j);
        // A base that is moved gives its blocks an energy that says nothing of how they vibrate on it.
        let damped_j = if self.motion_work_j == 0.0 { self.peak_energy_j } else { self.peak_stored_j };
        let scale_m_s = self.speed_scale_m_s();
        let (block_gain, block_loss) = self.blocks.lasting(scale_m_s, self.rounding_j);
        let (lateral_drift_speed, lateral_drift_place) =
            self.blocks.lateral_drift(scale_m_s, self.rounding_j);
        let (creep_speed, creep_place) = self.blocks.creep(scale_m_s);
        let (growing_hops, chattering_hops) = self.blocks.hops(self.largest_speed_m_s, self.rounding_j);
        let (rebound_speed, rebound_speed_on_a_plane) = self.blocks.rebound(scale_m_s, self.rounding_j);
        let (free_speed, free_place) = self.blocks.free_loads(scale_m_s, self.rounding_j);
        let (lumped_speed, lumped_place) = self.blocks.lumped(scale_m_s, self.rounding_j);
        let speed = |value_m_s: f64| over(value_m_s, self.largest_speed_m_s.max(value_m_s));
        Invariants {
            linear_momentum: kept(self.momentum_error, self.peak_momentum),
            angular_momentum: kept(self.angular_error, self.peak_angular),
            energy_gain: energy(self.largest_gain_j),
            energy_loss: energy(self.largest_loss_j),
            lasting_gain: energy(self.lasting_gain_j),
            damping_gain: of_energy(self.damping_gain_j, damped_j),
            lasting_loss: energy(self.lasting_loss_j),
            friction_gain: energy(self.friction_gain_j.unwrap_or(0.0)),
            block_gain,
            block_loss,
            unresolved_friction: self.blocks.unresolved_friction(scale_m_s, self.rounding_j),
            lateral_drift_speed,
            lateral_drift_place,
            creep_speed,
            creep_place,
            growing_hops,
            chattering_hops,
            hops_with_friction: self.blocks.hops_with_friction(self.largest_speed_m_s, self.rounding_j),
            squeezes: self.blocks.squeezes(self.rounding_j),
            second_impact: self.blocks.second_impact(scale_m_s, self.rounding_j),
            impact: self.blocks.impact(scale_m_s, self.rounding_j),
            free_speed,
            free_place,
            rebound_speed,
            rebound_speed_on_a_plane,
            lumped_speed,
            lumped_place,
            turn_place: self.blocks.turned_over_height(),
            turn_speed: over(self.blocks.turned_m_s(), scale_m_s.max(self.blocks.turned_m_s())),
            kept_turn_place: self.blocks.kept_turn().place,
            kept_turn_speed: self.blocks.kept_turn().speed(scale_m_s),
            ringing: self.blocks.ringing(scale_m_s, self.rounding_j),
            vibration: self.vibration.over(self.largest_speed_m_s),
            unresolved_speed: speed(self.unresolved_m_s),
            damping_speed: speed(self.damping_m_s),
            contact_damping_speed: over(self.dashpot_m_s, scale_m_s.max(self.dashpot_m_s)),
            ..self.worst
        }
    }
}

#[cfg(test)]
mod tests;
