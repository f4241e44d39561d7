//! ndda on the command line: arguments, a terminal, and one `match`.

mod args;
mod exit;
mod input;
mod terminal;
mod verbs;

use std::process::ExitCode;

use clap::Parser;
use ndda::forecast::memory as limits;

use args::{Cli, Verb};
use terminal::console::has_lost;
#[cfg(feature = "plots")]
use verbs::plot;
#[cfg(feature = "report")]
use verbs::report;
#[cfg(feature = "schema")]
use verbs::schema;
#[cfg(feature = "shell")]
use verbs::shell;
use verbs::{certify, check, explain, mesh, new, resume, run, study, tune};

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
        Verb::Report(args) => report::report(&args),
        #[cfg(feature = "report")]
        Verb::View(args) => report::view(&args),
        Verb::Certify(args) => certify::certify(&args),
        Verb::Tune(args) => tune::tune(&args),
        Verb::Study(args) => study::study(&args),
        #[cfg(feature = "plots")]
        Verb::Plot(args) => plot::plot(&args),
    };
    let lost = outcome == exit::DONE && !results_in_files && has_lost();
    ExitCode::from(if lost { exit::INPUT_OUTPUT } else { outcome })
}
