//! Exit codes, so that scripts can tell what happened.

use ndda::certify::error::CertifyError;
use ndda::rockfall::RockfallError;
use ndda::safety::SafetyError;
use ndda::study::error::StudyError;
use ndda::tune::TuneError;
use ndda_io::WriteError;

/// The run reached its end.
pub const DONE: u8 = 0;
/// The run reached its end, but a criterion was not met.
pub const FAILED: u8 = 1;
/// The command line is wrong.
pub const USAGE: u8 = 2;
/// The scene or a mesh is not usable.
pub const BAD_INPUT: u8 = 3;
/// The run stopped because going on would have given a wrong number.
pub const STOPPED: u8 = 4;
/// Files could not be written.
pub const INPUT_OUTPUT: u8 = 5;
/// Threads or memory could not be had.
pub const RESOURCE: u8 = 6;
/// Somebody asked the run to end; it can be resumed.
pub const INTERRUPTED: u8 = 130;

/// Of a file that could not be written.
pub fn of_write(error: &WriteError) -> u8 {
    match error {
        WriteError::NotFinite { .. } => STOPPED,
        WriteError::PictureEnding { .. } => BAD_INPUT,
        _ => INPUT_OUTPUT,
    }
}

/// Of a study that cannot go on.
pub fn of_study(error: &StudyError) -> u8 {
    match error {
        StudyError::Reference { .. } => STOPPED,
        StudyError::Table(_) | StudyError::Write(_) | StudyError::Record { .. } => INPUT_OUTPUT,
        StudyError::Start(_) => RESOURCE,
        StudyError::Interrupted => INTERRUPTED,
        _ => BAD_INPUT,
    }
}

/// Of a scene that cannot be certified.
pub fn of_certify(error: &CertifyError) -> u8 {
    match error {
        CertifyError::Run(error) => of_study(error),
        CertifyError::Stopped { .. } | CertifyError::Failed { .. } => STOPPED,
        CertifyError::Write(_) => INPUT_OUTPUT,
        _ => BAD_INPUT,
    }
}

/// Of a scene whose factor of safety cannot be found.
pub fn of_safety(error: &SafetyError) -> u8 {
    match error {
        SafetyError::NotSettled { .. } => STOPPED,
        SafetyError::Interrupted => INTERRUPTED,
        SafetyError::Folder { .. } => INPUT_OUTPUT,
        SafetyError::Write(error) => of_write(error),
        _ => BAD_INPUT,
    }
}

/// Of a rockfall that cannot be run.
pub fn of_rockfall(error: &RockfallError) -> u8 {
    match error {
        RockfallError::Scene(_) | RockfallError::NoRockfall => BAD_INPUT,
        RockfallError::Folder { .. } | RockfallError::Earlier(_) => INPUT_OUTPUT,
        RockfallError::Threads(_) => RESOURCE,
        RockfallError::Interrupted { .. } => INTERRUPTED,
        RockfallError::Write(error) => of_write(error),
    }
}

/// Of a scene that cannot be tuned.
pub fn of_tune(error: &TuneError) -> u8 {
    match error {
        TuneError::Run(error) => of_certify(error),
        TuneError::NoTruth { .. } => FAILED,
        TuneError::NoClosedForm => BAD_INPUT,
    }
}
