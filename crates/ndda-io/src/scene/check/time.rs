//! Checks of time and of how it is solved.

use super::{Check, MOST_STEPS};
use crate::scene::code::Code;
use crate::scene::is_unset;
use crate::scene::{ContactAt, Integrator, Solver, Step};

impl Check<'_> {
    pub(super) fn time(&mut self) {
        let time = &self.scene.time;
        if !is_unset(&time.step_s) {
            self.positive("time.step_s".into(), time.step_s, "s");
        }
        self.positive("time.end_s".into(), time.end_s, "s");
        if time.step_s > 0.0 && time.end_s > 0.0 {
            if time.end_s < time.step_s {
                let message =
                    format!("a step of {} s is longer than the run, end_s: {}", time.step_s, time.end_s);
                self.error("time.step_s", message, "shorten the step, or end the run later");
            } else if time.end_s / time.step_s > MOST_STEPS {
                let count = time.end_s / time.step_s;
                let message = format!(
                    "{count:.1e} steps of step_s = {:e} s up to end_s = {:e} s",
                    time.step_s, time.end_s
                );
                self.error(
                    "time.end_s",
                    message,
                    "at most 1e9 steps are taken: make end_s smaller, or step_s larger",
                );
            } else if time.step_s > 0.1 * time.end_s && self.scene.stages.is_empty() {
                self.warn(
                    Code::UnitSlip,
                    "time.step_s",
                    "fewer than ten steps",
                    "is it meant in milliseconds? the unit is seconds",
                );
            }
        }
        if let Solver::ConjugateGradients { tolerance } = time.solver
            && !(1e-16..=1e-3).contains(&tolerance)
        {
            let message = format!("{tolerance:e}: must be from 1e-16 to 1e-3");
            self.error(
                "time.solver.tolerance",
                message,
                "1e-12 costs little more than 1e-6 and leaves no doubt",
            );
        }
        if let Step::Auto { safety, energy, most_halvings } = time.step {
            self.positive("time.step.safety".into(), safety, "");
            self.positive("time.step.energy".into(), energy, "");
            if safety > 1.0 {
                self.error(
                    "time.step.safety",
                    format!("{safety}: must be at most 1, where contact is still stable"),
                    "0.5 is a good choice",
                );
            }
            if most_halvings > 30 {
                let message = format!("{most_halvings} halvings are a billionth of a step");
                self.error("time.step.most_halvings", message, "at most 30");
            }
        }
        if let ContactAt::End { tolerance, most_iterations } = time.contact_at {
            if !(1e-13..=1e-2).contains(&tolerance) {
                let message = format!("{tolerance:e}: must be from 1e-13 to 1e-2");
                self.error(
                    "time.contact_at.tolerance",
                    message,
                    "1e-8 costs about one iteration more than 1e-4",
                );
            }
            if most_iterations == 0 {
                let message = "0 evaluations of contact solve nothing";
                self.error("time.contact_at.most_iterations", message, "100 is seldom reached");
            }
        }
        match time.integrator {
            Integrator::Midpoint { theta } if !(0.5..=1.0).contains(&theta) => {
                self.error(
                    "time.integrator.theta",
                    format!("θ = {theta}: must be from 0.5 to 1"),
                    "0.5 damps nothing",
                );
            }
            Integrator::GeneralizedAlpha { radius } if !(0.0..=1.0).contains(&radius) => {
                self.error(
                    "time.integrator.radius",
                    format!("ρ = {radius}: must be from 0 to 1"),
                    "1 damps nothing, 0.8 a little",
                );
            }
            Integrator::Newmark { alpha, delta } if !(delta >= 0.5 && 2.0 * alpha >= delta) => {
                let message = format!("α = {alpha}, δ = {delta}: unstable, must be 2 α ≥ δ ≥ ½");
                self.error("time.integrator", message, "usual values are α = 0.5, δ = 1");
            }
            _ => {}
        }
    }
}
