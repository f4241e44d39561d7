//! ndda on the command line: where names in a scene become objects, and a run becomes files and a table.

pub mod args;
pub mod check;
pub mod checkpoint;
pub mod console;
pub mod exit;
pub mod interrupt;
pub mod machine;
pub mod mesh;
pub mod monitor;
#[cfg(feature = "plots")]
pub mod picture;
#[cfg(feature = "plots")]
pub mod plot;
pub mod progress;
pub mod recorder;
pub mod reference;
pub mod report;
pub mod resume;
pub mod run;
pub mod step_advice;
pub mod study;
pub mod wiring;
