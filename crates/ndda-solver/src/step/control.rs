//! Steps as short as they have to be.
//!
//! A step of the scene is done in 2ⁿ parts of Δt/2ⁿ. When a part violates a limit, the whole step is discarded
//! (contact history and ledger included) and repeated in twice as many; when half as many would do for some steps in a
//! row, half as many are tried. Time stays a count of steps, outputs fall where they fall, and a change of n costs one
//! factorisation per distinct block, once per n.
//!
//! The balance of energy costs more than a step, so it is evaluated only after steps that may have gained more than they are
//! allowed. Explicit contact takes its force f at x*, near the middle x + ½ Δx of a step; where f is linear, the work f·Δx differs from what
//! contact stores by e·K Δx with e = x* − x − ½ Δx. That is at most √(Σ s e²) √(Σ s Δx²), s being the row sums of |K|, and, as e is
//! ¼ Δt² times the acceleration, ¼ (ω_c Δt)² f·Δx where contact alone accelerates: the former is small where loads change slowly, the latter where
//! blocks move together. A first contact stores at most ⅛ (ω_c Δt)² m v² before its force has acted
//! (`Simulation::may_collide_with`). h bounds ω_c Δt, and the work of contact is known from the ledger. Where blocks vibrate in contact, such bounds are
//! hundreds of times what a step gains: what part of them steps gain is learnt where the balance is evaluated.

use crate::bodies::step_damping::StepDamping;
use crate::bodies::workspaces::Workspaces;
use crate::diagnostics::block_sums::over_blocks;
use crate::diagnostics::ledger::Ledger;
use crate::error::StepError;
use crate::linear::linear_solver::Factor;
use crate::step::report::StepReport;
use crate::step::state::{State, StepState};
use crate::step::{Scratch, Simulation};

/// When a step is too long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AutoStep {
    /// Part of the integrator's bound on h = ω_c Δt that a step may use.
    pub safety: f64,
    /// Energy that a step may gain over the largest energy so far.
    pub energy: f64,
    /// Halvings beyond which a run stops.
    pub most_halvings: u32,
}

/// Relative travel of two blocks that may meet in a part over the width of the thinner one.
const MOST_TRAVEL: f64 = 0.5;
/// Steps in a row that half as many parts would have done for, before half as many are tried.
const RELAX_STEPS: u32 = 4;
/// A halving that leaves more than this part of an energy error does not help against it: by chance, when a block comes
/// into contact early or late in a part, or because the step does not cause the error, and a shorter one would not reduce it.
const HELPS: f64 = 0.7;
/// Halvings in a row that do not help, after which the step counts as not causing the error.
const ENOUGH_TRIES: u32 = 3;
/// Steps that skip the energy criterion after halving failed to reduce the error.
const COOLDOWN_STEPS: u32 = 100;
/// Steps after which the balance of energy is evaluated in any case, for errors that are not of contact: at 1e-4 a step, as steps may
/// gain by default, these make less than the 2 % of energy that an accurate run may be off.
const BALANCED_STEPS: u64 = 128;
/// How far the error of a linear force may fall short of that of any other.
const NONLINEAR: f64 = 2.0;
/// A step is expected to gain at most this many times the part of its bound that the steps before it gained.
const LEARNT: f64 = 3.0;
/// Gains of earlier steps do not predict that of a step whose bound is more than this many times as large.
const GROWTH: f64 = 4.0;
/// Each time that the balance is evaluated, the remembered gain of earlier steps is multiplied by this factor.
const KEPT: f64 = 0.5;

impl StepState {
    /// Whether a step whose gain is bounded by so many times what it may gain may have gained more, by what is known of earlier ones.
    fn expects(&self, excess: f64) -> bool {
        excess > 1.0 && (excess > GROWTH * self.checked_excess || LEARNT * self.gained_part * excess > 1.0)
    }

    /// Takes over what a step with this bound gained or lost, over what it may gain.
    fn learn(&mut self, excess: Option<f64>, gained: f64) {
        if let Some(excess) = excess.filter(|excess| *excess > 0.0 && excess.is_finite()) {
            self.checked_excess = excess.max(KEPT * self.checked_excess);
            self.gained_part = (gained / excess).max(KEPT * self.gained_part);
        }
    }
}

