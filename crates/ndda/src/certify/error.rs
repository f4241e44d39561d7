//! Why a scene cannot be certified.

use ndda_io::WriteError;

use crate::forecast::held::NOTHING_MOVES;
use crate::study::error::StudyError;

/// Why a scene cannot be certified.
#[derive(Debug, thiserror::Error)]
pub enum CertifyError {
    /// A run cannot be started, recorded or read.
    #[error(transparent)]
    Run(#[from] StudyError),
    /// Runs stop, whatever the step.
    #[error(
        "the run with steps of {step_s:e} s stopped ({reason}): certify a scene that runs; `ndda check` advises a \
         step, --set time.step_s=… tries a shorter one"
    )]
    Stopped {
        /// The step [s].
        step_s: f64,
        /// Why it stopped.
        reason: String,
    },
    /// A run of a finer mesh or of a stiffer contact, or the disturbed twin, did not end.
    #[error(
        "the run `{name}` failed ({reason}): leave out --mesh or --penalty, or shorten time.step_s with --set"
    )]
    Failed {
        /// Name of the run.
        name: String,
        /// Why.
        reason: String,
    },
    /// The scene has no mesh to refine.
    #[error("--mesh: no block of the scene has cells, levels or a size that could be halved")]
    NoMesh,
    /// Stages of construction.
    #[error(
        "the scene has stages, whose ends differ from step to step: certify and tune one stage, as a scene of its own without `stages`"
    )]
    Stages,
    /// Nothing that moves.
    #[error(
        "{NOTHING_MOVES}, so there is no motion whose error could be found: let blocks move by `body: Rigid`, Affine or Elastic"
    )]
    NothingMoves,
    /// No contact to make stiffer.
    #[error("--penalty: the scene has no contact: leave the option out")]
    NoContact,
    /// A name that no quantity begins with.
    #[error("--of {name}: no column of the history begins with it; choose one of {known}")]
    NoQuantity {
        /// The requested name.
        name: String,
        /// The known names.
        known: String,
    },
    /// A result cannot be written.
    #[error("{0}")]
    Write(#[from] WriteError),
}
