//! Words to the person: what a closed pipe or a full disk behind them does must not end a run.

use std::io::{IsTerminal, Write};

/// Whether messages on standard error may be coloured.
pub fn colour() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

/// Prints to standard output. Whoever closed it does not want to hear more; results are in files.
pub fn say(text: &str) {
    let mut out = std::io::stdout().lock();
    let _ = writeln!(out, "{text}").and_then(|()| out.flush());
}

/// Prints to standard error, if anybody listens.
pub fn complain(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}
