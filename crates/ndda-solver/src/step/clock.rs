//! Time, and the weights of the integrator for a length of step.

use crate::integrators::time_integrator::{StepWeights, TimeIntegrator};
use crate::step::Simulation;
use crate::step::state::StepState;

impl Simulation {
    /// Time [s]: steps done times Δt, never summed.
    pub fn time_s(&self) -> f64 {
        self.steps_done(0.0) * self.problem.base_step_s
    }

    /// Steps done, parts of the present one and some parts ahead included.
    pub(super) fn steps_done(&self, ahead: f64) -> f64 {
        let StepState { halvings, part, .. } = self.state.control;
        self.state.step as f64 + (f64::from(part) + ahead) * 0.5f64.powi(halvings as i32)
    }

    pub(super) fn advance_clock(&mut self) {
        let control = &mut self.state.control;
        control.part += 1;
        if control.part == 1 << control.halvings {
            control.part = 0;
            self.state.step += 1;
        }
    }

    /// The integrator's weights for a step Δt [s].
    pub(crate) fn weights_of(&self, dt_s: f64) -> StepWeights {
        step_weights(self.problem.integrator.as_ref(), dt_s, self.newton.is_some())
    }

    /// Time that loads and prescribed motions see, some steps ahead [s]: it stands still while a scene settles.
    pub(crate) fn clock_s(&self, ahead: f64) -> f64 {
        self.settling
            .map_or_else(|| self.steps_done(ahead) * self.problem.base_step_s, |settling| settling.at_s)
    }

    /// Δt [s], the longest where it is controlled.
    pub fn step_s(&self) -> f64 {
        self.problem.base_step_s
    }
}

/// The integrator's weights for a step, contact being taken at its end where it is solved for.
pub(crate) fn step_weights(integrator: &dyn TimeIntegrator, dt_s: f64, solves_contact: bool) -> StepWeights {
    let weights = integrator.weights(dt_s);
    if solves_contact { StepWeights { contact_lead: 1.0, ..weights } } else { weights }
}