/// Memory of the control.
pub(crate) struct Control {
    pub(super) settings: AutoStep,
    state: State,
    ledger: Ledger,
    /// Factors of the shapes that are not in use, by halvings.
    spare: Vec<Vec<Option<Factors>>>,
    /// Halvings that the factors in use are for.
    halvings: u32,
    /// The balance of energy after a step \[J\], and after which: it is that before the next.
    balance: Option<(u64, f64)>,
    /// Workspace for a ledger that is evaluated and dropped.
    spare_ledger: Ledger,
}

/// Factors of a shape for one length of step: that of the step, and that of the filter of velocities.
type Factors = (Box<dyn Factor>, Option<Box<dyn Factor>>);

/// Why a step has to be done again.
enum Rejection {
    /// A limit is exceeded by more than this factor.
    TooLong(f64),
    /// It gained this much energy over the largest so far.
    Energy(f64),
    /// It failed.
    Failed(StepError),
}

impl Control {
    pub(crate) fn new(settings: AutoStep, state: &State, ledger: &Ledger) -> Self {
        Self {
            settings,
            state: state.clone(),
            ledger: ledger.clone(),
            spare_ledger: ledger.clone(),
            spare: Vec::new(),
            halvings: 0,
            balance: None,
        }
    }

    /// The balance of energy after a step \[J\], and after which.
    pub(crate) fn balance(&self) -> Option<(u64, f64)> {
        self.balance
    }

    /// Drops the factors of a shape that are not in use, which are of no use any more.
    pub(crate) fn forget_factors(&mut self, shape: usize) {
        if let Some(spare) = self.spare.get_mut(shape) {
            spare.iter_mut().for_each(|factors| *factors = None);
        }
    }

    /// Takes over the balance that belongs to a restored state.
    pub(crate) fn restore_balance(&mut self, balance: Option<(u64, f64)>) {
        self.balance = balance;
    }
}

impl Simulation {
    /// One step of the scene in as many parts as it needs.
    pub(crate) fn controlled_step(&mut self, control: &mut Control) -> Result<StepReport, StepError> {
        self.use_halvings(control, self.state.control.halvings)?;
        if !self.audit.ledger.is_open() {
            control.balance = Some((self.state.step, self.sample()?.balance_j));
        }
        control.state.clone_from(&self.state);
        control.ledger.clone_from(&self.audit.ledger);
        let (mut last_gain, mut unhelpful) = (f64::INFINITY, 0);
        loop {
            let rejection = match self.try_parts(control) {
                Ok(report) => {
                    self.relax(&control.settings, &report);
                    return Ok(report);
                }
                Err(rejection) => rejection,
            };
            if let Rejection::Failed(error @ StepError::Ranks(_)) = rejection {
                return Err(error);
            }
            let halvings = self.state.control.halvings;
            let mut energy_check_cooldown = self.state.control.energy_check_cooldown;
            if let Rejection::Energy(gain) = rejection {
                unhelpful = if gain > HELPS * last_gain { unhelpful + 1 } else { 0 };
                last_gain = gain;
                // Not an error of the step: accept it, and skip the energy criterion for a while.
                if unhelpful == ENOUGH_TRIES {
                    energy_check_cooldown = COOLDOWN_STEPS;
                }
            }
            self.state.clone_from(&control.state);
            control.ledger.note_rejected();
            self.audit.ledger.clone_from(&control.ledger);
            // Only an error of energy is let pass; after any other rejection the same parts would be rejected again.
            let is_let_pass = matches!(rejection, Rejection::Energy(_)) && energy_check_cooldown > 0;
            if halvings >= control.settings.most_halvings && !is_let_pass {
                return Err(match rejection {
                    Rejection::Failed(error) => error,
                    Rejection::TooLong(_) | Rejection::Energy(_) => {
                        StepError::NoStepIsShortEnough { time_s: self.time_s(), step_s: self.part_s }
                    }
                });
            }
            let more = match rejection {
                Rejection::Energy(_) if is_let_pass => 0,
                // As many halvings as h requires, at once.
                Rejection::TooLong(times) if times.is_finite() => (times.log2().ceil() as u32).max(1),
                _ => 1,
            };
            self.state.control.energy_check_cooldown = energy_check_cooldown;
            let halvings = (halvings + more).min(control.settings.most_halvings);
            self.use_halvings(control, halvings)?;
        }
    }

