//! The binary `ndda`.

use std::process::ExitCode;

use clap::Parser;
use ndda_cli::args::{Cli, Verb};
#[cfg(feature = "plots")]
use ndda_cli::plot;
use ndda_cli::{check, mesh, resume, run, study};

fn main() -> ExitCode {
    let outcome = match Cli::parse().verb {
        Verb::Run(args) => run::run(&args),
        Verb::Resume(args) => resume::resume(&args),
        Verb::Check(args) => check::check(&args),
        Verb::Mesh(args) => mesh::mesh(&args),
        Verb::Study(args) => study::study(&args),
        #[cfg(feature = "plots")]
        Verb::Plot(args) => plot::plot(&args),
    };
    ExitCode::from(outcome)
}
