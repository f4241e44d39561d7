//! The program `ndda`.

use std::process::ExitCode;

fn main() -> ExitCode {
    let program = std::env::current_exe().map(|file| vec![file.into()]).unwrap_or_default();
    ExitCode::from(ndda_cli::run_command(std::env::args_os().collect(), program))
}
