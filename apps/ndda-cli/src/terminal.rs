//! Words to the person, events to programs, signals from both.

pub mod bar;
pub mod console;
pub mod events;
pub mod interrupt;
pub mod progress;
