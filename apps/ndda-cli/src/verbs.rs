//! A module per verb: arguments in, words and an exit code out.

pub mod certify;
pub mod check;
pub mod explain;
pub mod joint;
pub mod mesh;
pub mod new;
#[cfg(feature = "plots")]
pub mod picture;
#[cfg(feature = "plots")]
pub mod plot;
pub mod processes;
pub mod record;
#[cfg(feature = "report")]
pub mod report;
pub mod resume;
pub mod rockfall;
pub mod run;
pub mod safety;
#[cfg(feature = "schema")]
pub mod schema;
#[cfg(feature = "shell")]
pub mod shell;
pub mod stereonet;
pub mod study;
mod trial;
pub mod tune;
