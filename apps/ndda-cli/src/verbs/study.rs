//! `ndda study`: a scene with other steps, integrators, meshes, …, and what each costs and is worth.

use std::path::Path;

use ndda::study::emit::{self, Plan};
use ndda::study::error::StudyError;
use ndda::study::{Study, make_folder, table};
use ndda::sweep::{self, Ask, How, Sweep};
use ndda_io::study::Sampling;

use super::processes::{Processes, refuse};
use crate::args::{Spread, StudyArgs, StudyCaseArgs, StudyHow, StudyPart};
use crate::exit;
use crate::terminal::console::{complain_unless, say};
use crate::terminal::interrupt;

/// Runs `ndda study`; returns the exit code.
pub fn study(args: &StudyArgs) -> u8 {
    let outcome = match (&args.part, &args.study) {
        (Some(StudyPart::Case(case)), _) => run_one(case),
        (Some(StudyPart::Collect(collect)), _) => {
            open(&collect.study, &collect.how).and_then(|opened| gather(&opened, &collect.how, collect.json))
        }
        (None, Some(study)) => run_all(study, args),
        // The command line requires one before it comes to this.
        (None, None) => return exit::USAGE,
    };
    outcome.unwrap_or_else(|error| refuse(&error))
}

fn open(study: &Path, how: &StudyHow) -> Result<Study, StudyError> {
    Ok(Study::open(study, how.out.clone(), &how.overrides)?.with_second_runs(how.second_runs))
}

/// Quantities over values and distributions.
fn run_sweep(sweep: &Sweep, args: &StudyArgs) -> Result<u8, StudyError> {
    let stop = interrupt::watch();
    let (runner, say_line) =
        (Processes { stop: stop.clone(), ranks: args.how.ranks }, complain_unless(args.how.quiet));
    let how = How { runner: &runner, stop, say: &say_line, jobs: args.jobs, threads: args.how.threads };
    let (results, json) = sweep.run(&how)?;
    let text = format!("{}results in {}", sweep::text::text(&results), sweep.out.display());
    say(if args.json { &json } else { &text });
    Ok(if results.has_values() { exit::DONE } else { exit::FAILED })
}

fn ask(args: &StudyArgs) -> Ask {
    let sweep = &args.sweep;
    Ask {
        vary: sweep.vary.clone(),
        of: sweep.of.clone(),
        samples: sweep.samples,
        sampling: sweep.sampling.map(|spread| match spread {
            Spread::Lhs => Sampling::LatinHypercube,
            Spread::Sobol => Sampling::Sobol,
        }),
        seed: sweep.seed,
        correlate: sweep.correlate.clone(),
        fails_when: sweep.fails_when.clone(),
        sensitivity: sweep.sensitivity,
        second_runs: args.how.second_runs,
        overrides: args.how.overrides.clone(),
        out: args.how.out.clone(),
    }
}

fn run_all(study: &Path, args: &StudyArgs) -> Result<u8, StudyError> {
    if args.emit.is_none()
        && let Some(sweep) = Sweep::open(study, &ask(args))?
    {
        return run_sweep(&sweep, args);
    }
    let opened = open(study, &args.how)?;
    let StudyHow { ranks, threads, quiet, overrides, .. } = &args.how;
    if let Some(kind) = args.emit {
        let (jobs, ranks, threads) = (args.jobs, *ranks, *threads);
        let plan = Plan { study, out: &opened.out, jobs, ranks, threads, overrides };
        say(&emit::script(&plan, &opened.runs(), kind));
        return Ok(exit::DONE);
    }
    opened.check_reference()?;
    make_folder(&opened.out)?;
    let (runner, tell) =
        (Processes { stop: interrupt::watch(), ranks: args.how.ranks }, complain_unless(*quiet));
    opened.launch(&runner, &tell, (args.jobs, *threads)).run_all(&opened.runs())?;
    gather(&opened, &args.how, args.json)
}

fn run_one(args: &StudyCaseArgs) -> Result<u8, StudyError> {
    let opened = open(&args.study, &args.how)?;
    let (runs, name) = (opened.runs(), &args.case);
    let case = runs.iter().find(|case| case.name == *name).ok_or_else(|| StudyError::NoCase(name.clone()))?;
    make_folder(&opened.out)?;
    let (runner, tell) =
        (Processes { stop: interrupt::watch(), ranks: args.how.ranks }, complain_unless(args.how.quiet));
    let said = opened.launch(&runner, &tell, (1, args.how.threads)).run_case(case)?;
    if !args.how.quiet {
        say(&format!("{name}: {said}"));
    }
    Ok(exit::DONE)
}

/// Reads what has run, writes and prints the results.
fn gather(opened: &Study, how: &StudyHow, as_json: bool) -> Result<u8, StudyError> {
    let (runner, tell) = (Processes { stop: Default::default(), ranks: how.ranks }, complain_unless(true));
    let (results, json) = opened.gather(&opened.launch(&runner, &tell, (1, how.threads)))?;
    say(&if as_json {
        json
    } else {
        format!("{}results in {}", table::text(&results), opened.out.display())
    });
    let (done, missing) = (results.points.iter().any(|p| p.figures.is_some()), !results.missing.is_empty());
    Ok(if done && !missing { exit::DONE } else { exit::FAILED })
}
