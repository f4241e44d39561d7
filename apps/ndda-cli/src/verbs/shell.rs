//! `ndda completions` and `ndda man`: what a shell and a reader of manuals want to know of the command line.

use clap::CommandFactory;
use ndda_io::read::suggest;

use crate::args::{Cli, CompletionsArgs, ManArgs};
use crate::exit;
use crate::terminal::console::{complain, say};

/// Prints completions for a shell; returns the exit code.
pub fn completions(args: &CompletionsArgs) -> u8 {
    let mut out = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "ndda", &mut out);
    print(&out)
}

/// Prints a manual page; returns the exit code.
pub fn man(args: &ManArgs) -> u8 {
    let mut command = Cli::command();
    command.build();
    let page = match &args.command {
        None => command,
        Some(verb) => match command.find_subcommand(verb) {
            Some(found) => found.clone(),
            None => {
                let verbs: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).collect();
                complain(&format!("error: there is no command `{verb}`: {}", suggest(verb, &verbs)));
                return exit::USAGE;
            }
        },
    };
    let mut out = Vec::new();
    match clap_mangen::Man::new(page).render(&mut out) {
        Ok(()) => print(&out),
        Err(error) => {
            complain(&format!("error: the page cannot be made: {error}"));
            exit::INPUT_OUTPUT
        }
    }
}

fn print(bytes: &[u8]) -> u8 {
    say(String::from_utf8_lossy(bytes).trim_end());
    exit::DONE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_sound() {
        Cli::command().debug_assert();
    }
}
