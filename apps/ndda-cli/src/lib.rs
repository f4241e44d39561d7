//! ndda on the command line: arguments, a terminal, and one `match`; the Python package brings it, too.

mod args;
mod exit;
mod input;
mod terminal;
mod verbs;

use std::ffi::OsString;

use clap::{CommandFactory, FromArgMatches, error::ContextKind};
use ndda::forecast::memory as limits;

use args::{Cli, Verb};
use terminal::console::has_lost;
#[cfg(feature = "report")]
use verbs::report;
#[cfg(feature = "schema")]
use verbs::schema;
#[cfg(feature = "shell")]
use verbs::shell;
use verbs::{
    certify, check, explain, joint, mesh, new, processes, record, resume, rockfall, run, safety, stereonet,
    study, tune,
};
#[cfg(feature = "plots")]
use verbs::{picture, plot};

/// Does what a command line asks for, its program first, and returns the exit code; `program` starts this program again, for studies.
pub fn run_command(args: Vec<OsString>, program: Vec<OsString>) -> u8 {
    let _ = processes::PROGRAM.set(program);
    // A negative number is a value, not an option.
    let command = Cli::command().mut_subcommands(|verb| verb.allow_negative_numbers(true));
    let parsed = command.try_get_matches_from(args).and_then(|found| Cli::from_arg_matches(&found));
    let Cli { memory, verb } = match parsed {
        Ok(cli) => cli,
        Err(mut refused) => {
            // No option is meant as a value, and "use '-- --threads'" is no cure.
            refused.remove(ContextKind::Suggested);
            let _ = refused.print();
            return u8::try_from(refused.exit_code()).unwrap_or(exit::USAGE);
        }
    };
    memory.into_iter().for_each(limits::limit);
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
        #[cfg(not(feature = "schema"))]
        Verb::Schema(_) => absent("schema"),
        #[cfg(feature = "shell")]
        Verb::Completions(args) => shell::completions(&args),
        #[cfg(feature = "shell")]
        Verb::Man(args) => shell::man(&args),
        #[cfg(not(feature = "shell"))]
        Verb::Completions(_) | Verb::Man(_) => absent("shell"),
        Verb::Mesh(args) => mesh::mesh(&args),
        #[cfg(feature = "report")]
        Verb::Report(args) => report::report(&args),
        #[cfg(feature = "report")]
        Verb::View(args) => report::view(&args),
        #[cfg(not(feature = "report"))]
        Verb::Report(_) | Verb::View(_) => absent("report"),
        Verb::Certify(args) => certify::certify(&args),
        Verb::Joint(args) => joint::joint(&args),
        Verb::Safety(args) => safety::safety(&args),
        Verb::Tune(args) => tune::tune(&args),
        Verb::Stereonet(args) => stereonet::stereonet(&args),
        Verb::Record(args) => record::record(&args),
        Verb::Rockfall(args) => rockfall::rockfall(&args),
        Verb::Study(args) => study::study(&args),
        #[cfg(feature = "plots")]
        Verb::Plot(args) => plot::plot(&args),
        #[cfg(feature = "plots")]
        Verb::Picture(args) => picture::picture(&args),
        #[cfg(not(feature = "plots"))]
        Verb::Plot(_) | Verb::Picture(_) => absent("plots"),
    };
    let lost = outcome == exit::DONE && !results_in_files && has_lost();
    if lost { exit::INPUT_OUTPUT } else { outcome }
}

/// A verb that this program was built without.
#[cfg(not(all(feature = "plots", feature = "report", feature = "schema", feature = "shell")))]
fn absent(feature: &str) -> u8 {
    terminal::console::complain(&format!(
        "error: this program was built without the feature `{feature}`\n  help: cargo install --path apps/ndda-cli --features {feature}, or \
         --features full for all of them"
    ));
    exit::USAGE
}