    /// All parts of a step; stops at the first that violates a limit.
    fn try_parts(&mut self, control: &mut Control) -> Result<StepReport, Rejection> {
        let bound = self.contact_bound().map(|bound| control.settings.safety * bound);
        let mut worst = StepReport::default();
        for _ in 0..1u64 << self.state.control.halvings {
            let report = self.part_step().map_err(Rejection::Failed)?;
            worst = worst.joined(report);
            let times = bound.map_or(0.0, |bound| worst.h / bound).max(worst.travel.value / MOST_TRAVEL);
            if times > 1.0 {
                return Err(Rejection::TooLong(times));
            }
        }
        let excess = self.excess(&control.settings, &worst);
        if self.state.control.energy_check_cooldown > 0 || !self.may_have_gained(&control.settings, excess) {
            return Ok(worst);
        }
        let gain = self.gain_of_step(control).map_err(Rejection::Failed)?;
        self.state.control.learn(excess, gain.abs() / control.settings.energy);
        if gain > control.settings.energy { Err(Rejection::Energy(gain)) } else { Ok(worst) }
    }

    /// The most energy that linear contact may have gained in the step just done, over what a step may gain; none where nothing is known.
    fn excess(&self, settings: &AutoStep, report: &StepReport) -> Option<f64> {
        if self.contact_bound().is_none() || !self.weights.forces_do_their_work() {
            return None;
        }
        let limit_j = settings.energy * self.audit.ledger.peak_energy_j();
        let gained_j = 0.25 * report.h * report.h * report.contact_work_j;
        if NONLINEAR * gained_j <= limit_j {
            return Some(0.0);
        }
        Some(NONLINEAR * gained_j.min(self.contact_work_error_j()) / limit_j)
    }

    /// Whether the step just done may have gained more energy than it is allowed, by what is known without an evaluation of it.
    fn may_have_gained(&mut self, settings: &AutoStep, excess: Option<f64>) -> bool {
        let (Some(excess), Some(bound)) = (excess, self.contact_bound()) else { return true };
        let is_due = self.state.step.is_multiple_of(BALANCED_STEPS) || self.state.control.halvings > 0;
        if is_due || !self.state.contact.bonds.is_empty() || self.state.control.expects(excess) {
            return true;
        }
        let limit_j = settings.energy * self.audit.ledger.peak_energy_j();
        self.may_collide_with(settings.safety * bound, limit_j)
    }

    /// √(Σ s e²) √(Σ s Δx²): by how much the work of linear contact in the step just done may differ from what it stores, if anything touched [J].
    fn contact_work_error_j(&self) -> f64 {
        let (Scratch { contact_position, moved, contact_stiffness, .. }, State { position, .. }) =
            (&self.scratch, &self.state);
        let starts = self.problem.blocks.node_starts();
        let off_j = over_blocks(starts, |nodes| {
            let off = |n: usize| (contact_position[n] - position[n] + 0.5 * moved[n]).norm_squared();
            nodes.map(|n| contact_stiffness[n] * off(n)).sum()
        });
        let moved_j =
            over_blocks(starts, |nodes| nodes.map(|n| contact_stiffness[n] * moved[n].norm_squared()).sum());
        (off_j * moved_j).sqrt()
    }

    /// Energy that the step just done gained, over the largest so far.
    fn gain_of_step(&mut self, control: &mut Control) -> Result<f64, StepError> {
        let before_j = match control.balance {
            Some((step, balance_j)) if step == control.state.step => balance_j,
            _ => self.balance_before(control)?,
        };
        let after_j = self.sample()?.balance_j;
        let gain = (after_j - before_j) / self.audit.ledger.peak_energy_j();
        // A discarded step is repeated from its start.
        let is_taken_back = gain > control.settings.energy;
        let known = if is_taken_back { (control.state.step, before_j) } else { (self.state.step, after_j) };
        control.balance = Some(known);
        Ok(gain)
    }

    /// The balance of energy before the step just done \[J\]; nothing of its evaluation is kept.
    fn balance_before(&mut self, control: &mut Control) -> Result<f64, StepError> {
        control.spare_ledger.clone_from(&control.ledger);
        std::mem::swap(&mut self.state, &mut control.state);
        std::mem::swap(&mut self.audit.ledger, &mut control.spare_ledger);
        let found = self.sample();
        std::mem::swap(&mut self.state, &mut control.state);
        std::mem::swap(&mut self.audit.ledger, &mut control.spare_ledger);
        found.map(|sample| sample.balance_j)
    }

