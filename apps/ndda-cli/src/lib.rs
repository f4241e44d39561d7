//! ndda on the command line: where names in a scene become objects, and a run becomes files and a table.

pub mod args;
mod bar;
pub mod certify;
pub mod check;
pub mod checkpoint;
mod columns;
pub mod console;
pub mod contacts;
pub mod events;
pub mod examples;
pub mod exit;
pub mod explain;
pub mod fields;
pub mod forecast;
pub mod guess;
#[cfg(feature = "report")]
pub mod html_report;
pub mod input;
pub mod interrupt;
mod lumped;
pub mod machine;
pub mod memory;
pub mod mesh;
pub mod monitor;
pub mod new;
pub mod overlaps;
#[cfg(feature = "plots")]
pub mod picture;
#[cfg(feature = "plots")]
pub mod plot;
pub mod progress;
pub mod recorder;
pub mod reference;
pub mod report;
pub mod resume;
pub mod rounding;
pub mod run;
pub mod run_log;
#[cfg(feature = "schema")]
pub mod schema;
#[cfg(feature = "shell")]
pub mod shell;
pub mod step_advice;
pub mod study;
pub mod tune;
pub mod verdict;
pub mod wiring;
