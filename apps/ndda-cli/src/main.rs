//! The binary `ndda`.

use std::process::ExitCode;

use clap::Parser;
use ndda_cli::args::{Cli, Verb};
#[cfg(feature = "report")]
use ndda_cli::html_report;
use ndda_cli::{check, mesh, resume, run};

fn main() -> ExitCode {
    let outcome = match Cli::parse().verb {
        Verb::Run(args) => run::run(&args),
        Verb::Resume(args) => resume::resume(&args),
        Verb::Check(args) => check::check(&args),
        Verb::Mesh(args) => mesh::mesh(&args),
        #[cfg(feature = "report")]
        Verb::Report(args) => html_report::report(&args),
        #[cfg(feature = "report")]
        Verb::View(args) => html_report::view(&args),
    };
    ExitCode::from(outcome)
}
