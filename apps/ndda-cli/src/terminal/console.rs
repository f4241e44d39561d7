//! Words to the person: what a closed pipe or a full disk behind them does must not end a run.

use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether something that was said has not arrived.
static LOST: AtomicBool = AtomicBool::new(false);

/// Whether messages on standard error may be coloured.
pub fn colour() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

/// Whether what is printed to standard output may be coloured.
pub fn is_coloured() -> bool {
    std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

/// Prints to standard output. A closed pipe is ignored; a full disk is reported at the end.
pub fn say(text: &str) {
    let mut out = std::io::stdout().lock();
    if let Err(error) = writeln!(out, "{text}").and_then(|()| out.flush())
        && error.kind() != ErrorKind::BrokenPipe
        && !LOST.swap(true, Ordering::Relaxed)
    {
        complain(&format!("error: standard output cannot be written: {error}"));
    }
}

/// Whether something that was said to a listener has not arrived.
pub fn has_lost() -> bool {
    LOST.load(Ordering::Relaxed)
}

/// Prints to standard error, if anybody listens; on a terminal in the place of a bar that is drawn in the last line.
pub fn complain(text: &str) {
    let clear = if std::io::stderr().is_terminal() { "\r\x1b[2K" } else { "" };
    let _ = writeln!(std::io::stderr(), "{clear}{text}");
}

/// [`complain`], or nothing where a user requested quiet.
pub fn complain_unless(quiet: bool) -> impl Fn(&str) + Sync {
    move |text: &str| {
        if !quiet {
            complain(text);
        }
    }
}
