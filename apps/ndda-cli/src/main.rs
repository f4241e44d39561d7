//! The binary `ndda`.

use std::process::ExitCode;

use clap::Parser;
use ndda_cli::args::{Cli, Verb};
use ndda_cli::console::has_lost;
#[cfg(feature = "report")]
use ndda_cli::html_report;
#[cfg(feature = "plots")]
use ndda_cli::plot;
#[cfg(feature = "schema")]
use ndda_cli::schema;
#[cfg(feature = "shell")]
use ndda_cli::shell;
use ndda_cli::{certify, check, exit, explain, memory as limits, mesh, new, resume, run, study, tune};

fn main() -> ExitCode {
    let Cli { memory, verb } = Cli::parse();
    if let Some(bytes) = memory {
        limits::limit(bytes);
    }
    // Results of runs are in files; what others print is their result.
    let results_in_files = matches!(verb, Verb::Run(_) | Verb::Resume(_));
    let outcome = match verb {
        Verb::Run(args) => run::run(&args),
        Verb::Resume(args) => resume::resume(&args),
        Verb::Check(args) => check::check(&args),
        Verb::Explain(args) => explain::explain(&args),
        Verb::New(args) => new::new(&args),
        #[cfg(feature = "schema")]
        Verb::Schema(args) => schema::schema(&args),
        #[cfg(feature = "shell")]
        Verb::Completions(args) => shell::completions(&args),
        #[cfg(feature = "shell")]
        Verb::Man(args) => shell::man(&args),
        Verb::Mesh(args) => mesh::mesh(&args),
        #[cfg(feature = "report")]
        Verb::Report(args) => html_report::report(&args),
        #[cfg(feature = "report")]
        Verb::View(args) => html_report::view(&args),
        Verb::Certify(args) => certify::certify(&args),
        Verb::Tune(args) => tune::tune(&args),
        Verb::Study(args) => study::study(&args),
        #[cfg(feature = "plots")]
        Verb::Plot(args) => plot::plot(&args),
    };
    let lost = outcome == exit::DONE && !results_in_files && has_lost();
    ExitCode::from(if lost { exit::INPUT_OUTPUT } else { outcome })
}
