//! Why a study cannot go on.

use std::path::PathBuf;

use ndda_io::WriteError;
use ndda_io::diagnostic::SceneErrors;
use ndda_io::table::TableError;

use super::difference::DifferenceError;

/// Why a study cannot go on. A case that fails is no such reason: it is listed.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// Something is wrong with the study or its scene.
    #[error("{}", .0.render(false))]
    Scene(SceneErrors),
    /// A scene in the place of a study.
    #[error(
        "{} is a scene, and no study: say what to vary in it, such as --vary time.step_s=1e-3,5e-4, or name a study file", .0.display()
    )]
    SceneAlone(PathBuf),
    /// Names of cases.
    #[error("the case name `{0}` is too long or there twice: give shorter or other labels with Choose")]
    Names(String),
    /// No closed form.
    #[error("the scene {} names no reference: write `reference: Runs(first: {{…}}, second: {{…}})`", .0.display())]
    NoReference(PathBuf),
    /// A monitor of the reference that the scene does not have.
    #[error("reference.monitors: the scene has no monitor `{0}`: it has {1}")]
    NoMonitor(String, String),
    /// The system does not tell processor times.
    #[error("this system does not report processor times: leave out `clock: Processor`")]
    NoProcessorTime,
    /// The first rank reports its own processor time only.
    #[error("processor times of several ranks are not known: leave out `clock: Processor`, or --ranks")]
    ProcessorTimeOfRanks,
    /// No such case.
    #[error("the study has no case `{0}`: `ndda study STUDY --emit list` prints all")]
    NoCase(String),
    /// A reference run failed.
    #[error("the reference run `{name}` failed: {reason}")]
    Reference {
        /// Name of the run.
        name: String,
        /// Why.
        reason: String,
    },
    /// The two reference runs, or a case and the first of them, cannot be compared.
    #[error("case `{name}`: {source}")]
    Difference {
        /// Name of the case.
        name: String,
        /// Why.
        source: DifferenceError,
    },
    /// A history cannot be read.
    #[error("{0}")]
    Table(#[from] TableError),
    /// A result cannot be written.
    #[error("{0}")]
    Write(#[from] WriteError),
    /// A record of a case cannot be used.
    #[error("{} is not a record of a case ({reason}): delete it", file.display())]
    Record {
        /// The file.
        file: PathBuf,
        /// Why.
        reason: String,
    },
    /// A run cannot be started.
    #[error("cannot start a run: {0}")]
    Start(std::io::Error),
    /// A study without cases that a scheduler could run.
    #[error(
        "the study asks for quantities or has random parameters: `ndda study STUDY --jobs N` runs it as a whole, and goes on where it was"
    )]
    IsSweep,
    /// A condition that cannot be judged.
    #[error(
        "the condition `{condition}` cannot be judged: {reason}; write a quantity, a comparison and a number, as `safety < 1`"
    )]
    Condition {
        /// The condition.
        condition: String,
        /// Why.
        reason: &'static str,
    },
    /// A correlation that cannot be read.
    #[error(
        "`{0}` is not a correlation: write the names of two random parameters and a number, as friction_deg,cohesion_pa=-0.5"
    )]
    Correlation(String),
    /// An option of samples where nothing is random.
    #[error(
        "--{0} has no effect, since nothing is random: give a value a distribution, as --vary \"PATH=Normal(30, 2)\""
    )]
    Idle(&'static str),
    /// Samples that cannot be drawn.
    #[error("samples cannot be drawn: {0}")]
    Samples(String),
    /// No case has a quantity.
    #[error(
        "no run has a quantity `{name}`{near} (runs have {known}; the beginning of a name stands for all that begin so)"
    )]
    NoQuantity {
        /// Its name.
        name: String,
        /// Names that it may have been meant for, as a question.
        near: String,
        /// The quantities that there are.
        known: String,
    },
    /// A condition names a quantity by a beginning that several have.
    #[error("the condition `{condition}` may be on any of {known}: write one of them")]
    AmbiguousCondition {
        /// The condition.
        condition: String,
        /// The quantities.
        known: String,
    },
    /// Somebody asked it to end.
    #[error("interrupted: the same command goes on from here")]
    Interrupted,
}
