//! `ndda tune`: the cheapest setting of a scene that reaches an error.

use ndda::certify::Trial;
use ndda::tune::settings::{Settings, first_steps};
use ndda::tune::{self, TuneError, Wanted};

use super::processes::Processes;
use super::trial;
use crate::args::TuneArgs;
use crate::exit;
use crate::terminal::console::{complain, complain_unless, say};
use crate::terminal::interrupt;

/// Runs `ndda tune`; returns the exit code.
pub fn tune(args: &TuneArgs) -> u8 {
    let (trial, model) = match trial::open(&args.input, &args.how, "tuned", first_steps) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    let settings = Settings::new(&model.loaded.scene, &model.simulation, args.mesh);
    drop(model);
    tune_trial(args, &trial, &settings).unwrap_or_else(|error| match &error {
        TuneError::Run(error) => trial::refuse(error),
        _ => {
            complain(&format!("error: {error}"));
            exit::of_tune(&error)
        }
    })
}

fn tune_trial(args: &TuneArgs, trial: &Trial, settings: &Settings) -> Result<u8, TuneError> {
    let runner = Processes { stop: interrupt::watch(), ranks: 1 };
    let tell = complain_unless(args.how.quiet);
    let launch = trial.launch(&runner, &tell, (args.how.jobs, args.how.threads));
    let wanted = Wanted { error: args.error, of: args.of.clone(), budget_s: args.budget_s };
    let (tuned, json) = tune::tune(&launch, trial, settings, &wanted)?;
    say(&match args.how.json {
        true => json,
        false => format!("{}results in {}", tuned.text(), trial.out.display()),
    });
    Ok(if tuned.is_reached { exit::DONE } else { exit::FAILED })
}
