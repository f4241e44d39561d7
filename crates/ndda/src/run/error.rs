//! Why a run has no result.

use ndda_io::WriteError;
use ndda_solver::StepError;

/// Why a run has no result. A run that stops numerically after its first step has one: its summary names the cause.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The scene did not come to rest, or stopped on the way.
    #[error("stopped [{}] {}", .0.code(), .0)]
    Settling(StepError),
    /// Somebody asked the run to end before its first step.
    #[error("interrupted while the scene settled")]
    InterruptedWhileSettling,
    /// A result cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// A numerical stop in words, after its code.
pub(super) fn stop(error: &StepError) -> String {
    format!("[{}] {error}", error.code())
}

/// The cause of a numerical stop in words; errors of output are handed on.
pub(super) fn numerical_stop(error: ndda_solver::RunError) -> Result<String, WriteError> {
    match error {
        ndda_solver::RunError::Step(step) => Ok(stop(&step)),
        ndda_solver::RunError::Sink(sink) => match sink.downcast::<StepError>() {
            Ok(step) => Ok(stop(&step)),
            Err(other) => match other.downcast::<WriteError>() {
                Ok(write) if matches!(*write, WriteError::NotFinite { .. }) => Ok(write.to_string()),
                Ok(write) => Err(*write),
                Err(unknown) => Ok(unknown.to_string()),
            },
        },
    }
}
