//! The label of a simulation that somebody else steps.

use std::fmt;
use std::ops::ControlFlow;
use std::sync::atomic::AtomicBool;

use ndda_solver::StartSnapshot;
use serde::{Deserialize, Serialize};

use super::Driver;
use crate::judge::verdict;
use crate::numbers::four_figures;
use crate::run::Sensitivity;
use crate::run::twin::{self, Again, Twin};
use crate::summary::{Label, LabelWord};

/// What other than a step changes a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Disturbance {
    /// [`Driver::set_force`].
    Force,
    /// [`Driver::set_velocity`].
    Velocity,
    /// [`Driver::change`] of what acts on blocks.
    Scene,
}

/// What other than a step has changed a simulation first, so that its steps cannot be taken again for the label, and how often something has since.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Disturbed {
    /// What it was.
    pub by: Disturbance,
    /// When it was \[s\].
    pub at_s: f64,
    /// Steps that were done when something changed last.
    last_step: u64,
    /// How often something has changed at most [`SOON`] steps after the change before.
    again: u64,
}

/// Steps between changes that drive a simulation, as a controller does: what they do depends on the step.
const SOON: u64 = 10;
/// So many changes, each soon after the one before, drive a simulation.
const OFTEN: u64 = 3;

impl Disturbed {
    fn new(by: Disturbance, at_s: f64, step: u64) -> Self {
        Self { by, at_s, last_step: step, again: 0 }
    }

    /// Notes another change, after so many steps.
    fn note(&mut self, step: u64) {
        self.again += u64::from((1..=SOON).contains(&step.saturating_sub(self.last_step)));
        self.last_step = step;
    }

    /// Why the motion is not known to be accurate, where something was set in steps that follow each other: what is set holds for a whole step, of which
    /// no check of the simulation knows what it was to be in between.
    fn driving(&self) -> Option<String> {
        let often = self.again >= OFTEN;
        often.then(|| {
            format!(
                "blocks were driven in steps that follow each other ({self}, and {} times more soon after a change): errors of what is set \
                 so are not judged, and grow in proportion to the step; take the same steps with half of time.step_s, and compare",
                self.again
            )
        })
    }
}

impl fmt::Display for Disturbed {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self.by {
            Disturbance::Force => "a force was set",
            Disturbance::Velocity => "a velocity was set",
            Disturbance::Scene => "values of the scene were changed",
        };
        write!(out, "{what} at t = {} s", four_figures(self.at_s))
    }
}

/// What decides, beside the state, whether the steps are taken again for the label.
pub(super) struct Course {
    /// The simulation as it was built.
    built: StartSnapshot,
    /// What other than steps has changed it first, so that they cannot be taken again.
    pub disturbed: Option<Disturbed>,
    /// The label, where it has been given since the last step.
    judged: Option<Label>,
}

impl Course {
    pub fn new(built: StartSnapshot, disturbed: Option<Disturbed>) -> Self {
        Self { built, disturbed, judged: None }
    }

    /// Forgets the label that was given, which is of another state.
    pub fn forget_label(&mut self) {
        self.judged = None;
    }
}

impl Driver {
    /// Notes that something other than a step has changed the simulation.
    pub(super) fn note_change(&mut self, by: Disturbance) {
        let (at_s, step) = (self.simulation().time_s(), self.simulation().state().step);
        self.course.disturbed.get_or_insert(Disturbed::new(by, at_s, step)).note(step);
        self.course.forget_label();
    }

    /// The simulation's label so far: a sample is taken first, so that nothing since the last one is missed.
    ///
    /// After the last step the label is that of a run: where blocks hit several times, hit on strongly damped contact or disturb each other, where loads change along the way of a block, and where there is no contact, the steps of an accurate scene are taken
    /// again, from a slightly different start or with half the step. The result is kept until the next step. They cannot be taken again after
    /// [`set_force`](Self::set_force), [`set_velocity`](Self::set_velocity) or a [`change`](Self::change) of what acts on blocks, nor with parts of the
    /// caller's own: where a run would have been repeated, the reasons then say that it was not, and the word is `Inaccurate` if that was to be with half
    /// the step after impacts, whose errors may have grown or be too large. It is `Inaccurate`, too, where blocks are driven in steps that follow each
    /// other, and the reasons say so. Before the last step, the label judges the steps that were taken.
    pub fn label(&mut self) -> Label {
        self.label_watched(&AtomicBool::new(false), &|_| {})
    }

