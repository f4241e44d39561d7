//! `ndda certify`: every result of a scene with an error bar, from runs with steps that halve.

use ndda::build;
use ndda::certify::error::CertifyError;
use ndda::certify::runs::Wanted;
use ndda::certify::{Trial, report, runs};
use ndda_io::scene::Scene;

use super::processes::Processes;
use super::trial;
use crate::args::CertifyArgs;
use crate::exit;
use crate::terminal::console::{complain_unless, say};
use crate::terminal::interrupt;

/// Runs `ndda certify`; returns the exit code.
pub fn certify(args: &CertifyArgs) -> u8 {
    let own_steps = |scene: &Scene| build::steps(&scene.time);
    let trial = match trial::open(&args.input, &args.how, "certified", own_steps) {
        Ok((trial, _)) => trial,
        Err(code) => return code,
    };
    certify_trial(args, &trial).unwrap_or_else(|error| trial::refuse(&error))
}

fn certify_trial(args: &CertifyArgs, trial: &Trial) -> Result<u8, CertifyError> {
    let runner = Processes { stop: interrupt::watch(), ranks: 1 };
    let tell = complain_unless(args.how.quiet);
    let launch = trial.launch(&runner, &tell, (args.how.jobs, args.how.threads));
    let wanted = Wanted { meshes: args.mesh, penalties: args.penalty, of: args.of.clone() };
    let certificate = runs::certify(&launch, &trial.plan, &trial.name, &wanted)?;
    let json = certificate.write(&trial.out)?;
    say(&match args.how.json {
        true => json,
        false => format!("{}results in {}", report::text(&certificate, &args.of), trial.out.display()),
    });
    Ok(exit::DONE)
}
