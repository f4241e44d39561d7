//! Steps as short as they have to be.
//!
//! A step of the scene is done in 2ⁿ parts of Δt/2ⁿ. When a part asks for more than it may, the whole step is taken back
//! (history of contact and books included) and done again in twice as many; when half as many would do for some steps in a
//! row, half as many are tried. Time stays a count of steps, outputs fall where they fall, and a change of n costs one
//! factorisation per distinct block, once per n.

use serde::{Deserialize, Serialize};

use crate::damping::StepDamping;
use crate::ledger::Ledger;
use crate::linear_solver::{Factor, LinearSolver};
use crate::simulation::{Simulation, StepReport};
use crate::state::State;
use crate::step_error::StepError;

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

/// Travel of a part over the smallest tet height of the block.
const MOST_TRAVEL: f64 = 0.5;
/// Steps in a row that half as many parts would have done for, before half as many are tried.
const CALM_STEPS: u32 = 4;
/// A halving that leaves more than this part of an energy error does not help against it: by chance, when a block comes
/// into contact early or late in a part, or because the error is none of the step.
const HELPS: f64 = 0.7;
/// Halvings in a row that do not help, before it is none of the step.
const ENOUGH_TRIES: u32 = 3;
/// Steps for which energy is not asked for after halving did not help.
const DEAF_STEPS: u32 = 100;

/// Where the control of the step is; part of the state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct StepState {
    /// n: a step is done in 2ⁿ parts.
    pub halvings: u32,
    /// Parts done of the present step.
    pub part: u32,
    /// Steps in a row that could have done with fewer parts.
    calm: u32,
    /// Steps for which energy is not asked for.
    deaf: u32,
}

/// What controlling the step took; zero without control.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepCounts {
    /// Steps taken back.
    pub rejected: u64,
    /// Most halvings of a step.
    pub most_halvings: u32,
}

/// Memory of the control.
pub(crate) struct Control {
    settings: AutoStep,
    solver: Box<dyn LinearSolver>,
    state: State,
    ledger: Ledger,
    /// Factors of the shapes that are not in use, by halvings.
    spare: Vec<Vec<Option<Factors>>>,
    /// Halvings that the factors in use are for.
    halvings: u32,
    /// The balance of energy after a step \[J\], and after which: it is that before the next.
    balance: Option<(u64, f64)>,
}

/// Factors of a shape for one length of step: that of the step, and that of the filter of velocities.
type Factors = (Box<dyn Factor>, Option<Box<dyn Factor>>);

/// Why a step has to be done again.
enum Rejection {
    /// It asks for more than this many times too much.
    TooLong(f64),
    /// It gained this much energy over the largest so far.
    Energy(f64),
    /// It failed.
    Failed(StepError),
}

impl Control {
    pub(crate) fn new(
        settings: AutoStep,
        solver: Box<dyn LinearSolver>,
        state: &State,
        ledger: &Ledger,
    ) -> Self {
        Self {
            settings,
            solver,
            state: state.clone(),
            ledger: ledger.clone(),
            spare: Vec::new(),
            halvings: 0,
            balance: None,
        }
    }

    /// Forgets what it knows of the last step, when another state takes its place.
    pub(crate) fn forget(&mut self) {
        self.balance = None;
    }
}

impl Simulation {
    /// One step of the scene in as many parts as it needs.
    pub(crate) fn controlled_step(&mut self, control: &mut Control) -> Result<StepReport, StepError> {
        self.use_halvings(control, self.state.control.halvings)?;
        let before_j = self.balance_before(control)?;
        control.state.clone_from(&self.state);
        control.ledger.clone_from(&self.ledger);
        let (mut last_gain, mut unhelpful) = (f64::INFINITY, 0);
        loop {
            let rejection = match self.try_parts(&control.settings, before_j) {
                Ok((report, after_j)) => {
                    control.balance = after_j.map(|balance_j| (self.state.step, balance_j));
                    self.relax(&control.settings, &report);
                    return Ok(report);
                }
                Err(rejection) => rejection,
            };
            let halvings = self.state.control.halvings;
            let mut deaf = self.state.control.deaf;
            if let Rejection::Energy(gain) = rejection {
                unhelpful = if gain > HELPS * last_gain { unhelpful + 1 } else { 0 };
                last_gain = gain;
                // Not an error of the step: take it as it is, and do not ask for a while.
                if unhelpful == ENOUGH_TRIES {
                    deaf = DEAF_STEPS;
                }
            }
            self.state.clone_from(&control.state);
            control.ledger.note_rejected();
            self.ledger.clone_from(&control.ledger);
            if halvings >= control.settings.most_halvings && deaf == 0 {
                return Err(match rejection {
                    Rejection::Failed(error) => error,
                    Rejection::TooLong(_) | Rejection::Energy(_) => {
                        StepError::NoStepIsShortEnough { time_s: self.time_s(), step_s: self.part_s }
                    }
                });
            }
            let more = match rejection {
                Rejection::Energy(_) if deaf > 0 => 0,
                // As many halvings as h asks for, at once.
                Rejection::TooLong(times) if times.is_finite() => (times.log2().ceil() as u32).max(1),
                _ => 1,
            };
            self.state.control.deaf = deaf;
            let halvings = (halvings + more).min(control.settings.most_halvings);
            self.use_halvings(control, halvings)?;
        }
    }

