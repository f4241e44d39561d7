//! The label of a simulation that somebody else steps.

use std::sync::atomic::{AtomicBool, Ordering};

use ndda_solver::StartSnapshot;

use super::Driver;
use crate::judge::verdict;
use crate::run::{Sensitivity, twin};
use crate::summary::{Label, LabelWord};

/// What decides, beside the state, whether the steps are taken again for the label.
pub(super) struct Course {
    /// The simulation as it was built.
    built: StartSnapshot,
    /// Whether only steps have been taken since, so that they can be taken again.
    pub is_undisturbed: bool,
    /// The label, where it has been given since the last step.
    judged: Option<Label>,
}

impl Course {
    pub fn new(built: StartSnapshot, is_undisturbed: bool) -> Self {
        Self { built, is_undisturbed, judged: None }
    }

    /// Forgets the label that was given, which is of another state.
    pub fn forget_label(&mut self) {
        self.judged = None;
    }

    /// Notes that something other than a step has changed the simulation.
    pub fn note_change(&mut self) {
        self.is_undisturbed = false;
        self.forget_label();
    }
}

impl Driver {
    /// The simulation's label so far: a sample is taken first, so that nothing since the last one is missed.
    ///
    /// After the last step the label is that of a run: where blocks hit several times or disturb each other, the steps of an accurate scene are taken
    /// again, from a slightly different start or with half the step. The result is kept until the next step. Before the last step, after
    /// [`set_force`](Self::set_force), [`set_velocity`](Self::set_velocity) or [`change`](Self::change), and with parts of the caller's
    /// own, it judges the steps that were taken.
    pub fn label(&mut self) -> Label {
        self.label_watched(&AtomicBool::new(false), &|_| {})
    }

    /// As [`label`](Self::label); `tell` hears of steps that are about to be taken again, and raising `stop` ends them.
    pub fn label_watched(&mut self, stop: &AtomicBool, tell: &dyn Fn(&str)) -> Label {
        if let Some(judged) = &self.course.judged {
            return judged.clone();
        }
        let stopped_by = self.sample().err().map(|error| format!("[{}] {error}", error.code()));
        let label = verdict::label(&self.model.simulation, stopped_by.as_deref());
        if label.word != LabelWord::Accurate || !self.can_repeat() {
            return label;
        }
        let label = self.repeated(stop, tell).unwrap_or(label);
        if !stop.load(Ordering::Relaxed) {
            self.course.judged = Some(label.clone());
        }
        label
    }

    /// Whether all steps of the scene have been taken, and nothing else has been done.
    fn can_repeat(&self) -> bool {
        let scene = &self.model.loaded.scene;
        let has_ended = self.simulation().state().step >= self.steps;
        has_ended && self.course.is_undisturbed && self.parts.is_none() && scene.stages.is_empty()
    }

    /// The label of an accurate scene whose steps, taken again, end elsewhere.
    fn repeated(&mut self, stop: &AtomicBool, tell: &dyn Fn(&str)) -> Option<Label> {
        let simulation = &mut self.model.simulation;
        let twins = Sensitivity::Auto.twins(simulation);
        if twins.is_empty() {
            return None;
        }
        tell(&twin::told(&twins));
        let settle = self.model.loaded.scene.settle.map(crate::build::settle);
        twin::label_of_twins(simulation, &self.course.built, settle.as_ref(), &twins, stop)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use ndda_mesh::{BlockId, Vec3};

    use super::*;
    use crate::{Model, Run};

    /// A grain that flies to and fro between two blocks, with steps that grow errors in its impacts.
    fn grain() -> Model {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/extreme/small_between_large.ron");
        Model::open(&file, &[]).unwrap()
    }

    fn at_end(mut driver: Driver) -> Driver {
        let left = driver.steps() - driver.simulation().state().step;
        driver.step(left).unwrap();
        driver
    }

    #[test]
    fn a_scene_that_a_run_repeats_has_its_label_and_keeps_state_and_contacts() {
        let summary = Run::new(grain()).finish(&mut []).unwrap().summary;
        assert!(summary.label.reasons[0].contains("half the step"), "{:?}", summary.label.reasons);
        let mut driver = Driver::new(grain()).unwrap();
        driver.watch_contacts(true);
        let mut driver = at_end(driver);
        let contacts = driver.contacts();
        for _ in 0..2 {
            assert_eq!(driver.label(), summary.label);
            assert_eq!(
                (driver.state_crc32(), driver.contacts()),
                (summary.state_crc32.clone(), contacts.clone())
            );
        }
    }

    #[test]
    fn a_snapshot_and_a_file_keep_whether_only_steps_were_taken() {
        let mut driver = Driver::new(grain()).unwrap();
        driver.step(100).unwrap();
        let (snapshot, folder) = (driver.snapshot(), tempfile::tempdir().unwrap());
        let file = folder.path().join("state");
        driver.save(&file).unwrap();
        assert_eq!(at_end(Driver::load(&file, None).unwrap()).label().word, LabelWord::Inaccurate);
        driver.set_velocity(BlockId(0), Vec3::z(), Vec3::zeros()).unwrap_err();
        assert!(driver.snapshot().is_undisturbed, "a refused change has changed nothing");
        driver.set_velocity(BlockId(1), Vec3::new(0.0, 0.0, 0.1), Vec3::zeros()).unwrap();
        let mut driver = at_end(driver);
        assert_eq!(driver.label().word, LabelWord::Accurate, "{:?}", driver.label().reasons);
        driver.restore(&snapshot).unwrap();
        assert_eq!(at_end(driver).label().word, LabelWord::Inaccurate);
    }
}
