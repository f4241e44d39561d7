//! Ctrl-C: the step is finished, a checkpoint and the summary are written; a second one ends the program at once.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use crate::exit;

/// A flag that is raised when somebody asks the program to end; it stays down where signals cannot be caught.
pub fn watch() -> Arc<AtomicBool> {
    let asked = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        // In this order: the second signal finds the flag raised by the first.
        let twice = flag::register_conditional_shutdown(signal, i32::from(exit::INTERRUPTED), asked.clone());
        let _ = twice.and_then(|_| flag::register(signal, asked.clone()));
    }
    asked
}