    /// As [`label`](Self::label); `tell` hears of steps that are about to be taken again, and raising `stop` ends them: the label then says that it is not known
    /// whether the result changes, and is given anew when it is next asked for.
    pub fn label_watched(&mut self, stop: &AtomicBool, tell: &dyn Fn(&str)) -> Label {
        if let Some(judged) = &self.course.judged {
            return judged.clone();
        }
        let stopped_by = self.sample().err().map(|error| format!("[{}] {error}", error.code()));
        let mut label = verdict::label(&self.model.simulation, stopped_by.as_deref());
        self.judge_driving(&mut label);
        if label.word != LabelWord::Accurate || !self.has_ended() {
            return label;
        }
        let twins = twin::twins(Sensitivity::Auto, &self.model.simulation);
        let other = match self.why_not_again() {
            _ if twins.is_empty() => None,
            Some(why) => {
                let simulation = &self.model.simulation;
                let reasons = (twin::hits_again(simulation), twin::hits_damped(simulation));
                Some(unrepeated(&twins, &why, reasons))
            }
            None => match self.repeated(&twins, stop, tell) {
                ControlFlow::Continue(other) => other,
                ControlFlow::Break(unknown) => return unknown,
            },
        };
        self.course.judged.insert(other.unwrap_or(label)).clone()
    }

    /// Says in the label that blocks were driven in steps that follow each other, whatever the checks have found.
    fn judge_driving(&self, label: &mut Label) {
        let driving = self.course.disturbed.as_ref().and_then(Disturbed::driving);
        if let (Some(reason), true) = (driving, label.word != LabelWord::Stopped) {
            label.reasons.push(reason);
            label.word = LabelWord::Inaccurate;
        }
    }

    /// Whether all steps of the scene have been taken.
    fn has_ended(&self) -> bool {
        self.simulation().state().step >= self.steps && self.model.loaded.scene.stages.is_empty()
    }

    /// Why the steps cannot be taken again, where they cannot.
    fn why_not_again(&self) -> Option<String> {
        let has_parts = self.parts.is_some().then(|| "its friction law is not of the scene".to_string());
        self.course.disturbed.map(|disturbed| disturbed.to_string()).or(has_parts)
    }

    /// The label of an accurate scene whose steps, taken again, end elsewhere; broken off where somebody asks to end.
    fn repeated(
        &mut self,
        twins: &[Twin],
        stop: &AtomicBool,
        tell: &dyn Fn(&str),
    ) -> ControlFlow<Label, Option<Label>> {
        tell(&twin::told(twins, &self.model.simulation));
        let settle = self.model.loaded.scene.settle.map(crate::build::settle);
        let again = Again::FromStart { start: &self.course.built, settle };
        twin::label_of_twins(&mut self.model.simulation, &again, twins, stop)
    }
}

