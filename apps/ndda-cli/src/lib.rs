//! ndda on the command line: where names in a scene become objects, and a run becomes files and a table.

pub mod args;
pub mod check;
pub mod checkpoint;
pub mod console;
pub mod examples;
pub mod exit;
pub mod explain;
#[cfg(feature = "report")]
pub mod html_report;
pub mod input;
pub mod interrupt;
pub mod mesh;
pub mod monitor;
pub mod new;
pub mod progress;
pub mod recorder;
pub mod reference;
pub mod report;
pub mod resume;
pub mod run;
#[cfg(feature = "schema")]
pub mod schema;
#[cfg(feature = "shell")]
pub mod shell;
pub mod step_advice;
pub mod wiring;
