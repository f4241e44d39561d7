//! The program as a user calls it.

use std::process::Command;

/// Exit codes, as docs/reference/scene.md lists them.
pub mod exit {
    pub const DONE: i32 = 0;
    pub const BAD_INPUT: i32 = 3;
    #[allow(dead_code)] // not every test has such a case
    pub const INPUT_OUTPUT: i32 = 5;
}

/// A call of the program.
pub fn ndda() -> Command {
    Command::new(env!("CARGO_BIN_EXE_ndda"))
}

/// The exit code of a call.
#[allow(dead_code)] // some tests look at what is said, too
pub fn code(command: &mut Command) -> i32 {
    command.output().unwrap().status.code().unwrap()
}
