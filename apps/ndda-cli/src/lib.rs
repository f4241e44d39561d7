//! ndda on the command line: where names in a scene become objects, and a run becomes files and a table.

pub mod args;
pub mod check;
pub mod checkpoint;
pub mod console;
pub mod contacts;
pub mod events;
pub mod exit;
pub mod fields;
pub mod guess;
pub mod interrupt;
pub mod machine;
pub mod mesh;
pub mod monitor;
pub mod progress;
pub mod recorder;
pub mod reference;
pub mod report;
pub mod resume;
pub mod run;
pub mod run_log;
pub mod step_advice;
pub mod wiring;