    /// The balance of energy before a step \[J\], if it is asked for.
    fn balance_before(&mut self, control: &Control) -> Result<Option<f64>, StepError> {
        match control.balance {
            _ if self.state.control.deaf > 0 => Ok(None),
            Some((step, balance_j)) if step == self.state.step => Ok(Some(balance_j)),
            _ => self.sample().map(|sample| Some(sample.balance_j)),
        }
    }

    /// All parts of a step; stops at the first that asks for too much. With the balance of energy before, that after comes back.
    fn try_parts(
        &mut self,
        settings: &AutoStep,
        before_j: Option<f64>,
    ) -> Result<(StepReport, Option<f64>), Rejection> {
        let bound = self.contact_bound().map(|bound| settings.safety * bound);
        let mut worst = StepReport::default();
        for _ in 0..1u64 << self.state.control.halvings {
            let report = self.part_step().map_err(Rejection::Failed)?;
            worst = worst.joined(report);
            let times = bound.map_or(0.0, |bound| worst.h / bound).max(worst.travel_ratio / MOST_TRAVEL);
            if times > 1.0 {
                return Err(Rejection::TooLong(times));
            }
        }
        let Some(before_j) = before_j.filter(|_| self.state.control.deaf == 0) else {
            return Ok((worst, None));
        };
        let after_j = self.sample().map_err(Rejection::Failed)?.balance_j;
        let gain = (after_j - before_j) / self.ledger.peak_energy_j();
        if gain > settings.energy { Err(Rejection::Energy(gain)) } else { Ok((worst, Some(after_j))) }
    }

    /// Half as many parts next time, when they would have done for a while.
    fn relax(&mut self, settings: &AutoStep, report: &StepReport) {
        self.ledger.note_halvings(self.state.control.halvings);
        let bound = self.contact_bound().map_or(f64::INFINITY, |bound| settings.safety * bound);
        let control = &mut self.state.control;
        control.deaf = control.deaf.saturating_sub(1);
        let would_do = 2.0 * report.h <= 0.9 * bound && 2.0 * report.travel_ratio <= MOST_TRAVEL;
        control.calm = if would_do && control.halvings > 0 { control.calm + 1 } else { 0 };
        if control.calm >= CALM_STEPS {
            control.calm = 0;
            control.halvings -= 1;
        }
    }

    /// Makes weights and factors those of Δt/2ⁿ.
    fn use_halvings(&mut self, control: &mut Control, halvings: u32) -> Result<(), StepError> {
        self.state.control.halvings = halvings;
        if control.halvings == halvings {
            return Ok(());
        }
        self.part_s = self.base_step_s * 0.5f64.powi(halvings as i32);
        self.weights = self.weights_of(self.part_s);
        let most = control.settings.most_halvings as usize + 1;
        control.spare.resize_with(self.shapes.len(), || (0..most).map(|_| None).collect());
        for (index, spare) in control.spare.iter_mut().enumerate() {
            let shape = &mut self.shapes[index];
            shape.damping = StepDamping::new(&shape.material.damping(), self.part_s, &self.weights);
            spare[control.halvings as usize] = shape.factor.take().map(|step| (step, shape.filter.take()));
            if let Some((step, filter)) = spare[halvings as usize].take() {
                (shape.factor, shape.filter) = (Some(step), filter);
                continue;
            }
            let failed = |source| StepError::Factor { step_s: self.part_s, source };
            shape.factor = shape.factored(&self.weights, control.solver.as_ref()).map_err(failed)?;
            shape.filter = shape.factored_filter(&self.weights, control.solver.as_ref()).map_err(failed)?;
        }
        control.halvings = halvings;
        self.renew_scratches();
        Ok(())
    }

    /// Memory of solves for the factors in use.
    fn renew_scratches(&mut self) {
        for body in &mut self.bodies {
            let shape = &self.shapes[body.shape];
            let Some(factor) = shape.factor.as_deref() else { continue };
            body.renew_scratch(factor, shape.filter.as_deref());
        }
    }
}

impl StepReport {
    /// The worst of both, contact and iterations as they were last.
    fn joined(self, later: Self) -> Self {
        Self {
            h: self.h.max(later.h),
            travel_ratio: self.travel_ratio.max(later.travel_ratio),
            contact: later.contact,
            iterations: later.iterations,
        }
    }
}
