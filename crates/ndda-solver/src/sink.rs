//! Output is pushed: a run calls each sink after each step.

use std::ops::ControlFlow;

use crate::diagnostics::energies::Sample;
use crate::error::StepError;
use crate::step::Simulation;
use crate::step::report::StepReport;

/// The view that a sink is given.
pub struct View<'a> {
    /// The simulation after the step.
    pub simulation: &'a mut Simulation,
    /// Report on the step; before the first, [what is known then](Simulation::report_at_start).
    pub report: &'a StepReport,
    /// Energies and momenta, if some sink wanted them at this step.
    pub sample: Option<&'a Sample>,
}

/// Why a sink could not take a step.
pub type SinkError = Box<dyn std::error::Error + Send + Sync>;

/// Why a run ended early.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The numbers gave out.
    #[error(transparent)]
    Step(#[from] StepError),
    /// Output failed.
    #[error(transparent)]
    Sink(SinkError),
}

/// Takes results as they come; a new quantity is a new small sink.
pub trait Sink {
    /// Called at the start and after each step; `Break` ends the run in good order.
    ///
    /// # Errors
    /// Any error that keeps the sink from doing its work; the run then stops.
    fn step_done(&mut self, view: &mut View) -> Result<ControlFlow<()>, SinkError>;

    /// Whether `view.sample` is wanted at this step.
    fn wants_sample(&self, _step: u64) -> bool {
        false
    }

    /// Whether [`Simulation::contacts`] is wanted at this step.
    fn wants_contacts(&self, _step: u64) -> bool {
        false
    }
}

/// Shows the start to the sinks, then runs up to step `steps` as [`resume`] does.
///
/// # Errors
/// [`RunError`] of the step or sink that failed.
pub fn run(simulation: &mut Simulation, steps: u64, sinks: &mut [&mut dyn Sink]) -> Result<(), RunError> {
    match show_start(simulation, steps, sinks)? {
        ControlFlow::Continue(()) => resume(simulation, steps, sinks),
        ControlFlow::Break(()) => Ok(()),
    }
}

/// Runs up to step `steps` and shows each to the sinks; the last one is always sampled. Where the simulation is now has
/// been shown before.
///
/// # Errors
/// [`RunError`] of the step or sink that failed.
pub fn resume(simulation: &mut Simulation, steps: u64, sinks: &mut [&mut dyn Sink]) -> Result<(), RunError> {
    advance(simulation, (steps, steps), sinks).map(|_| ())
}

/// Runs up to step `until` of a run of `steps`, and shows each step to the sinks; `Break` if one of them has ended the run.
///
/// # Errors
/// [`RunError`] of the step or sink that failed.
pub fn advance(
    simulation: &mut Simulation,
    (until, steps): (u64, u64),
    sinks: &mut [&mut dyn Sink],
) -> Result<ControlFlow<()>, RunError> {
    while simulation.state().step < until {
        let report = unseen_step(simulation, sinks)?;
        if show(simulation, steps, &report, sinks)?.is_break() {
            return Ok(ControlFlow::Break(()));
        }
    }
    Ok(ControlFlow::Continue(()))
}

/// Takes a step that is shown to the sinks later.
///
/// # Errors
/// [`StepError`] of the step.
pub fn unseen_step(
    simulation: &mut Simulation,
    sinks: &mut [&mut dyn Sink],
) -> Result<StepReport, StepError> {
    let next = simulation.state().step + 1;
    simulation.watch_contacts(sinks.iter().any(|sink| sink.wants_contacts(next)));
    simulation.step()
}

/// Shows the start to the sinks, with contact where the scene has come to rest; `Break` if one of them ends the run.
///
/// # Errors
/// As [`show`], or of contact that cannot be computed.
pub fn show_start(
    simulation: &mut Simulation,
    steps: u64,
    sinks: &mut [&mut dyn Sink],
) -> Result<ControlFlow<()>, RunError> {
    simulation.watch_contacts(sinks.iter().any(|sink| sink.wants_contacts(0)));
    let report = simulation.report_at_start()?;
    show(simulation, steps, &report, sinks)
}

/// Shows a simulation to the sinks as it is now, of a run of `steps`; `Break` if one of them ends the run.
///
/// # Errors
/// [`RunError`] of the sink that failed, or of the sample that one wants.
pub fn show(
    simulation: &mut Simulation,
    steps: u64,
    report: &StepReport,
    sinks: &mut [&mut dyn Sink],
) -> Result<ControlFlow<()>, RunError> {
    let step = simulation.state().step;
    let wanted = step == 0 || step >= steps || sinks.iter().any(|sink| sink.wants_sample(step));
    let sample = if wanted { Some(simulation.sample()?) } else { None };
    for sink in sinks.iter_mut() {
        let mut view = View { simulation, report, sample: sample.as_ref() };
        if sink.step_done(&mut view).map_err(RunError::Sink)?.is_break() {
            return Ok(ControlFlow::Break(()));
        }
    }
    Ok(ControlFlow::Continue(()))
}
