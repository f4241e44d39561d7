//! The binary `ndda`.

use std::process::ExitCode;

use clap::Parser;
use ndda_cli::args::{Cli, Verb};
use ndda_cli::{check, mesh, resume, run};

fn main() -> ExitCode {
    let outcome = match Cli::parse().verb {
        Verb::Run(args) => run::run(&args),
        Verb::Resume(args) => resume::resume(&args),
        Verb::Check(args) => check::check(&args),
        Verb::Mesh(args) => mesh::mesh(&args),
    };
    ExitCode::from(outcome)
}