    /// Half as many parts next time, when they would have done for a while.
    fn relax(&mut self, settings: &AutoStep, report: &StepReport) {
        self.audit.ledger.note_halvings(self.state.control.halvings);
        let bound = self.contact_bound().map_or(f64::INFINITY, |bound| settings.safety * bound);
        let control = &mut self.state.control;
        control.energy_check_cooldown = control.energy_check_cooldown.saturating_sub(1);
        let would_do = 2.0 * report.h <= 0.9 * bound && 2.0 * report.travel.value <= MOST_TRAVEL;
        control.relax_streak = if would_do && control.halvings > 0 { control.relax_streak + 1 } else { 0 };
        if control.relax_streak >= RELAX_STEPS {
            control.relax_streak = 0;
            control.halvings -= 1;
        }
    }

    /// Makes weights and factors those of Δt/2ⁿ.
    fn use_halvings(&mut self, control: &mut Control, halvings: u32) -> Result<(), StepError> {
        self.state.control.halvings = halvings;
        if control.halvings == halvings {
            return Ok(());
        }
        self.part_s = self.problem.base_step_s * 0.5f64.powi(halvings as i32);
        self.weights = self.weights_of(self.part_s);
        let most = control.settings.most_halvings as usize + 1;
        control.spare.resize_with(self.problem.shapes.len(), || (0..most).map(|_| None).collect());
        for (index, spare) in control.spare.iter_mut().enumerate() {
            let shape = &mut self.problem.shapes[index];
            shape.damping = StepDamping::new(&shape.material.damping(), self.part_s, &self.weights);
            spare[control.halvings as usize] = shape.factor.take().map(|step| (step, shape.filter.take()));
            if let Some((step, filter)) = spare[halvings as usize].take() {
                (shape.factor, shape.filter) = (Some(step), filter);
                continue;
            }
            shape
                .refactor(&self.weights, self.problem.solver.as_ref())
                .map_err(|source| StepError::Factor { step_s: self.part_s, source })?;
        }
        control.halvings = halvings;
        self.renew_scratches();
        Ok(())
    }

    /// Makes the step of the scene another one \[s\]: the time so far is that of as many of the new ones.
    ///
    /// # Errors
    /// [`StepError::Factor`] where a block cannot be solved for with it.
    pub fn change_step(&mut self, step_s: f64) -> Result<(), StepError> {
        (self.problem.base_step_s, self.part_s) = (step_s, step_s);
        self.weights = self.weights_of(step_s);
        for shape in &mut self.problem.shapes {
            shape.damping = StepDamping::new(&shape.material.damping(), step_s, &self.weights);
        }
        if let Some(control) = &mut self.control {
            control.halvings = 0;
        }
        let all: Vec<usize> = (0..self.problem.shapes.len()).collect();
        self.factor_anew(&all)
    }

    /// Memory of solves for the factors in use.
    pub(super) fn renew_scratches(&mut self) {
        self.problem.workspaces.iter_mut().flatten().for_each(Workspaces::renew);
        for body in &mut self.bodies {
            let shape = &self.problem.shapes[body.shape];
            let Some(factor) = shape.factor.as_deref() else { continue };
            body.renew_scratch(factor, shape.filter.as_deref());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::kind::BodyKind;
    use crate::step::test_boxes::boxes;
    use ndda_mesh::Vec3;

    #[test]
    fn a_step_that_is_too_long_is_given_up_while_errors_of_energy_are_let_pass() {
        let mut setup = boxes(&[(BodyKind::Rigid, [1.0; 3], [0.0; 3])]);
        setup.auto_step = Some(AutoStep { safety: 0.5, energy: 1e-4, most_halvings: 1 });
        // 0.6 m in a step of 1 ms, and a width of 1 m.
        setup.bodies[0].velocity_m_s = Vec3::new(600.0, 0.0, 0.0);
        let mut simulation = Simulation::new(setup).unwrap();
        simulation.state.control.energy_check_cooldown = COOLDOWN_STEPS;
        let given_up = simulation.step();
        assert!(matches!(given_up, Err(StepError::NoStepIsShortEnough { .. })), "{given_up:?}");
    }

    #[test]
    fn a_step_is_expected_to_gain_what_the_bound_says_until_steps_like_it_have_gained_less() {
        let mut state = StepState::default();
        assert!(!state.expects(0.5) && state.expects(1.5));
        state.learn(Some(100.0), 0.01);
        assert!(!state.expects(100.0) && !state.expects(399.0));
        assert!(state.expects(401.0), "it grew");
        state.learn(Some(100.0), 0.5);
        assert!(state.expects(100.0), "three times as much would be too much");
        assert!(!state.expects(0.9));
        let learnt = state;
        state.learn(Some(f64::INFINITY), 1.0);
        state.learn(None, 1.0);
        assert_eq!(state, learnt);
    }
}
