//! A run through the stages of its scene: each is a simulation of its own, which takes over the state of the one before.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use ndda_io::read::LoadedScene;
use ndda_io::scene::Settle;
use ndda_solver::{RunError, Settled, Simulation, StageStart, TakeOverError};

use super::outputs::Outputs;
use super::rest::Watch;
use super::stage_log::ends;
use super::unless_ended;
use crate::build;
use crate::model;

/// A scene that is run through its stages.
pub(super) struct Course<'a> {
    /// The scene.
    pub loaded: &'a LoadedScene,
    /// Folder of the files that it names.
    pub folder: &'a Path,
    /// Raised when somebody asks the run to end.
    pub stop: &'a AtomicBool,
    /// Told how each stage ended.
    pub tell: &'a dyn Fn(&str),
}

impl Course<'_> {
    /// Shows the start, unless it has been shown, and goes to the end.
    pub(super) fn run(
        &self,
        simulation: &mut Simulation,
        outputs: &mut Outputs,
        goes_on: bool,
    ) -> Result<(), RunError> {
        let steps = build::all_steps(&self.loaded.scene);
        let shown =
            goes_on || ndda_solver::show_start(simulation, steps, &mut [&mut *outputs])?.is_continue();
        if shown { self.go(simulation, outputs, &mut |_| {}) } else { Ok(()) }
    }

    /// Goes on from where a simulation is to the end of the last stage, or until somebody asks to end; `begun` gets it at the beginning of each stage.
    pub(super) fn go(
        &self,
        simulation: &mut Simulation,
        outputs: &mut Outputs,
        begun: &mut dyn FnMut(&mut Simulation),
    ) -> Result<(), RunError> {
        let scene = &self.loaded.scene;
        let ends = ends(scene);
        let steps = ends[ends.len() - 1];
        loop {
            let at = outputs.stages.at;
            let settle = at.checked_sub(1).and_then(|k| scene.stages[k].settle());
            let goes_on = match settle {
                Some(settle) if simulation.state().step < ends[at] => {
                    self.to_rest(simulation, outputs, (&settle, ends[at], steps))?
                }
                _ => ndda_solver::advance(simulation, (ends[at], steps), &mut [&mut *outputs])?,
            };
            if goes_on.is_break() || simulation.state().step < ends[at] {
                return Ok(());
            }
            if let Some(row) = outputs.stages.rows.last().filter(|_| at > 0) {
                (self.tell)(&crate::judge::table::stage(row));
            }
            if at == scene.stages.len() {
                return Ok(());
            }
            self.begin(simulation, at + 1).map_err(|error| match error {
                TakeOverError::Step(error) => RunError::Step(error),
                error => RunError::Sink(format!("stage `{}`: {error}", scene.stages[at].name).into()),
            })?;
            begun(simulation);
            outputs.stages.at = at + 1;
            if scene.stages[at].reset_displacements {
                outputs.recorder.motions.begin_anew();
            }
        }
    }

    /// Begins a stage, counted from 1.
    fn begin(&self, simulation: &mut Simulation, stage: usize) -> Result<(), TakeOverError> {
        let given = &self.loaded.scene.stages[stage - 1];
        let start = StageStart { over_s: given.over_s, reset_displacements: given.reset_displacements };
        let built = model::in_stage(self.loaded, self.folder, simulation.blocks().clone(), stage);
        let mut next = built.map_err(|errors| TakeOverError::Stage(errors.render(false)))?;
        next.begin_stage(simulation, &start)?;
        *simulation = next;
        Ok(())
    }

    /// Steps up to the last of a stage, and brings the scene to rest before that is shown; where motion is damped from the start of the stage, it is brought
    /// to rest from there. A run that is ended on the way goes on from before it.
    fn to_rest(
        &self,
        simulation: &mut Simulation,
        outputs: &mut Outputs,
        (settle, end, steps): (&Settle, u64, u64),
    ) -> Result<ControlFlow<()>, RunError> {
        let stage = &self.loaded.scene.stages[outputs.stages.at - 1];
        let damps_ramp = stage.damps_ramp();
        if !damps_ramp && ndda_solver::advance(simulation, (end - 1, steps), &mut [&mut *outputs])?.is_break()
        {
            return Ok(ControlFlow::Break(()));
        }
        outputs.checkpoint(simulation).map_err(|error| RunError::Sink(Box::new(error)))?;
        let before = simulation.snapshot();
        let mut rest = Watch::new(Some(&stage.name), settle.tolerance);
        let ranks = simulation.ranks().clone();
        let mut watch = |settled: &Settled| {
            // How it came to rest is said with the end of the stage.
            if settled.speed_ratio > settle.tolerance {
                rest.step(settled, &mut |resting| (self.tell)(&resting.to_string()));
            }
            unless_ended(&*ranks, self.stop)
        };
        if !damps_ramp {
            ndda_solver::unseen_step(simulation, &mut [&mut *outputs])?;
        }
        let ramp_steps = end - simulation.state().step;
        let rest_of = build::settle(*settle);
        let (settled, report) = simulation.settle_within(&rest_of, ramp_steps, &mut watch)?;
        if self.stop.load(Ordering::Relaxed) {
            let restored = simulation.restore(before);
            restored.expect("it is of this simulation");
            return Ok(ControlFlow::Break(()));
        }
        outputs.stages.settling_steps = settled.steps - ramp_steps;
        ndda_solver::show(simulation, steps, &report, &mut [&mut *outputs])
    }
}