/// The label of an accurate scene whose steps would be taken again, were it not for what `why` says; errors may have grown where blocks hit again, and steps may be too long where
/// blocks hit on strongly damped contact.
fn unrepeated(twins: &[Twin], why: &str, (hits_again, hits_damped): (bool, bool)) -> Label {
    let (pushed, halved) =
        (twins.iter().any(|&twin| twin != Twin::HalfStep), twins.contains(&Twin::HalfStep));
    let (how, unknown) = match (pushed, halved) {
        (true, true) => (
            "from a slightly different start and with half the step",
            "whether the motion is sensitive, and whether errors of impacts grow, is not known",
        ),
        (true, false) => ("from a slightly different start", "whether the motion is sensitive is not known"),
        (false, _) if !hits_again => ("with half the step", "whether it is short enough is not known"),
        (false, _) => ("with half the step", "whether errors of impacts grow is not known"),
    };
    let cure = match halved {
        true => "take the same steps with half of time.step_s, and compare",
        false => "begin with velocities that differ by 1e-4 of the largest, and compare",
    };
    let reason = format!("the run was not repeated {how}, since {why}: {unknown}; {cure}");
    let word =
        if halved && (hits_again || hits_damped) { LabelWord::Inaccurate } else { LabelWord::Accurate };
    Label { word, reasons: vec![reason] }
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
        assert_eq!(driver.snapshot().disturbed, None, "a refused change has changed nothing");
        driver.set_velocity(BlockId(1), Vec3::new(0.0, 0.0, 0.1), Vec3::zeros()).unwrap();
        let mut driver = at_end(driver);
        let file = folder.path().join("struck");
        driver.save(&file).unwrap();
        for label in [driver.label(), Driver::load(&file, None).unwrap().label()] {
            assert_eq!(label.word, LabelWord::Inaccurate);
            let words = "not repeated with half the step, since a velocity was set at t = ";
            assert!(label.reasons[0].contains(words), "{:?}", label.reasons);
        }
        driver.restore(&snapshot).unwrap();
        assert_eq!(at_end(driver).label().word, LabelWord::Inaccurate);
    }

    #[test]
    fn a_change_of_what_acts_on_no_block_keeps_the_label_of_the_run() {
        let summary = Run::new(grain()).finish(&mut []).unwrap().summary;
        let mut driver = Driver::new(grain()).unwrap();
        driver.step(100).unwrap();
        let end_s = driver.model().loaded.scene.time.end_s;
        driver.change(&["title=\"another\"".into(), "output.frames=3".into(), "monitors=[]".into()]).unwrap();
        driver.change(&[format!("time.end_s={}", 2.0 * end_s)]).unwrap();
        driver.change(&[format!("time.end_s={end_s}"), "reference=None".into()]).unwrap();
        let mut driver = at_end(driver);
        assert_eq!(driver.label(), summary.label);
        assert_eq!(driver.state_crc32(), summary.state_crc32);
    }

    /// A cube that is set to 1 m/s before each step hits another one, which does not leave at 2 m/s: it is off by a part that goes with the step.
    #[test]
    fn a_simulation_that_is_driven_in_each_step_is_not_called_accurate_and_a_single_blow_is() {
        let text = crate::driver::EXAMPLE.1.replace("gravity_m_s2: (0, 0, -9.81), ", "");
        let driver = || Driver::new(Model::from_text(&text).unwrap()).unwrap();
        let set = |driver: &mut Driver| driver.set_velocity(BlockId(0), Vec3::x(), Vec3::zeros()).unwrap();
        let (mut struck, mut driven) = (driver(), driver());
        set(&mut struck);
        for _ in 0..100 {
            set(&mut driven);
            driven.step(1).unwrap();
        }
        assert_eq!(at_end(struck).label().word, LabelWord::Accurate);
        let label = driven.label();
        let words =
            "driven in steps that follow each other (a velocity was set at t = 0 s, and 99 times more";
        assert!(
            label.word == LabelWord::Inaccurate && label.reasons[0].contains(words),
            "{:?}",
            label.reasons
        );
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("driven");
        driven.save(&file).unwrap();
        assert_eq!(Driver::load(&file, None).unwrap().label(), label);
        // Before the last step, too.
        let mut early = driver();
        for _ in 0..10 {
            early.set_force(BlockId(0), Vec3::x() * early.simulation().time_s()).unwrap();
            early.step(1).unwrap();
        }
        assert_eq!(early.label().word, LabelWord::Inaccurate);
    }

    #[test]
    fn changes_that_are_far_apart_do_not_drive_a_simulation() {
        let mut disturbed = Disturbed::new(Disturbance::Force, 0.0, 0);
        (1..100).for_each(|i| disturbed.note(i * (SOON + 1)));
        assert_eq!(disturbed.driving(), None);
        (0..3).for_each(|i| disturbed.note(99 * (SOON + 1) + i));
        assert_eq!(disturbed.driving(), None, "a change of several things at once is one");
        disturbed.note(99 * (SOON + 1) + 3);
        assert!(disturbed.driving().is_some());
    }

    #[test]
    fn the_repetition_that_is_left_out_decides_what_is_not_known() {
        let label = |twins: &[Twin]| unrepeated(twins, "a force was set at t = 1 s", (true, false));
        let (pushed, both) = (label(&[Twin::Push(1.0)]), label(&[Twin::Push(1.0), Twin::HalfStep]));
        assert_eq!((pushed.word, both.word), (LabelWord::Accurate, LabelWord::Inaccurate));
        assert!(
            pushed.reasons[0]
                .contains("since a force was set at t = 1 s: whether the motion is sensitive is not known")
        );
        assert!(
            both.reasons[0].contains("and whether errors of impacts grow, is not known"),
            "{:?}",
            both.reasons
        );
    }
}
